// One case by one method: picture, sentence, table and pulses share a cursor.
import { spacing, type Followed, type Row } from './core';
import { boundsOf, latticeView, near } from './lattice_view';
import { pulseView } from './pulse_view';
import { joinWords, state } from './state';
import { either, fixed, made, say } from './words';

const MOST_ROWS = 400;  // of the table; beyond it a window round the cursor
const FEED_STEPS_S = 1000;

const shown = { squares: true, nodes: true, near: false };

export const moveText = (step: [number, number]): string => step.map((s, k) => (s ? `${s > 0 ? '+' : '\u2212'}${'XY'[k]}` : '')).join('') || '-';
const whole = (value: bigint): string => `${value < 0n ? '\u2212' : ''}${value < 0n ? -value : value}`;
/** A deviation as `kadr teach table` writes it: with its sign where the curve has two sides. */
export const deviationText = (f: Followed, value: number): string => {
  const text = fixed(value, 3);
  return f.rows[0].t < 0 && value > 0 && /[1-9]/.test(text) ? `+${text}` : text;
};

/** Why the axis steps that does: the sentence of the current row. */
export function sentence(f: Followed, row: Row): string {
  const i = f.rows.indexOf(row), last = i === f.rows.length - 1;
  if (last)
    return f.reached ? either('The end node is reached.', 'Конечный узел достигнут.')
      : either(`The end (${f.end.join(', ')}) is missed.`, `Конец (${f.end.join(', ')}) пропущен.`);
  const move = moveText(row.step), steps = either(`so ${move}`, `поэтому ${move}`);
  if (row.forced) return either(`The end decides here, not the sign: ${move}.`, `Здесь решает конец, а не знак: ${move}.`);
  if (row.t >= 0) {
    const axis = row.step[0] ? 'X' : 'Y';
    return either(`${axis} is the first to cross the middle between two nodes, at t = ${fixed(row.t, 6)}, ${steps}.`, `Ось ${axis} первой пересекает середину между узлами, при t = ${fixed(row.t, 6)}, ${steps}.`);
  }
  const name = (f.testedName || f.valueName).replace('=', ' = '), value = f.testedName ? row.tested : row.value;
  if (!name) return either(`${move} by the method's own count.`, `${move} по счёту самого метода.`);
  if (/^dda/.test(f.method)) {
    const registers = `${name} = ${whole(value)}, ${f.testedYName} = ${whole(row.testedY)}`;
    return move === '-' ? either(`Registers ${registers}: none overflows, an idle slot.`, `Регистры ${registers}: переполнения нет, пустой такт.`)
      : either(`Registers ${registers}: overflow of ${move.replace(/[+\u2212]/g, '')}, ${steps}.`, `Регистры ${registers}: переполнение ${move.replace(/[+\u2212]/g, '')}, ${steps}.`);
  }
  if (f.method === 'newton' || (f.method === 'progression' && !f.valueName)) return either(`${name} = ${whole(value)}, ${steps}.`, `${name} = ${whole(value)}, ${steps}.`);
  if (f.testedYName) {
    const both = `${name} = ${whole(value)}, ${f.testedYName} = ${whole(row.testedY)}`;
    return row.step[0] && row.step[1] ? either(`${both}: the curve passes between the two points, ${steps}.`, `${both}: кривая проходит между двумя точками, ${steps}.`)
      : either(`${both}: the curve passes beyond one of them, ${steps}.`, `${both}: кривая проходит за одной из них, ${steps}.`);
  }
  const sign = value < 0n ? either('is negative', 'отрицательно') : value > 0n ? either('is positive', 'положительно') : either('is 0: the rule takes it as positive', 'равно 0: по правилу как положительное');
  const ahead = /^(half_step|crossing)$/.test(f.method) && row.places.length === 1;
  const why = ahead ? either(': the curve leaves the dual square through the side of this step', ': кривая выходит из двойственного квадрата через сторону этого шага') : '';
  return either(`${name} = ${whole(value)} ${sign}, ${steps}${why}.`, `${name} = ${whole(value)} ${sign}, ${steps}${why}.`);
}

/** Cells of a row, as `kadr teach table` prints them. */
export function cells(f: Followed, i: number): string[] {
  const r = f.rows[i], last = i === f.rows.length - 1, out = [String(i), fixed(r.x, 0), fixed(r.y, 0)];
  for (const [name, value] of [[f.valueName, r.value], [f.testedName, r.tested], [f.testedYName, r.testedY]] as const) if (name) out.push(last ? '' : whole(value));
  if (f.rows[0].t >= 0) out.push(last ? '' : fixed(r.t, 6));
  out.push(last ? say('end') : moveText(r.step) + (r.forced ? '!' : ''), deviationText(f, r.deviation));
  return out;
}
export function columns(f: Followed): string[] {
  return ['i', 'x', 'y', ...[f.valueName, f.testedName, f.testedYName].filter(Boolean), ...(f.rows[0].t >= 0 ? ['t'] : []), say('move'), say('deviation')];
}

