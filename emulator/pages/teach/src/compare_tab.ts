// One case by up to four methods side by side, at the same slot.
import { follow, knownMethods, type Followed } from './core';
import { boundsOf, latticeView } from './lattice_view';
import { joinWords, MOST_COMPARED, state } from './state';
import { fixed, made, say } from './words';

const MOST_MOVES = 48;

const letters = (f: Followed): string =>
  f.rows.slice(0, -1).map((r) => r.step.map((s, k) => (s > 0 ? 'XY'[k] : s < 0 ? 'xy'[k] : '')).join('') || '.').join(f.diagonals ? ' ' : '');

export function comparedCases(): Followed[] {
  const known = knownMethods();
  let names = state.compared.filter((m) => known.includes(m));
  if (!names.length) names = known.slice(0, MOST_COMPARED);
  return names.map((m) => follow(m)).filter((f): f is Followed => typeof f !== 'string');
}

export function drawCompare(change: () => void): void {
  const at = (id: string): HTMLElement => document.getElementById(id)!;
  const cases = comparedCases(), chosen = cases.map((f) => f.method);
  const chips = at('compared');
  chips.replaceChildren();
  for (const name of knownMethods()) {
    const label = made('label', '', 'chip'), box = made('input');
    box.type = 'checkbox';
    box.value = name;
    box.checked = chosen.includes(name);
    box.disabled = !box.checked && chosen.length >= MOST_COMPARED;
    box.onchange = () => {
      const next = box.checked ? [...chosen, name] : chosen.filter((m) => m !== name);
      if (next.length) state.compared = knownMethods().filter((m) => next.includes(m));
      change();
      at('compared').querySelector<HTMLInputElement>(`input[value=${name}]`)?.focus();
    };
    label.append(box, ` ${name}`);
    if (name.startsWith('printed')) label.title = say('as printed, to be seen failing');
    chips.append(label);
  }
  const bounds = boundsOf(cases), views = at('compare-views');
  const wide = bounds.right - bounds.left > 1.5 * (bounds.high - bounds.low), abreast = Math.min(cases.length, wide ? 2 : 4);
  views.className = `abreast${abreast}`;
  const box = (views.clientWidth - 24 * (abreast - 1)) / abreast || 600;
  views.replaceChildren();
  for (const f of cases) {
    const figure = made('figure');
    const row = Math.min(state.row, f.rows.length - 1);
    figure.append(made('figcaption', `${f.method}: ${fixed(f.slots, 0)} ${say('slots')}, ${say('largest')} ${fixed(f.worst, 3)} h`));
    figure.append(latticeView(f, row, bounds, { width: box, height: 340, squares: f.method === 'half_step' || f.method === 'crossing', nodes: true, label: `${joinWords(state.words)}, ${f.method}` }));
    views.append(figure);
  }
  const table = made('table'), head = table.createTHead().insertRow();
  table.id = 'comparison';
  for (const name of ['method', 'slots', 'pulses', 'idle', 'forced', 'largest', 'rms', 'larger axis', 'steps hash', 'end']) head.append(made('th', say(name)));
  const body = table.createTBody();
  for (const f of cases) {
    const tr = body.insertRow(), th = made('th', f.method);
    th.scope = 'row';
    tr.append(th);
    const last = f.rows[f.rows.length - 1];
    for (const text of [fixed(f.slots, 0), fixed(f.pulses, 0), fixed(f.idle, 0), fixed(f.forced, 0), fixed(f.worst, 4), fixed(f.rms, 4), f.worstSquare < 0 ? '-' : fixed(f.worstSquare, 4), f.hash,
      f.reached ? say('reached') : `${say('missed')}: (${last.x}, ${last.y})`]) tr.insertCell().textContent = text;
  }
  at('compare-table').replaceChildren(table);
  const few = cases.every((f) => f.slots <= MOST_MOVES), width = Math.max(0, ...chosen.map((m) => m.length));
  at('moves').textContent = few ? `${say('Moves (small letters: backwards)')}\n${cases.map((f) => `${f.method.padEnd(width)}  ${letters(f)}`).join('\n')}` : '';
  const slider = at('compare-slider') as HTMLInputElement;
  slider.max = String(Math.max(1, ...cases.map((f) => f.slots)));
  slider.value = String(state.row);
  at('compare-slot').textContent = `${say('slot')} ${state.row}`;
  at('compare-terminal').textContent = `kadr teach compare ${joinWords(state.words)} ${chosen.map((m) => `--method ${m}`).join(' ')}`;
}
