// A signal of a run over what charts run over: time, or the path. Whatever the zoom, a chart asks for as many values as it has
// columns of pixels, and each holds the lowest and the highest value of its stretch.
import type { Run, Track } from './data';

/** Places of a run's control ticks: u of them have passed, at(u) is where that was. */
export interface Scale {
  first: number;
  end: number;
  at(ticks: number): number;
  ticksAt(x: number): number;
}

export function timeScale(run: Run): Scale {
  const tick_s = run.meta.control_tick_s;
  return {
    first: run.first_s, end: run.end_s,
    at: (ticks) => run.first_s + ticks * tick_s,
    ticksAt: (x) => Math.max(0, Math.min(run.ticks, (x - run.first_s) / tick_s)),
  };
}

/** Over the commanded path; where the tool stands, it is left at once. */
export function pathScale(run: Run): Scale {
  const path = run.path_u, every = run.meta.every;
  const at = (ticks: number): number => {
    const i = Math.min(path.length - 1, Math.floor(ticks / every)), part = Math.min(1, ticks / every - i);
    const before = i > 0 ? path[i - 1] : Math.min(path[0], 2 * path[0] - (path[1] ?? path[0]));
    return before + part * (path[i] - before);
  };
  return {
    first: at(0), end: path[path.length - 1], at,
    ticksAt: (x) => {
      let low = 0, high = path.length;
      while (low < high) { const middle = (low + high) >> 1; if (path[middle] <= x) low = middle + 1; else high = middle; }
      if (low >= path.length) return run.ticks;
      const before = low > 0 ? path[low - 1] : at(0);
      return Math.max(0, (low + Math.max(0, Math.min(1, (x - before) / (path[low] - before)))) * every);
    },
  };
}

/** Single values at their places: NaN where there is none. */
export interface Points { x: Float64Array; y: Float32Array }

export class Curve {
  constructor(readonly track: Track, readonly run: Run, readonly scale: Scale) {}

  /** Lowest and highest value of each of low.length equal stretches of [from, to); low > high: none. A stretch begins with the sample
   * the one before it ended with. */
  columns(from: number, to: number, low: Float32Array, high: Float32Array): void {
    const n = low.length, { ticks } = this.run;
    let a = this.scale.ticksAt(from);
    for (let c = 0; c < n; c++) {
      const x = from + (to - from) * (c + 1) / n, b = this.scale.ticksAt(x);
      const first = Math.max(0, Math.ceil(a) - 1), end = Math.min(ticks, Math.max(Math.ceil(b), first + 1));
      const there = x > this.scale.first && x - (to - from) / n < this.scale.end;
      if (there) this.track.ask(this.run, first, end);
      low[c] = there ? this.track.lowest : Infinity;
      high[c] = there ? this.track.highest : -Infinity;
      a = b;
    }
  }

  /** The samples themselves, if they are at most `most`. Pieces of several control ticks stand as a lowest and a highest value. */
  points(from: number, to: number, most: number): Points | null {
    const { run, scale } = this, { every } = run.meta;
    const first = Math.max(0, Math.floor(scale.ticksAt(from)) - 1), end = Math.min(run.ticks, Math.ceil(scale.ticksAt(to)) + 1);
    if (end - first > most) return null;
    const x: number[] = [], y: number[] = [];
    const put = (ticks: number, value: number): void => { x.push(scale.at(ticks)); y.push(value); };
    for (let k = first; k < end;) {
      const w = run.windowAt(k);
      if (w) {
        for (const stop = Math.min(end, w.first + w.ticks); k < stop; k++) put(k + 1, this.track.fine[w.at + k - w.first]);
        continue;
      }
      const i = Math.floor(k / every), { low, high } = this.track;
      if (every === 1) put(k + 1, low[i]);
      else {
        // the nearer end first: a falling signal must not look like a saw
        const up = !(Math.abs(y[y.length - 1] - high[i]) < Math.abs(y[y.length - 1] - low[i]));
        put(k + 1, up ? low[i] : high[i]);
        put(Math.min((i + 1) * every, run.windowAfter(k)), up ? high[i] : low[i]);
      }
      k = Math.min((i + 1) * every, run.windowAfter(k));
    }
    return { x: Float64Array.from(x), y: Float32Array.from(y) };
  }

  /** Extremes between two places. */
  range(from: number, to: number): [number, number] {
    const first = Math.max(0, Math.ceil(this.scale.ticksAt(from)) - 1), end = Math.max(first + 1, Math.ceil(this.scale.ticksAt(to)));
    this.track.ask(this.run, first, Math.min(this.run.ticks, end));
    return [this.track.lowest, this.track.highest];
  }

  /** The sample at a place, as lowest and highest of its piece; beyond the run's ends none. */
  at(x: number): [number, number] {
    if (!(x >= this.scale.first && x <= this.scale.end)) return [NaN, NaN];
    const tick = Math.max(0, Math.min(this.run.ticks, Math.ceil(this.scale.ticksAt(x) - 1e-6)) - 1);
    this.track.ask(this.run, tick, tick + 1);
    return this.track.lowest <= this.track.highest ? [this.track.lowest, this.track.highest] : [NaN, NaN];
  }
}
