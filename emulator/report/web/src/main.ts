// The report page: reads the run out of the page, then builds the views round one state.
import { Charts } from './charts';
import { readRun } from './data';
import { Listing } from './listing';
import { PathView } from './path_view';
import { State } from './state';
import { BlockTable, eventTable, linkRows, valueTable } from './tables';
import { fixed, isRussian, setRussian } from './text';

const at = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

/** Choices live in the address alone: nothing is stored. */
const has = (word: string): boolean => location.hash.split(/[#,]/).includes(word);
function keep(word: string, on: boolean): void {
  const words = location.hash.split(/[#,]/).filter((w) => w && w !== word);
  if (on) words.push(word);
  history.replaceState(null, '', words.length ? `#${words.join(',')}` : location.pathname + location.search);
}

function dark(): boolean {
  return has('dark') || (!has('light') && matchMedia('(prefers-color-scheme: dark)').matches);
}

async function start(): Promise<void> {
  const begun = performance.now();
  document.documentElement.classList.toggle('dark', dark());
  if (has('ru')) setRussian(true);
  const run = await readRun();
  const decoded = performance.now();
  const state = new State(run.first_s, run.end_s, 8 * run.piece_s);
  const listing = new Listing(run, state, at('listing'), at('lines'));
  const charts = new Charts(run, state, at('charts'));
  const path = new PathView(run, state, at<HTMLCanvasElement>('view'), at<HTMLSelectElement>('colour'));
  const blocks = new BlockTable(run);
  eventTable(run);
  const values = valueTable(run, state, charts);
  linkRows(run, state, listing, at('status'));
  at('settings-text').textContent = run.settings;

  const note = (): void => {
    const { meta } = run, tick = `${fixed(1000 * meta.control_tick_s, 3)} ${isRussian() ? 'мс' : 'ms'}`;
    const whole = isRussian() ? `${fixed(meta.control_ticks, 0)} тактов по ${tick}` : `${fixed(meta.control_ticks, 0)} control ticks of ${tick}`;
    const overview = isRussian() ? `; обзор: наименьшее и наибольшее за каждые ${meta.every}` : `; overview: lowest and highest of each ${meta.every}`;
    at('note').textContent = whole + (meta.every > 1 ? overview : '') + `; kadr ${meta.kadr}`;
    at('language').textContent = isRussian() ? 'English' : 'Русский';
  };
  const redraw = (): void => { note(); charts.make(); path.words(); path.paint(); blocks.draw(); eventTable(run); values(); };
  note();

  at('whole').onclick = () => state.whole();
  at('print').onclick = () => print();
  at('theme').onclick = () => {
    const on = !document.documentElement.classList.contains('dark');
    document.documentElement.classList.toggle('dark', on);
    keep('dark', on);
    keep('light', !on);
    redraw();
  };
  at('language').onclick = () => { setRussian(!isRussian()); keep('ru', isRussian()); redraw(); };
  for (const button of document.querySelectorAll<HTMLElement>('[data-view]')) button.onclick = () => path.view(button.dataset.view!);

  // paper is light
  let was = false;
  addEventListener('beforeprint', () => { was = document.documentElement.classList.contains('dark'); document.documentElement.classList.remove('dark'); redraw(); path.draw(); });
  addEventListener('afterprint', () => { document.documentElement.classList.toggle('dark', was); redraw(); });

  document.body.classList.add('ready');
  // what tests look at: numbers and views, nothing that the page itself needs
  Object.assign(window, { kadr: { run, state, charts, path, listing, ms: { begun, decoded: decoded - begun, ready: performance.now() } } });
}

start().catch((error: unknown) => {
  document.body.classList.add('ready');
  at('note').textContent = `This browser can't show the charts: ${String(error)}`;
});
