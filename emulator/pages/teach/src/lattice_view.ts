// The picture of a case on the lattice: ideal curve, path, signs of F, dual squares with the corner that was looked at.
import { signs, type Followed } from './core';
import { drawing, polyline, shape, signMark, testedMark } from './svg';
import { fixed, say } from './words';

const MOST_NODES = 2600;  // beyond it nodes are left out: they would be dust
const MOST_SQUARES = 400;
const NEAR_X = 7, NEAR_Y = 5;
const MARGIN = 0.4;  // steps
const LEFT = 22, BELOW = 16;  // px, for the numbers

export interface Bounds { left: number; right: number; low: number; high: number }

/** Nodes that the cases need, and one more on every side. */
export function boundsOf(cases: Followed[]): Bounds {
  const out = { left: 0, right: 0, low: 0, high: 0 };
  const take = (x: number, y: number): void => {
    out.left = Math.min(out.left, x); out.right = Math.max(out.right, x); out.low = Math.min(out.low, y); out.high = Math.max(out.high, y);
  };
  if (cases[0]) Object.assign(out, { left: cases[0].rows[0].x, right: cases[0].rows[0].x, low: cases[0].rows[0].y, high: cases[0].rows[0].y });
  for (const f of cases) {
    for (const r of f.rows) { take(r.x, r.y); take(...r.foot); }
    for (const [x, y] of f.curve) take(x, y);
  }
  return { left: Math.floor(out.left) - 1, right: Math.ceil(out.right) + 1, low: Math.floor(out.low) - 1, high: Math.ceil(out.high) + 1 };
}

/** A part of the lattice round the node of a row. */
export function near(f: Followed, row: number): Bounds {
  const { x, y } = f.rows[row];
  return { left: x - NEAR_X, right: x + NEAR_X, low: y - NEAR_Y, high: y + NEAR_Y };
}

export interface Look { width: number; height: number; squares: boolean; nodes: boolean; label: string }

