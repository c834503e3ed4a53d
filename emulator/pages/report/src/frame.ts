// What pages of every kind have: theme, language, paper; choices live in the address alone, nothing is stored.
import { isRussian, setRussian } from './text';

export const at = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

export const has = (word: string): boolean => location.hash.split(/[#,]/).includes(word);
export function keep(word: string, on: boolean): void {
  const words = location.hash.split(/[#,]/).filter((w) => w && w !== word);
  if (on) words.push(word);
  history.replaceState(null, '', words.length ? `#${words.join(',')}` : location.pathname + location.search);
}

const root = document.documentElement;

/** Before anything is drawn. */
export function dress(): void {
  root.classList.toggle('dark', has('dark') || (!has('light') && matchMedia('(prefers-color-scheme: dark)').matches));
  if (has('ru')) setRussian(true);
}

/** @param redraw  everything in the colours and words of now; with `paper` also what is out of sight */
export function frame(redraw: (paper: boolean) => void): void {
  const words = (): void => { at('language').textContent = isRussian() ? 'English' : 'Русский'; };
  words();
  at('print').onclick = () => print();
  at('theme').onclick = () => {
    const on = !root.classList.contains('dark');
    root.classList.toggle('dark', on);
    keep('dark', on);
    keep('light', !on);
    redraw(false);
  };
  at('language').onclick = () => { setRussian(!isRussian()); keep('ru', isRussian()); words(); redraw(false); };
  // paper is light
  let was = false;
  addEventListener('beforeprint', () => { was = root.classList.contains('dark'); root.classList.remove('dark'); redraw(true); });
  addEventListener('afterprint', () => { root.classList.toggle('dark', was); redraw(false); });
}
