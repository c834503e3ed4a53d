// STEP and DIR of both axes over time: one slot a pulse, and below it the pulses at their crossings.
import type { Followed } from './core';
import { drawing, shape } from './svg';
import { fixed, say } from './words';

const LEFT = 74, LANE = 21, GAP = 7, CHARACTER = 6.4;  // pixels
const MOST_SHOWN = 64;  // slots in the window

/** @param timed whether the case has crossings
    @param width px */
export function pulseView(f: Followed, row: number, timed: boolean, width: number): SVGElement {
  const slots = f.slots, first = Math.max(0, Math.min(slots - MOST_SHOWN, row - MOST_SHOWN / 2)), last = Math.min(slots, first + MOST_SHOWN);
  const lanes = timed ? 8 : 4, height = lanes * (LANE + GAP) + (timed ? 58 : 38);
  const svg = drawing(width, height, say('Step pulses over time'), 'pulses');
  const add = (e: SVGElement): void => { svg.append(e); };
  let top = 4;
  const group = (title: string, from: number, to: number, at: (slot: number) => number, high: number, cursor: number, ticks: [number, string][]): void => {
    const X = (t: number): number => LEFT + ((t - from) / (to - from)) * (width - LEFT - 12);
    // a long title begins at the edge of a narrow picture, and is set narrower rather than cut off
    const wide = title.length * CHARACTER, at_edge = LEFT + wide > width - 4;
    add(shape('text', { x: at_edge ? 4 : LEFT, y: top + 11, class: 'soft', ...(wide > width - 8 ? { textLength: width - 8, lengthAdjust: 'spacingAndGlyphs' } : {}) }, title));
    top += 16;
    const begin = top;
    for (const axis of [0, 1]) {
      const name = 'XY'[axis];
      let step = `M${LEFT} ${top + LANE}`, dir = '', sign = 0;
      for (let i = 0; i < slots; i++) {
        const moved = f.rows[i].step[axis];
        if (!moved) continue;
        const t = at(i);
        if (moved !== sign) {
          // DIR changes half a pulse before STEP rises
          const x = sign ? Math.max(LEFT, Math.min(width - 12, X(t - high * 0.5))) : LEFT, level = (s: number): number => (s > 0 ? top + LANE + GAP + 4 : top + LANE + GAP + LANE);
          dir += sign ? `H${x.toFixed(1)}V${level(moved)}` : `M${LEFT} ${level(moved)}`;
          sign = moved;
        }
        if (t < from || t + high > to + 1e-9) continue;
        step += `H${X(t).toFixed(1)}V${top + 4}H${X(t + high).toFixed(1)}V${top + LANE}`;
      }
      add(shape('text', { x: LEFT - 10, y: top + LANE - 5, class: 'y' }, `STEP ${name}`));
      add(shape('path', { d: `${step}H${width - 12}`, class: `pulse p${axis}` }));
      top += LANE + GAP;
      add(shape('text', { x: LEFT - 10, y: top + LANE - 5, class: 'y soft' }, `DIR ${name}`));
      add(shape('path', { d: dir ? `${dir}H${width - 12}` : `M${LEFT} ${top + LANE}H${width - 12}`, class: `pulse dir p${axis}` }));
      top += LANE + GAP;
    }
    if (cursor >= from && cursor <= to) add(shape('line', { x1: X(cursor), y1: begin, x2: X(cursor), y2: top - GAP + 2, class: 'now' }));
    for (const [t, text] of ticks) add(shape('text', { x: X(t), y: top + 7, class: 'x tick' }, text));
    top += 14;
  };
  const uniform: [number, string][] = [];
  const every = last - first <= 24 ? 1 : last - first <= 48 ? 2 : 4;
  for (let i = first; i <= last; i += every) uniform.push([i, String(i)]);
  group(say('One slot a pulse: time in slots'), first, Math.max(last, first + 1), (i) => i, 0.5, row, uniform);
  if (timed) {
    // the same part of the way, in steps along the ideal path at a constant feed
    const along = (i: number): number => (i >= slots ? f.length : f.rows[i].crossing);
    const from = first === 0 ? 0 : along(first), to = last >= slots ? f.length : along(last);
    const every2 = [1, 2, 5, 10, 20].find((n) => (to - from) / n <= 24) ?? 50, ticks: [number, string][] = [];
    for (let s = Math.ceil(from / every2) * every2; s <= to; s += every2) ticks.push([s, fixed(s, 0)]);
    group(say('At the crossings: place on the ideal path at a constant feed, steps'), from, Math.max(to, from + 1e-6), along, 0.3, along(row), ticks);
  }
  return svg;
}
