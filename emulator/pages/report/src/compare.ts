// The page of several runs: charts of all of them over time or over the path, with one window and one cursor.
import { Charts } from './charts';
import { type Scale, pathScale, timeScale } from './curve';
import { type Run, blockAt, readRun, tickAt } from './data';
import { at, frame, has, keep } from './frame';
import { comparedGroups } from './groups';
import { State } from './state';
import { valueTable } from './tables';
import { fixed, made, say } from './text';

/** Where each run is at the cursor: time, path, line. */
function places(runs: Run[], letters: string[], scales: Scale[], x: number): void {
  at('places').replaceChildren(...runs.map((run, k) => {
    const s = scales[k], row = made('tr'), there = x >= s.first && x <= s.end;
    const t_s = there ? run.first_s + s.ticksAt(x) * run.meta.control_tick_s : NaN;
    const block = there ? blockAt(run, t_s) : -1, line = block < 0 ? 0 : run.blocks.line[block];
    row.append(made('th', letters[k]), made('td', there ? `${fixed(t_s, 3)} s` : ''),
      made('td', there ? `${fixed(run.path_u[Math.floor(tickAt(run, t_s) / run.meta.every)], 3)} ${run.meta.path_unit}` : ''),
      made('td', line ? String(line) : ''), made('td', line ? run.program[line - 1] : '', 'code'));
    return row;
  }));
}

export async function compare(): Promise<object> {
  document.body.classList.add('several');
  const { runs: letters } = JSON.parse(at('runs').textContent ?? '') as { runs: string[] };
  const runs: Run[] = [];
  for (const letter of letters) runs.push(await readRun(`${letter}-`));
  const now = { runs, state: new State(0, 1, 1), charts: null as Charts | null, ms: { ready: 0 } };
  let values = (): void => {};

  const build = (): void => {
    const over = has('path'), scales = runs.map(over ? pathScale : timeScale);
    const state = new State(Math.min(...scales.map((s) => s.first)), Math.max(...scales.map((s) => s.end)), over ? 0.01 : Math.min(...runs.map((r) => 8 * r.meta.control_tick_s)));
    const marks = runs.flatMap((run, k) => run.meta.events.filter((e) => e.kind === 'alarm')
      .map((e) => ({ x: scales[k].at(tickAt(run, e.t_s)), alarm: true })));
    now.charts?.leave();
    now.state = state;
    now.charts = new Charts(comparedGroups(runs, scales, letters), state, at('charts'),
      () => (over ? `${say('path')}, ${runs[0].meta.path_unit}` : `${say('time')}, s`), marks).listen();
    values = valueTable(state, now.charts);
    const show = (x: number): void => places(runs, letters, scales, x);
    state.add({ cursor: show });
    show(NaN);
    at('over-path').setAttribute('aria-pressed', String(over));
  };
  build();
  at('note').textContent = `kadr ${runs[0].meta.kadr}`;
  at('whole').onclick = () => now.state.whole();
  at('over-path').onclick = () => { keep('path', !has('path')); build(); };
  frame((paper) => {
    now.charts!.make();
    if (paper) now.charts!.draw(true);
    values();
  });
  now.ms.ready = performance.now();
  return now;
}
