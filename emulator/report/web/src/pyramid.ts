// Lowest and highest values of a signal at every scale, so that a chart of a million samples draws a few thousand and
// no single one of them is lost.
import type { Track } from './data';

interface Level { size: number; low: Float32Array; high: Float32Array }

function lowerLevel(low: Float32Array, high: Float32Array, size: number, fan: number): Level {
  const n = Math.ceil(low.length / fan);
  const out = { size: size * fan, low: new Float32Array(n), high: new Float32Array(n) };
  for (let b = 0; b < n; b++) {
    let lo = Infinity, hi = -Infinity;
    for (let i = b * fan, end = Math.min(low.length, i + fan); i < end; i++) {
      if (low[i] < lo) lo = low[i];
      if (high[i] > hi) hi = high[i];
    }
    out.low[b] = lo <= hi ? lo : NaN;
    out.high[b] = lo <= hi ? hi : NaN;
  }
  return out;
}

export class Pyramid {
  private readonly levels: Level[];

  constructor(track: Track) {
    this.levels = [{ size: 1, low: track.low, high: track.high }];
    for (let top = this.levels[0]; top.low.length > 4096; top = this.levels[this.levels.length - 1])
      this.levels.push(lowerLevel(top.low, top.high, top.size, this.levels.length === 1 ? 16 : 4));
  }

  /** The coarsest scale that still has `buckets` of them in pieces [from, to): the pieces of a bucket. */
  size(from: number, to: number, buckets: number): number {
    let size = 1;
    for (const level of this.levels) if (level.size * buckets <= to - from) size = level.size;
    return size;
  }

  /** Lowest, then highest value of each bucket of that size; a single value where a bucket is one sample. */
  read(from: number, to: number, size: number, pairs: boolean): Float32Array {
    const level = this.levels.find((l) => l.size === size) ?? this.levels[0];
    const first = Math.floor(from / level.size), end = Math.min(level.low.length, Math.ceil(to / level.size));
    if (!pairs) return level.low.subarray(first, end);
    const out = new Float32Array(2 * (end - first));
    for (let b = first, k = 0; b < end; b++) {
      out[k++] = level.low[b];
      out[k++] = level.high[b];
    }
    return out;
  }

  extremes(from: number, to: number): [number, number] {
    let lo = Infinity, hi = -Infinity;
    const take = (level: Level, a: number, b: number) => {
      for (let i = a; i < b; i++) {
        if (level.low[i] < lo) lo = level.low[i];
        if (level.high[i] > hi) hi = level.high[i];
      }
    };
    const size = this.size(from, to, 64);
    const level = this.levels.find((l) => l.size === size) ?? this.levels[0];
    const a = Math.ceil(from / size), b = Math.floor(to / size);
    if (b <= a) take(this.levels[0], from, to);
    else {
      take(this.levels[0], from, a * size);
      take(level, a, b);
      take(this.levels[0], b * size, to);
    }
    return [lo, hi];
  }
}