function table(f: Followed, pick: (row: number) => void): HTMLElement {
  const out = made('table'), head = out.createTHead().insertRow();
  out.id = 'steps';
  out.createCaption().textContent = `${say('Step table')}: ${joinWords(state.words)}, ${f.method}`;
  for (const name of columns(f)) head.append(made('th', name));
  const body = out.createTBody(), all = f.rows.length;
  const from = all <= MOST_ROWS ? 0 : Math.max(0, Math.min(all - MOST_ROWS, state.row - MOST_ROWS / 2));
  for (let i = from; i < Math.min(all, from + MOST_ROWS); i++) {
    const tr = body.insertRow();
    tr.dataset.row = String(i);
    cells(f, i).forEach((text, k) => { if (k) tr.insertCell().textContent = text; else { const th = made('th', text); th.scope = 'row'; tr.append(th); } });
    if (i === state.row) { tr.className = 'now'; tr.setAttribute('aria-current', 'step'); }
  }
  body.onclick = (event) => { const tr = (event.target as HTMLElement).closest('tr'); if (tr?.dataset.row) pick(Number(tr.dataset.row)); };
  return out;
}

export function facts(f: Followed): [string, string, string][] {
  const h = either('h', 'h');
  return [
    ['slots', say('slots'), fixed(f.slots, 0)], ['pulses', say('pulses'), fixed(f.pulses, 0)], ['diagonals', say('slots with both axes'), fixed(f.diagonals, 0)],
    ['idle', say('idle slots'), fixed(f.idle, 0)], ['forced', say('forced by the end (!)'), fixed(f.forced, 0)],
    ['worst', say('largest deviation'), `${fixed(f.worst, 4)} ${h}`], ['rms', say('root mean square'), `${fixed(f.rms, 4)} ${h}`],
    ['square', say('in the larger axis'), f.worstSquare < 0 ? '-' : `${fixed(f.worstSquare, 4)} ${h}`], ['length', say('length of the path'), `${fixed(f.length, 3)} ${h}`],
    ['reached', f.reached ? say('end reached') : say('end missed'), `(${f.end.join(', ')})`], ['hash', say('steps hash'), f.hash],
  ];
}

function spacingText(f: Followed): string {
  const line = (crossing: boolean): string => {
    const s = spacing(crossing, FEED_STEPS_S);
    if (!s) return '';
    const of = (a: { least: number; most: number }, k: number): string => `${'XY'[k]} ${a.most ? `${fixed(a.least, 1)} .. ${fixed(a.most, 1)} ${either('us', 'мкс')}` : '-'}`;
    return `${crossing ? say('at the crossings') : say('one slot a pulse')}: ${s.axes.map(of).join(', ')}`;
  };
  const timed = f.rows[0].crossing >= 0;
  return `${say('Time between pulses at 1000 steps/s')}: ${[line(false), timed ? line(true) : ''].filter(Boolean).join('; ')}`;
}

/** Fills the panel; `go` moves the cursor. */
export function drawStep(f: Followed, go: (row: number) => void): void {
  const at = (id: string): HTMLElement => document.getElementById(id)!;
  const now = f.rows[state.row];
  const box = at('picture').clientWidth || 800;
  at('picture').replaceChildren(latticeView(f, state.row, shown.near ? near(f, state.row) : boundsOf([f]), { width: box, height: 560, ...shown, label: `${joinWords(state.words)}, ${f.method}` }, go));
  at('sentence').textContent = (state.row < f.slots ? either(`Slot ${state.row} of ${f.slots}: `, `Такт ${state.row} из ${f.slots}: `) : '') + sentence(f, now);
  const list = at('facts');
  list.replaceChildren();
  for (const [id, name, value] of facts(f)) {
    const dd = made('dd', value);
    dd.dataset.fact = id;
    if (id === 'reached' && !f.reached) dd.className = 'bad';
    list.append(made('dt', name), dd);
  }
  const scroll = at('table-scroll'), top = scroll.scrollTop;
  scroll.replaceChildren(table(f, go));
  scroll.scrollTop = top;
  const tr = scroll.querySelector<HTMLElement>('tr.now');
  if (tr && (tr.offsetTop < scroll.scrollTop + 24 || tr.offsetTop > scroll.scrollTop + scroll.clientHeight - 30)) scroll.scrollTop = tr.offsetTop - scroll.clientHeight / 2;
  at('pulse-view').replaceChildren(pulseView(f, state.row, f.rows[0].crossing >= 0, at('pulse-view').clientWidth || 1000));
  at('spacing').textContent = spacingText(f);
  at('terminal').textContent = `kadr teach table ${joinWords(state.words)} --method ${f.method}`;
  const slider = at('slider') as HTMLInputElement;
  slider.max = String(f.slots);
  slider.value = String(state.row);
}

/** Boxes that leave something out of the picture. */
export function wireStep(redraw: () => void): void {
  for (const name of ['squares', 'nodes', 'near'] as const) {
    const box = document.getElementById(`show-${name}`) as HTMLInputElement;
    box.onchange = () => { shown[name] = box.checked; redraw(); };
  }
}
