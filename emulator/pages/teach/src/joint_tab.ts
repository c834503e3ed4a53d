// Two Beziers and their curvature vectors as a comb: what |1/R| hides, the comb shows.
import { comb, joint, segment, type Vector } from './core';
import { chainOf } from './paper_curves';
import { JOINTS, state, type Joint } from './state';
import { drawing, polyline, shape } from './svg';
import { either, fixed, made, say } from './words';

const SIZE_X = 760, SIZE_Y = 520, PLACES = 48;

/** Two directions of the drawing's plane. */
type Eyes = { right: Vector; up: Vector };
const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a: Vector): Vector => { const l = Math.hypot(...a) || 1; return [a[0] / l, a[1] / l, a[2] / l]; };
const cross = (a: Vector, b: Vector): Vector => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const turned = (yaw: number, pitch: number): Eyes => ({
  right: [Math.cos(yaw), Math.sin(yaw), 0],
  up: [-Math.sin(yaw) * Math.sin(pitch), Math.cos(yaw) * Math.sin(pitch), Math.cos(pitch)],
});
const along = (d: Vector): Eyes => { const right = unit(cross(d, [0, 0, 1])); return { right, up: unit(cross(right, d)) }; };

const view = { kind: 'iso' as 'iso' | 'xy' | 'xz' | 'joint', yaw: 0.6, pitch: 0.45, scale: 6 };

function eyes(tangent: Vector): Eyes {
  if (view.kind === 'xy') return { right: [1, 0, 0], up: [0, 1, 0] };
  if (view.kind === 'xz') return { right: [1, 0, 0], up: [0, 0, 1] };
  return view.kind === 'joint' ? along(tangent) : turned(view.yaw, view.pitch);
}

function picture(): SVGElement {
  const j = joint(), e = eyes(j.tangent), combs = [0, 1].map((c) => comb(c, PLACES));
  const tip = (p: { at: Vector; curvature: Vector }): Vector => p.at.map((v, k) => v + view.scale * p.curvature[k]) as Vector;
  const flat = (v: Vector): [number, number] => [dot(v, e.right), dot(v, e.up)];
  const all = combs.flat().flatMap((p) => [flat(p.at), flat(tip(p))]);
  const low = [0, 1].map((k) => Math.min(...all.map((p) => p[k]))), high = [0, 1].map((k) => Math.max(...all.map((p) => p[k])));
  const scale = Math.min((SIZE_X - 80) / (high[0] - low[0] || 1), (SIZE_Y - 70) / (high[1] - low[1] || 1), 60);
  const place = (v: Vector): [number, number] => {
    const [x, y] = flat(v);
    return [SIZE_X / 2 + (x - (low[0] + high[0]) / 2) * scale, SIZE_Y / 2 - (y - (low[1] + high[1]) / 2) * scale];
  };
  const svg = drawing(SIZE_X, SIZE_Y, say('Joints'), 'joints');
  combs.forEach((points, c) => {
    for (const p of points) { const [x1, y1] = place(p.at), [x2, y2] = place(tip(p)); svg.append(shape('line', { x1, y1, x2, y2, class: `tooth f${c}` })); }
    svg.append(polyline(points.map((p) => place(tip(p))), `crest s${c}`), polyline(points.map((p) => place(p.at)), `line curve s${c}`));
  });
  const before = combs[0][PLACES], after = combs[1][0], [x0, y0] = place(before.at);
  for (const [p, c] of [[before, 0], [after, 1]] as const) { const [x2, y2] = place(tip(p)); svg.append(shape('line', { x1: x0, y1: y0, x2, y2, class: `normal s${c}` })); }
  svg.append(shape('circle', { cx: x0, cy: y0, r: 5, class: 'begin' }));
  const [cx, cy] = place(combs[0][0].at), [ex, ey] = place(combs[1][PLACES].at);
  svg.append(shape('text', { x: cx + 6, y: cy + 16, class: 'halo' }, say('Curve 1')), shape('text', { x: ex - 6, y: ey - 8, class: 'y halo' }, say('Curve 2')), shape('text', { x: x0 + 8, y: y0 + 18, class: 'halo' }, say('joint')));
  return svg;
}