/** @param pick called with the row of a node of the path that was clicked */
export function latticeView(f: Followed, row: number, bounds: Bounds, look: Look, pick?: (row: number) => void): SVGElement {
  const columns = bounds.right - bounds.left, rows = bounds.high - bounds.low;
  const unit = Math.min((look.width - LEFT) / (columns + 2 * MARGIN), (look.height - BELOW) / (rows + 2 * MARGIN), 96);
  const width = LEFT + (columns + 2 * MARGIN) * unit, height = (rows + 2 * MARGIN) * unit;
  const X = (x: number): number => LEFT + (x - bounds.left + MARGIN) * unit, Y = (y: number): number => (bounds.high - y + MARGIN) * unit;
  const svg = drawing(width, height + BELOW, look.label, 'lattice');
  const add = (e: SVGElement): SVGElement => { svg.append(e); return e; };
  const dot = Math.max(1.4, Math.min(6.5, unit * 0.13));

  const every = Math.max(1, Math.ceil(6 / unit));
  let d = '';
  for (let x = Math.ceil(bounds.left / every) * every; x <= bounds.right; x += every) d += `M${X(x).toFixed(1)} 0V${height.toFixed(1)}`;
  for (let y = Math.ceil(bounds.low / every) * every; y <= bounds.high; y += every) d += `M${LEFT} ${Y(y).toFixed(1)}H${width.toFixed(1)}`;
  add(shape('path', { d, class: 'grid' }));
  add(shape('path', { d: `M${X(0).toFixed(1)} 0V${height.toFixed(1)}M${LEFT} ${Y(0).toFixed(1)}H${width.toFixed(1)}`, class: 'axes' }));

  const square = (i: number, className: string): SVGElement => {
    const r = f.rows[i];
    return shape('rect', { x: X(r.x - 0.5), y: Y(r.y + 0.5), width: unit, height: unit, class: className });
  };
  const squares = look.squares && f.rows.length <= MOST_SQUARES && unit >= 7;
  if (squares) {
    add(square(row, 'dual now'));
    for (let i = 0; i < f.rows.length; i++) add(square(i, 'dual'));
  }
  const withNodes = look.nodes && (columns + 1) * (rows + 1) <= MOST_NODES && unit >= 7;
  if (withNodes) {
    const sign = signs(bounds.left, bounds.low, columns + 1, rows + 1);
    if (sign[0] !== 2)
      for (let j = 0; j <= rows; j++) for (let i = 0; i <= columns; i++) add(signMark(X(bounds.left + i), Y(bounds.low + j), dot * 0.82, sign[j * (columns + 1) + i]));
  }
  add(polyline(f.curve.map(([x, y]) => [X(x), Y(y)] as const), 'ideal'));
  const nodes = f.rows.map((r) => [X(r.x), Y(r.y)] as const);
  add(polyline(nodes.slice(row), 'to-come'));
  add(polyline(nodes.slice(0, row + 1), 'done'));

  const worst = f.rows.reduce((most, r, i) => (Math.abs(r.deviation) > Math.abs(f.rows[most].deviation) + 1e-12 ? i : most), 0);
  const off = f.rows[worst];
  if (Math.abs(off.deviation) > 1e-9) {
    add(shape('line', { x1: X(off.x), y1: Y(off.y), x2: X(off.foot[0]), y2: Y(off.foot[1]), class: 'worst' }));
    const right = X(off.x) > width * 0.7, out = Y(off.y) < Y(off.foot[1]) ? -1 : 1;
    add(shape('text', { x: X(off.x) + (right ? -8 : 8), y: Math.max(12, Math.min(height - 4, Y(off.y) + out * 10 + 4)), class: right ? 'y halo' : 'halo' }, `${say('largest')} ${fixed(Math.abs(off.deviation), 3)}`));
  }
  if (squares)
    f.rows.forEach((r, i) => { for (const p of i === row ? [] : r.places) if (Math.abs(p.x - r.x) + Math.abs(p.y - r.y) > 0) add(testedMark(X(p.x), Y(p.y), dot * 0.8, p.sign, 'faint')); });

  const now = f.rows[row];
  add(signMark(X(f.rows[0].x), Y(f.rows[0].y), dot * 0.9, 0, 'begin'));
  for (const p of now.places) if (p.x !== now.x || p.y !== now.y) {
    add(shape('line', { x1: X(now.x), y1: Y(now.y), x2: X(p.x), y2: Y(p.y), class: 'look' }));
    add(testedMark(X(p.x), Y(p.y), dot * 1.35, p.sign));
  }
  if (now.step[0] || now.step[1]) add(arrow(X(now.x), Y(now.y), X(now.x + now.step[0]), Y(now.y + now.step[1]), Math.min(12, unit * 0.3)));
  add(shape('circle', { cx: X(now.x), cy: Y(now.y), r: Math.max(5, dot * 1.6), class: 'cursor' }));
  // numbers along both axes, on clear ground
  add(shape('rect', { x: 0, y: 0, width: LEFT, height: height + BELOW, class: 'clear' }));
  add(shape('rect', { x: 0, y: height, width, height: BELOW, class: 'clear' }));
  const label = Math.max(1, [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000].find((n) => n * unit >= 46) ?? 5000);
  for (let x = Math.ceil((bounds.left + 0.5) / label) * label; x < bounds.right; x += label) add(shape('text', { x: X(x), y: height + 12, class: 'x tick' }, fixed(x, 0)));
  for (let y = Math.ceil((bounds.low + 0.5) / label) * label; y < bounds.high; y += label) add(shape('text', { x: LEFT - 4, y: Y(y) + 4, class: 'y tick' }, fixed(y, 0)));
  if (pick) {
    const reach = unit * 0.5;
    svg.addEventListener('click', (event) => {
      const box = (svg as unknown as SVGSVGElement).getBoundingClientRect(), scale = width / box.width;
      const x = bounds.left - MARGIN + ((event.clientX - box.left) * scale - LEFT) / unit, y = bounds.high + MARGIN - ((event.clientY - box.top) * scale) / unit;
      let best = -1, least = Math.max(reach / unit, 0.5);
      f.rows.forEach((r, i) => { const away = Math.hypot(r.x - x, r.y - y); if (away < least) { least = away; best = i; } });
      if (best >= 0) pick(best);
    });
  }
  return svg;
}

export function arrow(x1: number, y1: number, x2: number, y2: number, head: number): SVGElement {
  const length = Math.hypot(x2 - x1, y2 - y1) || 1, ux = (x2 - x1) / length, uy = (y2 - y1) / length, h = Math.min(head, length * 0.5);
  const bx = x2 - ux * h, by = y2 - uy * h, g = shape('g', { class: 'arrow' });
  g.append(shape('line', { x1, y1, x2: bx, y2: by }));
  g.append(shape('path', { d: `M${x2.toFixed(2)} ${y2.toFixed(2)}L${(bx - uy * h * 0.5).toFixed(2)} ${(by + ux * h * 0.5).toFixed(2)} ${(bx + uy * h * 0.5).toFixed(2)} ${(by - ux * h * 0.5).toFixed(2)}z` }));
  return g;
}
