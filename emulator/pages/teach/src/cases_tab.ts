// The eight cases of the half-step method (paper 002, Fig. 3): four directions of travel, two outcomes each. Every card is a
// slot of a line that the core has followed; a click leads to it.
import { follow, readCase, type Row } from './core';
import { state } from './state';
import { arrow } from './lattice_view';
import { drawing, polyline, shape, signMark, testedMark } from './svg';
import { either, made } from './words';

const UNIT = 62;
const TRAVEL: [number, number][] = [[1, 1], [-1, 1], [-1, -1], [1, -1]];

function card(row: Row, d: [number, number], letter: string): SVGElement {
  const size = 3 * UNIT, svg = drawing(size, size, letter, 'lattice');
  const X = (x: number): number => (x - row.x + 1.5) * UNIT, Y = (y: number): number => (row.y + 1.5 - y) * UNIT;
  let grid = '';
  for (const k of [-1, 0, 1]) grid += `M${X(row.x + k)} 0V${size}M0 ${Y(row.y + k)}H${size}`;
  svg.append(shape('path', { d: grid, class: 'grid' }), shape('rect', { x: X(row.x - 0.5), y: Y(row.y + 0.5), width: UNIT, height: UNIT, class: 'dual now' }));
  const [dx, dy] = d, length = Math.abs(dx) + Math.abs(dy);
  // the line through the origin, as far as the card shows it
  const t0 = (row.x * dx + row.y * dy) / (dx * dx + dy * dy), far = 3 / length;
  const clip = [t0 - far, t0 + far].map((t) => [X(t * dx), Y(t * dy)] as [number, number]);
  svg.append(polyline(clip, 'ideal'));
  const [corner] = row.places;
  svg.append(shape('line', { x1: X(row.x), y1: Y(row.y), x2: X(corner.x), y2: Y(corner.y), class: 'look' }), testedMark(X(corner.x), Y(corner.y), 8, corner.sign));
  svg.append(arrow(X(row.x), Y(row.y), X(row.x + row.step[0]), Y(row.y + row.step[1]), 12), signMark(X(row.x), Y(row.y), 6, 0, 'begin'));
  svg.append(shape('text', { x: 8, y: 20, class: 'letter halo' }, letter));
  return svg;
}

export function drawCases(open: () => void): void {
  const sheet = document.getElementById('case-sheet')!;
  sheet.replaceChildren();
  for (const outcome of [0, 1])
    TRAVEL.forEach(([sx, sy], k) => {
      const d: [number, number] = [7 * sx, 4 * sy], words = ['line', String(d[0]), String(d[1])];
      readCase(words);
      const f = follow('half_step');
      if (typeof f === 'string') return;
      const at = f.rows.findIndex((r, i) => i > 0 && r.step[outcome] !== 0), row = f.rows[at], letter = 'abcdefgh'[2 * k + outcome];
      const button = made('button', '', 'case');
      button.dataset.case = letter;
      button.append(card(row, d, letter));
      const travel = `${sx > 0 ? '+' : '\u2212'}X ${sy > 0 ? '+' : '\u2212'}Y`, axis = 'XY'[outcome], value = String(row.tested).replace('-', '\u2212');
      button.append(made('span', either(`travel ${travel}; G = ${value}: ${axis} steps`, `ход ${travel}; G = ${value}: шаг ${axis}`)));
      button.onclick = () => { Object.assign(state, { tab: 'step', words, method: 'half_step', row: at }); open(); };
      sheet.append(button);
    });
}
