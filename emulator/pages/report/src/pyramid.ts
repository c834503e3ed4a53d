// Lowest and highest values of a row of numbers at every scale, so that any stretch of a million samples is asked for its extremes
// in some dozen steps and no single sample is lost.

const FAN = 8;

interface Level { low: Float32Array; high: Float32Array }

function coarser({ low, high }: Level): Level {
  const n = Math.ceil(low.length / FAN), out = { low: new Float32Array(n), high: new Float32Array(n) };
  for (let b = 0; b < n; b++) {
    let lo = Infinity, hi = -Infinity;
    for (let i = b * FAN, end = Math.min(low.length, i + FAN); i < end; i++) {
      if (low[i] < lo) lo = low[i];
      if (high[i] > hi) hi = high[i];
    }
    out.low[b] = lo;
    out.high[b] = hi;
  }
  return out;
}

export class Pyramid {
  private readonly levels: Level[];
  /** Of the stretch asked for last; low > high: it has no values. */
  low = Infinity;
  high = -Infinity;

  constructor(low: Float32Array, high: Float32Array) {
    this.levels = [{ low, high }];
    for (let top = this.levels[0]; top.low.length > FAN; top = this.levels[this.levels.length - 1]) this.levels.push(coarser(top));
  }

  /** Sets low and high to the extremes of samples [from, to). */
  ask(from: number, to: number): void {
    this.low = Infinity;
    this.high = -Infinity;
    // ragged ends at each level, what is whole between them at the next
    for (let k = 0; from < to; k++) {
      const level = this.levels[k];
      const a = Math.ceil(from / FAN), b = Math.floor(to / FAN);
      if (a >= b || k + 1 === this.levels.length) {
        this.take(level, from, to);
        return;
      }
      this.take(level, from, a * FAN);
      this.take(level, b * FAN, to);
      from = a;
      to = b;
    }
  }

  private take({ low, high }: Level, from: number, to: number): void {
    for (let i = from; i < to; i++) {
      if (low[i] < this.low) this.low = low[i];
      if (high[i] > this.high) this.high = high[i];
    }
  }
}
