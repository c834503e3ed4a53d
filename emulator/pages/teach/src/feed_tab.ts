// t(S) by one polynomial (paper 004): a small error of t beside the error of the feed that comes with it.
import { FITS, lengthErrors, segment, type Fit, type LengthErrors } from './core';
import { chainOf } from './paper_curves';
import { state } from './state';
import { drawing, polyline, roundStep, shape } from './svg';
import { either, fixed, made, say } from './words';

const WIDTH = 480, HEIGHT = 300, LEFT = 66, BELOW = 34, EVERY = 3;
export const DEGREES: Record<Fit, number[]> = { newton: [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], minimax: [2, 3, 4, 5, 6, 7], exact: [2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], table: [4, 8, 16, 32, 64] };
export const FIT_NAMES: Record<Fit, string> = { newton: 'Newton through equal parts', minimax: 'minimax of Newton 8', exact: 'minimax of the exact t(S)', table: 'table of quintic pieces' };

const cache = new Map<string, LengthErrors>();
function errors(curve: number, fit: Fit, degree: number): LengthErrors {
  const key = `${curve} ${fit} ${degree}`;
  if (!cache.has(key)) { chainOf('paper'); cache.set(key, lengthErrors(curve, fit, degree, EVERY)); }
  return cache.get(key)!;
}

/** Three significant digits, as `kadr teach bezier --paper` prints them. */
export const short = (v: number): string => (v === 0 ? '0' : Math.abs(v) < 1e-3 ? v.toExponential(2).replace('e', '\u00b710^').replace('-', '\u2212') : String(Number(v.toPrecision(3))));

function chart(title: string, values: (readonly [number, number])[], className: string, most: number): SVGElement {
  const svg = drawing(WIDTH, HEIGHT, title, 'chart');
  const X = (u: number): number => LEFT + u * (WIDTH - LEFT - 14), Y = (v: number): number => 30 + ((HEIGHT - BELOW - 30) * (most - v)) / (2 * most);
  svg.append(shape('text', { x: LEFT, y: 18, class: 'title' }, title));
  const step = roundStep(2 * most, 6);
  for (let v = -Math.floor(most / step) * step; v <= most * 1.0001; v += step) {
    const clean = Math.abs(v) < step / 1e6 ? 0 : v;
    svg.append(shape('line', { x1: LEFT, y1: Y(clean), x2: WIDTH - 14, y2: Y(clean), class: clean === 0 ? 'axes' : 'grid' }), shape('text', { x: LEFT - 6, y: Y(clean) + 4, class: 'y tick' }, short(clean).replace(/^-/, '\u2212')));
  }
  for (const u of [0, 0.25, 0.5, 0.75, 1]) svg.append(shape('line', { x1: X(u), y1: 30, x2: X(u), y2: HEIGHT - BELOW, class: 'grid' }), shape('text', { x: X(u), y: HEIGHT - BELOW + 15, class: 'x tick' }, String(u)));
  svg.append(shape('text', { x: (LEFT + WIDTH) / 2, y: HEIGHT - 4, class: 'x soft' }, say('share of the length')));
  svg.append(polyline(values.map(([u, v]) => [X(u), Y(v)] as const), `line ${className}`));
  return svg;
}

export function drawFeed(change: () => void): void {
  const at = (id: string): HTMLElement => document.getElementById(id)!;
  const list = DEGREES[state.fit];
  if (!list.includes(state.degree)) state.degree = list[Math.min(1, list.length - 1)];
  const now = errors(state.curve, state.fit, state.degree), parts = state.fit === 'table';
  const worst = (k: 't' | 'feed'): number => Math.max(1e-12, ...now.at.map((e) => Math.abs(100 * e[k]))) * 1.08;
  at('feed-charts').replaceChildren(
    chart(say('error of t, %'), now.at.map((e) => [e.u, 100 * e.t] as const), 's0', worst('t')),
    chart(say('error of the feed, %'), now.at.map((e) => [e.u, 100 * e.feed] as const), 's1', worst('feed')));
  const table = made('table'), head = table.createTHead().insertRow();
  table.id = 'feed-table';
  table.createCaption().textContent = `${say(`Curve ${state.curve + 1}`)}, ${fixed(segmentLength(), 4)} mm; ${say(FIT_NAMES[state.fit])}`;
  for (const name of [parts ? 'parts' : 'degree', 'error of t, %', 'error of place, mm', 'error of the feed, %']) head.append(made('th', say(name)));
  const body = table.createTBody();
  for (const degree of list) {
    const e = errors(state.curve, state.fit, degree), tr = body.insertRow(), th = made('th', String(degree));
    th.scope = 'row';
    tr.append(th);
    tr.dataset.row = String(degree);
    for (const v of [100 * e.t, e.place, 100 * e.feed]) tr.insertCell().textContent = short(v);
    if (degree === state.degree) { tr.className = 'now'; tr.setAttribute('aria-current', 'true'); }
    tr.onclick = () => { state.degree = degree; change(); };
  }
  at('feed-numbers').replaceChildren(table);
  const t = short(100 * now.t), feed = short(100 * now.feed);
  const what = `${say(FIT_NAMES[state.fit])}, ${say(parts ? 'parts' : 'degree')} ${state.degree}`;
  at('feed-words').textContent = either(`${what}: t is off by ${t} % at most, the feed by ${feed} %. A limit on t bounds the place; the feed hangs on the slope, which a wavy polynomial misses by far more.`,
    `${what}: t ошибается не более чем на ${t} %, подача — на ${feed} %. Допуск на t ограничивает место; подача зависит от наклона, а волнистый многочлен ошибается в нём намного сильнее.`);
  const slider = at('degree') as HTMLInputElement;
  slider.max = String(list.length - 1);
  slider.value = String(list.indexOf(state.degree));
  slider.setAttribute('aria-valuetext', `${say(parts ? 'parts' : 'degree')} ${state.degree}`);
  slider.oninput = () => { state.degree = list[Number(slider.value)]; change(); };
  at('degree-value').textContent = String(state.degree);
  at('degree-name').textContent = say(parts ? 'Parts' : 'Degree');
  const fits = at('fit') as HTMLSelectElement;
  fits.replaceChildren(...FITS.map((f) => { const o = made('option', say(FIT_NAMES[f])); o.value = f; o.selected = f === state.fit; return o; }));
  fits.onchange = () => { state.fit = fits.value as Fit; change(); };
  for (const b of document.querySelectorAll<HTMLButtonElement>('#feed-curves button')) {
    b.setAttribute('aria-pressed', String(b.value === String(state.curve)));
    b.onclick = () => { state.curve = Number(b.value); change(); };
  }
}

function segmentLength(): number {
  chainOf('paper');
  return segment(state.curve).length;
}
