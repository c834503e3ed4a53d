// Which signals share a chart.
import { Curve, type Scale } from './curve';
import { type Run, type Track, alike, one } from './data';

export interface Group { title: string; unit: string; curves: Curve[]; names: string[] }

const OF_AXES = [['Following error', '.following'], ['Vibration', '.vibration'], ['Axis speed', '.speed'], ['Axis acceleration', '.acceleration'],
  ['Axis jerk', '.jerk'], ['Step rate', '.step_rate']] as const;

/** Signals that have a chart below, by begin or part of the name. Each other one has a chart of its own, titled with its name in the log. */
const CHARTED = ['feed.', 'path.', ...OF_AXES.map(([, part]) => part)];
const further = (run: Run): Track[] => [...run.tracks.values()].filter((t) => !CHARTED.some((c) => (c.startsWith('.') ? t.name.startsWith('axis.') && t.name.includes(c) : t.name.startsWith(c))));

/** One run: alike signals of its axes in one chart. */
export function groupsOf(run: Run, scale: Scale): Group[] {
  const out: Group[] = [];
  const add = (title: string, tracks: (Track | undefined)[], names: string[]): void => {
    const there = tracks.map((t, k) => ({ t, name: names[k] })).filter((x) => x.t) as { t: Track; name: string }[];
    if (there.length) out.push({ title, unit: there[0].t.unit, curves: there.map((x) => new Curve(x.t, run, scale)), names: there.map((x) => x.name) });
  };
  add('Feed', [one(run, 'feed.commanded'), one(run, 'feed.programmed')], ['commanded', 'programmed']);
  add('Feed override', [one(run, 'feed.override_used'), one(run, 'feed.override_requested')], ['used', 'requested']);
  add('Path error', [one(run, 'path.error')], ['path error']);
  add('Acceleration along the path', [one(run, 'feed.acceleration')], ['acceleration']);
  add('Jerk along the path', [one(run, 'feed.jerk')], ['jerk']);
  // axes of one unit share a chart
  for (const [title, part] of OF_AXES) {
    const tracks = alike(run, 'axis.', part);
    for (const unit of new Set(tracks.map((t) => t.unit))) {
      const same = tracks.filter((t) => t.unit === unit);
      add(title, same, same.map((t) => t.name.split('.')[1]));
    }
  }
  for (const track of further(run)) add(track.name, [track], [track.name]);
  return out;
}

/** Several runs: a chart a signal, the runs in it; axes that stand still in all of them have none. */
export function comparedGroups(runs: Run[], scales: Scale[], letters: string[]): Group[] {
  const out: Group[] = [];
  const add = (title: string, begin: string): void => {
    const curves: Curve[] = [], names: string[] = [];
    runs.forEach((run, k) => {
      const track = one(run, begin);
      if (!track || (curves.length > 0 && track.unit !== curves[0].track.unit)) return;
      curves.push(new Curve(track, run, scales[k]));
      names.push(letters[k]);
    });
    if (curves.some((c) => c.track.step > 0 || !begin.startsWith('axis.'))) out.push({ title, unit: curves[0].track.unit, curves, names });
  };
  add('Feed', 'feed.commanded');
  add('Path error', 'path.error');
  add('Feed override', 'feed.override_used');
  add('Acceleration along the path', 'feed.acceleration');
  const axes = new Set(runs.flatMap((run) => run.meta.axes.map((a) => a.name)));
  for (const [title, part] of OF_AXES) for (const axis of axes) add(`${title} ${axis}`, `axis.${axis}${part}`);
  for (const name of new Set(runs.flatMap((run) => further(run).map((t) => t.name)))) add(name, name);
  return out;
}
