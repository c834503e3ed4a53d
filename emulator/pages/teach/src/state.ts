// What the page shows. It lives in the address, so that a link leads to one step of one case; nothing is stored.
//   #line,7,4,half_step,6     #compare,arc,7,0,0,7,ccw,classic,half_step     #cases     #rose,half_step,diagonal
//   #joint,g2     #feed,1,minimax,3     and the words ru, dark, light
import { FITS, methods, type Fit } from './core';

export const TABS = ['step', 'compare', 'cases', 'rose', 'joint', 'feed'] as const;
export type Tab = (typeof TABS)[number];
export const KINDS = ['line', 'arc', 'circle', 'ellipse', 'parabola', 'bezier', 'curve'];
export const JOINTS = ['paper', 'g2', 'c2'] as const;
export type Joint = (typeof JOINTS)[number];
export const MOST_COMPARED = 4;

export const state = {
  tab: 'step' as Tab,
  words: ['line', '7', '4'],
  method: 'half_step',
  row: 0,
  compared: ['classic', 'half_step', 'diagonal', 'dda'],
  roses: ['half_step', 'diagonal', 'dda'],
  angle: 30,
  joint: 'paper' as Joint,
  curve: 0,
  fit: 'minimax' as Fit,
  degree: 3,
  russian: false,
  theme: '' as '' | 'dark' | 'light',
};

const isWhole = (word: string): boolean => /^[+-]?\d+$/.test(word);

export function readAddress(address: string): void {
  const words = address.replace(/^#/, '').split(',').map((w) => decodeURIComponent(w.trim())).filter(Boolean);
  const left: string[] = [];
  state.russian = false;
  state.theme = '';
  for (const word of words) {
    if (word === 'ru') state.russian = true;
    else if (word === 'dark' || word === 'light') state.theme = word;
    else left.push(word);
  }
  if (!left.length) return;
  const tab = TABS.find((t) => t === left[0]);
  state.tab = tab ?? 'step';
  const rest = tab ? left.slice(1) : left;
  if (state.tab === 'joint') state.joint = JOINTS.find((j) => j === rest[0]) ?? 'paper';
  if (state.tab === 'feed') {
    state.curve = rest[0] === '2' ? 1 : 0;
    state.fit = FITS.find((f) => f === rest[1]) ?? 'minimax';
    state.degree = isWhole(rest[2] ?? '') ? Math.max(2, Math.min(64, Number(rest[2]))) : 3;
  }
  if (state.tab === 'rose' && rest.length) state.roses = rest.filter((w) => methods.includes(w)).slice(0, MOST_COMPARED);
  if (state.tab !== 'step' && state.tab !== 'compare') return;
  const first = rest.findIndex((w, i) => i > 0 && methods.includes(w));
  const until = first < 0 ? rest.length : first, named = first < 0 ? [] : rest.slice(first).filter((w) => methods.includes(w));
  if (until > 0 && rest[0]) state.words = rest.slice(0, until);
  const last = rest[rest.length - 1];
  state.row = first >= 0 && rest.length > first + 1 && isWhole(last) ? Math.max(0, Number(last)) : 0;
  if (state.tab === 'compare' && named.length) state.compared = named.slice(0, MOST_COMPARED);
  if (state.tab === 'step' && named.length) state.method = named[0];
}

export function address(): string {
  const words: (string | number)[] = [];
  if (state.tab !== 'step') words.push(state.tab);
  if (state.tab === 'step' || state.tab === 'compare') words.push(...state.words.map(encodeURIComponent), ...(state.tab === 'step' ? [state.method] : state.compared), state.row);
  if (state.tab === 'rose') words.push(...state.roses);
  if (state.tab === 'joint') words.push(state.joint);
  if (state.tab === 'feed') words.push(state.curve + 1, state.fit, state.degree);
  if (state.russian) words.push('ru');
  if (state.theme) words.push(state.theme);
  return `#${words.join(',')}`;
}

/** Words of a case as one types them: blanks apart, a polynomial in quotes. */
export const splitWords = (text: string): string[] => (text.match(/'[^']*'|[^\s,]+/g) ?? []).map((w) => w.replace(/^'|'$/g, ''));
export const joinWords = (words: string[]): string => words.map((w) => (/[\s,]/.test(w) || /[xy]\b/.test(w) ? `'${w}'` : w)).join(' ');
