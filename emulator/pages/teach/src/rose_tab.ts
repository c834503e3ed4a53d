// Speed along the path against direction, at one slot a clock period.
import { follow, knownMethods, readCase, rose } from './core';
import { MOST_COMPARED, state } from './state';
import { drawing, shape } from './svg';
import { either, fixed, made, say } from './words';

const DIRECTIONS = 240, RADIUS = 1000, SIZE = 560, SCALE = 168;
const cache = new Map<string, { angle: number; speed: number }[]>();
const speeds = (method: string): { angle: number; speed: number }[] => {
  if (!cache.has(method)) cache.set(method, rose(method, DIRECTIONS, RADIUS));
  return cache.get(method)!;
};

export function drawRose(change: () => void): void {
  const at = (id: string): HTMLElement => document.getElementById(id)!;
  readCase(['line', '7', '4']);
  // what doesn't reach its end has no speed along the path
  const known = knownMethods().filter((m) => { const f = follow(m); return m !== 'ptp' && m !== 'crossing' && typeof f !== 'string' && f.reached; });
  state.roses = state.roses.filter((m) => known.includes(m));
  const chips = at('rose-methods');
  chips.replaceChildren();
  for (const name of known) {
    const label = made('label', '', 'chip'), box = made('input');
    box.type = 'checkbox';
    box.value = name;
    box.checked = state.roses.includes(name);
    box.disabled = !box.checked && state.roses.length >= MOST_COMPARED;
    box.onchange = () => {
      state.roses = known.filter((m) => (m === name ? box.checked : state.roses.includes(m)));
      change();
      chips.querySelector<HTMLInputElement>(`input[value=${name}]`)?.focus();
    };
    label.append(box, ` ${name}`);
    chips.append(label);
  }
  const middle = SIZE / 2, svg = drawing(SIZE, SIZE, say('Speed rose'), 'rose');
  const point = (angle: number, r: number): [number, number] => [middle + r * SCALE * Math.cos(angle), middle - r * SCALE * Math.sin(angle)];
  for (const r of [0.5, 1, Math.SQRT2]) svg.append(shape('circle', { cx: middle, cy: middle, r: r * SCALE, class: r === 1 ? 'unit' : 'grid' }));
  for (let deg = 0; deg < 360; deg += 45) {
    const a = (deg * Math.PI) / 180, [x, y] = point(a, 1.46), [tx, ty] = point(a, 1.53);
    svg.append(shape('line', { x1: middle, y1: middle, x2: x, y2: y, class: 'grid' }), shape('text', { x: tx, y: ty + 4, class: 'x tick' }, `${deg}\u00b0`));
  }
  for (const [r, text] of [[0.5, '0.5'], [1, '1'], [Math.SQRT2, '1.414']] as const) { const [x, y] = point(-0.3, r); svg.append(shape('text', { x: x + 4, y: y + 4, class: 'tick halo' }, text)); }
  state.roses.forEach((m, k) => {
    const d = speeds(m).map((p, i) => { const [x, y] = point(p.angle, p.speed); return `${i ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`; }).join('');
    svg.append(shape('path', { d: `${d}z`, class: `line s${k}` }));
  });
  const angle = (state.angle * Math.PI) / 180, [hx, hy] = point(angle, 1.46);
  svg.append(shape('line', { x1: middle, y1: middle, x2: hx, y2: hy, class: 'now' }));
  const nearest = (m: string): number => speeds(m).reduce((best, p) => (Math.abs(wrap(p.angle - angle)) < Math.abs(wrap(best.angle - angle)) ? p : best)).speed;
  state.roses.forEach((m, k) => { const [x, y] = point(angle, nearest(m)); svg.append(shape('circle', { cx: x, cy: y, r: 5, class: `dot f${k}` })); });
  at('rose-view').replaceChildren(svg);

  const table = made('table'), head = table.createTHead().insertRow();
  table.id = 'rose-table';
  table.createCaption().textContent = say('speed, steps a slot');
  head.append(made('th', say('method')));
  for (const text of [`${say('at')} ${fixed(state.angle, 0)}\u00b0`, '0\u00b0', '15\u00b0', '30\u00b0', '45\u00b0', say('max / min')]) head.append(made('th', text));
  const body = table.createTBody();
  const addRow = (name: string, k: number, values: number[], ratio: number): void => {
    const tr = body.insertRow(), th = made('th', '', 'named');
    th.scope = 'row';
    const key = drawing(26, 8, '');
    key.append(shape('line', { x1: 0, y1: 4, x2: 26, y2: 4, class: k < 0 ? 'unit' : `line s${k}` }));
    th.append(key, ` ${name}`);
    tr.append(th);
    for (const v of [...values, ratio]) tr.insertCell().textContent = fixed(v, 3);
  };
  state.roses.forEach((m, k) => {
    const all = speeds(m), at15 = (deg: number): number => all[Math.round((deg / 360) * DIRECTIONS)].speed, every = all.map((p) => p.speed);
    addRow(m, k, [nearest(m), at15(0), at15(15), at15(30), at15(45)], Math.max(...every) / Math.min(...every));
  });
  addRow(say('pulses at the crossings'), -1, [1, 1, 1, 1, 1], 1);
  at('rose-numbers').replaceChildren(table);
  (at('rose-angle') as HTMLInputElement).value = String(state.angle);
  at('rose-words').textContent = either(
    `At ${state.angle}\u00b0 a line of ${RADIUS} steps takes as many slots as its method says; speed is length over slots. One axis a slot slows down to 0.707 on a diagonal, both axes in a slot speed up to 1.414: a factor of 1.414 either way. Pulses at the moments of their crossings keep the feed in every direction (the thin circle).`,
    `При ${state.angle}\u00b0 отрезок в ${RADIUS} шагов занимает столько тактов, сколько требует метод; скорость — длина, делённая на такты. Одна ось за такт замедляет до 0.707 на диагонали, две оси за такт ускоряют до 1.414: множитель 1.414 в обе стороны. Импульсы в моменты пересечений держат подачу в любом направлении (тонкая окружность).`);
}

const wrap = (a: number): number => Math.atan2(Math.sin(a), Math.cos(a));
