// One signal in one chart, drawn into uPlot's canvas: a line where samples stand apart, an upright bar a column of pixels where there
// are more samples than columns. Bars show every spike, and cost a software raster a tenth of the strokes they replace.
import uPlot from 'uplot';
import type { Points } from './curve';

export interface Columns { low: Float32Array; high: Float32Array }

/** Lines of a chart are told apart by more than colour. */
export const DASHES = [[], [7, 3], [2, 3], [10, 3, 2, 3], [4, 2], [1, 2]];
export const WIDTH_PX = 1.2;

export function line(u: uPlot, { x, y }: Points): uPlot.Series.Paths {
  const stroke = new Path2D();
  let down = false;
  for (let i = 0; i < x.length; i++) {
    if (Number.isNaN(y[i])) { down = false; continue; }
    const px = u.valToPos(x[i], 'x', true), py = u.valToPos(y[i], 'y', true);
    if (down) stroke.lineTo(px, py); else stroke.moveTo(px, py);
    down = true;
  }
  return { stroke };
}

export function bars(u: uPlot, { low, high }: Columns, colour: string, dash: number[]): void {
  const { ctx, bbox } = u, ratio = devicePixelRatio || 1, thick = WIDTH_PX * ratio;
  // upright at zero and per unit: a million calls of valToPos would be the dearest part
  const zero = u.valToPos(0, 'y', true), unit = u.valToPos(1, 'y', true) - zero;
  const period = dash.reduce((sum, d) => sum + d, 0) * ratio;
  const gap = (c: number): boolean => {
    let at = c % period, drawn = true;
    for (const d of dash) { if (at < d * ratio) return !drawn; at -= d * ratio; drawn = !drawn; }
    return false;
  };
  ctx.save();
  ctx.fillStyle = colour;
  let from = 0, top = NaN, height = NaN;
  const put = (end: number): void => { if (end > from && height > 0) ctx.fillRect(bbox.left + from, top, end - from, height); };
  for (let c = 0; c <= low.length; c++) {
    let y = NaN, h = NaN;
    if (c < low.length && low[c] <= high[c]) {
      y = zero + unit * high[c] - thick / 2;
      h = unit * (low[c] - high[c]) + thick;
      if (period > 0 && h < 3 * thick && gap(c)) y = h = NaN;
    }
    // equal neighbours are one bar
    if (c < low.length && (y === top && h === height || Number.isNaN(h) && Number.isNaN(height))) continue;
    put(c);
    [from, top, height] = [c, y, h];
  }
  ctx.restore();
}
