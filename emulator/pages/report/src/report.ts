// The page of one run: its views round one state.
import { Charts } from './charts';
import { timeScale } from './curve';
import { readRun } from './data';
import { at, frame } from './frame';
import { groupsOf } from './groups';
import { Listing } from './listing';
import { PathView } from './path_view';
import { State } from './state';
import { BlockTable, eventTable, linkRows, valueTable } from './tables';
import { fixed, isRussian, say } from './text';

export async function report(): Promise<object> {
  const begun = performance.now();
  const run = await readRun();
  const decoded = performance.now();
  const state = new State(run.first_s, run.end_s, 8 * run.meta.control_tick_s);
  const listing = new Listing(run, state, at('listing'), at('lines'));
  const marks = run.meta.events.map((e) => ({ x: e.t_s, alarm: e.kind === 'alarm' }));
  const charts = new Charts(groupsOf(run, timeScale(run)), state, at('charts'), () => `${say('time')}, s`, marks).listen();
  const path = new PathView(run, state, at<HTMLCanvasElement>('view'), at('dot'), at<HTMLSelectElement>('colour'));
  const blocks = new BlockTable(run);
  eventTable(run);
  const values = valueTable(state, charts);
  linkRows(run, state, listing, at('status'));
  at('settings-text').textContent = run.settings;

  const note = (): void => {
    const { meta } = run, ru = isRussian(), tick = `${fixed(1000 * meta.control_tick_s, 3)} ${ru ? 'мс' : 'ms'}`;
    const whole = ru ? `${fixed(meta.control_ticks, 0)} тактов по ${tick}` : `${fixed(meta.control_ticks, 0)} control ticks of ${tick}`;
    const n = meta.windows.length;
    const overview = ru ? `; обзор: наименьшее и наибольшее за каждые ${meta.every}, каждый такт в ${n} местах; остальное в журнале, часть: kadr report --from 12 --to 14`
      : `; overview: lowest and highest of each ${meta.every}, every tick at ${n} places; the rest is in the log, for a part: kadr report --from 12 --to 14`;
    at('note').textContent = whole + (meta.every > 1 ? overview : '') + `; kadr ${meta.kadr}`;
  };
  note();
  at('whole').onclick = () => state.whole();
  for (const button of document.querySelectorAll<HTMLElement>('[data-view]')) button.onclick = () => path.view(button.dataset.view!);
  frame((paper) => {
    note();
    charts.make();
    if (paper) charts.draw(true);
    path.words();
    path.paint();
    path.draw();
    blocks.draw();
    eventTable(run);
    values();
  });
  await path.ready;
  return { run, state, charts, path, listing, ms: { begun, decoded: decoded - begun, ready: performance.now() } };
}