function numbers(points: Vector[]): HTMLElement {
  const j = joint(), [a, b] = [segment(0), segment(1)], largest = Math.max(1 / a.radius, 1 / b.radius), deg = (r: number): string => `${fixed((r * 180) / Math.PI, 2)}\u00b0`;
  const mm = either('mm', 'мм');
  const list = made('dl', '', 'facts');
  const rows: [string, string, string][] = [
    ['gap', say('gap'), `${fixed(j.gap, 6)} ${mm}`], ['tangents', say('angle between tangents'), deg(j.tangentAngle)], ['ratio', say('ratio of |dB/dt|'), fixed(j.speedRatio, 3)],
    ['curvatures', say('curvature before and after'), `${fixed(j.before, 6)}, ${fixed(j.after, 6)} 1/${mm}`], ['normals', say('angle between normals'), deg(j.normalAngle)],
    ['jump', say('jump of the curvature vector'), `${fixed(j.jump, 6)} 1/${mm}`], ['share', say('of the largest curvature'), `${fixed((100 * j.jump) / largest, 0)} %`], ['second', say('jump of the second derivative'), `${fixed(j.secondJump, 3)} ${mm}`],
    ...([a, b] as const).map((s, k) => [`radius${k + 1}`, `${say(`Curve ${k + 1}`)}: ${say('smallest radius')}`, `${fixed(s.radius, 6)} ${mm}, t = ${fixed(s.t, 5)}`] as [string, string, string]),
  ];
  for (const [id, name, value] of rows) { const dd = made('dd', value); dd.dataset.fact = id; list.append(made('dt', name), dd); }
  const table = made('table');
  table.createCaption().textContent = say('Control points of curve 2, mm');
  points.forEach((p, i) => { const tr = table.insertRow(); tr.append(made('th', `P${i}`)); for (const v of p) tr.insertCell().textContent = fixed(v, 4); });
  const out = made('div');
  out.append(list, table);
  return out;
}

const LESSON: Record<Joint, () => string> = {
  paper: () => {
    const j = joint(), [before, after, turn] = [fixed(j.before, 3), fixed(j.after, 3), fixed((j.normalAngle * 180) / Math.PI, 0)];
    return either(`Both curves have nearly the same curvature at the joint, ${before} and ${after} 1/mm, and a plot of R looks smooth. But the centres lie in different directions: the comb flips by ${turn}\u00b0, and the acceleration across the path jumps with it.`,
      `Кривизны у стыка почти равны, ${before} и ${after} 1/мм, и график R выглядит гладким. Но центры лежат в разных направлениях: гребень поворачивается на ${turn}\u00b0, и поперечное ускорение делает скачок.`);
  },
  g2: () => either('The third point of curve 2 is moved so that the curvature vector goes on: G2. Speed along t may still change at the joint, which a machine that moves by length doesn\u2019t feel.',
    'Третья точка кривой 2 сдвинута так, что вектор кривизны продолжается: G2. Скорость по t на стыке может меняться, но станок, идущий по длине, этого не чувствует.'),
  c2: () => either('Second and third point are moved: first and second derivatives by t go on, which is what the paper says of its own curves.',
    'Сдвинуты вторая и третья точки: первая и вторая производные по t продолжаются — то, что статья утверждает о своих кривых.'),
};

export function drawJoint(change: () => void): void {
  const at = (id: string): HTMLElement => document.getElementById(id)!;
  const chain = chainOf(state.joint);
  at('joint-view').replaceChildren(picture());
  at('joint-numbers').replaceChildren(numbers(chain[1]));
  at('joint-words').textContent = LESSON[state.joint]();
  const press = (box: string, value: string, set: (v: string) => void): void => {
    for (const b of document.querySelectorAll<HTMLButtonElement>(`#${box} button`)) {
      b.setAttribute('aria-pressed', String(b.value === value));
      b.onclick = () => { set(b.value); change(); };
    }
  };
  press('joint-kinds', state.joint, (v) => { state.joint = JOINTS.find((k) => k === v)!; });
  press('joint-eyes', view.kind, (v) => { view.kind = v as typeof view.kind; });
  const scale = at('comb-scale') as HTMLInputElement;
  scale.value = String(view.scale);
  scale.oninput = () => { view.scale = Number(scale.value); drawJoint(change); };
  const box = at('joint-view');
  box.onpointermove = (event) => {
    if (!event.buttons) return;
    view.kind = 'iso';
    view.yaw -= event.movementX * 0.01;
    view.pitch = Math.max(-1.5, Math.min(1.5, view.pitch + event.movementY * 0.01));
    drawJoint(change);
  };
  box.onkeydown = (event) => {
    const turn = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    if (!turn) return;
    event.preventDefault();
    view.kind = 'iso';
    view.yaw += turn[0];
    view.pitch = Math.max(-1.5, Math.min(1.5, view.pitch + turn[1]));
    drawJoint(change);
  };
}
