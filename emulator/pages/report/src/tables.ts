// Tables of events, blocks and values; rows that stand for an instant take the cursor there.
import type { Charts } from './charts';
import type { Run } from './data';
import type { Listing } from './listing';
import type { State } from './state';
import { byStep, fixed, made, say } from './text';

const MOST_ROWS = 500;

function head(...words: string[]): HTMLTableSectionElement {
  const out = made('thead'), row = made('tr');
  for (const word of words) { const th = made('th', say(word)); th.scope = 'col'; row.append(th); }
  out.append(row);
  return out;
}

function row(cells: string[], t_s: number, line: number): HTMLTableRowElement {
  const out = made('tr');
  cells.forEach((text, k) => out.append(k === 0 ? made('th', text) : made('td', text, k === cells.length - 1 ? 'code' : '')));
  if (Number.isFinite(t_s)) out.dataset.t = String(t_s);
  if (line > 0) out.dataset.line = String(line);
  return out;
}

/** Every row with an instant or a line, wherever it stands, leads there by click or Enter. */
export function linkRows(run: Run, state: State, listing: Listing, status: HTMLElement): void {
  const go = (at: HTMLElement): void => {
    const line = Number(at.dataset.line ?? 0), t_s = Number(at.dataset.t ?? NaN);
    if (Number.isFinite(t_s)) state.jump(t_s, at.dataset.width ? Number(at.dataset.width) : Math.min(0.2, run.end_s - run.first_s));
    else if (line > 0) listing.go(line);
    state.tell();
    if (line > 0) listing.show(line);
    document.querySelectorAll('tr.now').forEach((r) => r.classList.remove('now'));
    at.classList.add('now');
    status.textContent = `${say('line')} ${line || '-'}, ${Number.isFinite(t_s) ? fixed(t_s, 4) : '-'} s`;
  };
  const rowOf = (e: Event): HTMLElement | null => (e.target as Element).closest<HTMLElement>('tr[data-t], tr[data-line]');
  document.addEventListener('click', (e) => { const at = rowOf(e); if (at) go(at); });
  document.addEventListener('keydown', (e) => { const at = e.key === 'Enter' ? rowOf(e) : null; if (at) go(at); });
  linkable();
}
function linkable(): void {
  for (const at of document.querySelectorAll<HTMLElement>('tr[data-t], tr[data-line]')) at.tabIndex = 0;
}

export function eventTable(run: Run): void {
  const table = document.getElementById('events')!, body = made('tbody');
  for (const e of run.meta.events.slice(0, MOST_ROWS)) {
    const at = row([`${fixed(e.t_s, 4)} s`, e.line > 0 ? String(e.line) : '', say(e.kind), e.text], e.t_s, e.line);
    if (e.kind === 'alarm') at.className = 'alarm';
    body.append(at);
  }
  table.replaceChildren(head('at', 'line', 'kind', 'what'), body);
  const all = run.meta.events.length + run.meta.events_left_out;
  document.getElementById('event-count')!.textContent = all > MOST_ROWS ? `${MOST_ROWS} / ${all}` : String(all);
  linkable();
}

/** Blocks; a click on a head sorts by that column. */
export class BlockTable {
  private by = -1;
  private down = false;
  constructor(private readonly run: Run) {
    // hundreds of rows below what is seen first: after the first picture
    setTimeout(() => this.draw(), 100);
  }

  draw(): void {
    const { blocks: b, meta, program } = this.run, n = b.t_s.length, order = Array.from({ length: n }, (_, i) => i);
    const keys: ((i: number) => number)[] = [(i) => b.t_s[i], (i) => b.line[i], (i) => b.length_u[i], (i) => b.planned_s[i], (i) => b.programmed_u_s[i],
      (i) => b.peak_u_s[i], (i) => b.limited_by[i], (i) => b.line[i]];
    if (this.by >= 0) order.sort((x, y) => (keys[this.by](x) - keys[this.by](y)) * (this.down ? -1 : 1) || x - y);
    const body = made('tbody'), u = meta.path_unit;
    for (const i of order.slice(0, MOST_ROWS)) {
      const at = row([`${fixed(b.t_s[i], 3)} s`, String(b.line[i]), `${fixed(b.length_u[i], 3)} ${u}`, `${fixed(b.planned_s[i], 3)} s`,
        b.programmed_u_s[i] > 0 ? `${fixed(b.programmed_u_s[i], 3)} ${u}/s` : '-', `${fixed(b.peak_u_s[i], 3)} ${u}/s`, say(b.words[b.limited_by[i]]),
        b.text.length ? b.text[i] : program[b.line[i] - 1] ?? ''], b.t_s[i], b.line[i]);
      at.dataset.width = String(Math.max(0.02, 1.4 * b.planned_s[i]));
      body.append(at);
    }
    const top = head('at', 'line', 'length', 'planned time', 'F', 'feed, peak', 'limited by', 'text');
    top.querySelectorAll('th').forEach((th, k) => {
      th.tabIndex = 0;
      th.setAttribute('aria-sort', this.by === k ? (this.down ? 'descending' : 'ascending') : 'none');
      if (this.by === k) th.append(this.down ? ' ▼' : ' ▲');
      const sort = (): void => { this.down = this.by === k ? !this.down : k > 1; this.by = k; this.draw(); };
      th.onclick = sort;
      th.onkeydown = (e) => { if (e.key === 'Enter') sort(); };
    });
    document.getElementById('blocks')!.replaceChildren(top, body);
    document.getElementById('block-count')!.textContent = n > MOST_ROWS || b.left_out ? `${Math.min(n, MOST_ROWS)} / ${n + b.left_out}` : String(n);
    linkable();
  }
}

/** The charts in numbers, for those who do not see them: extremes of the window, value at the cursor. */
export function valueTable(state: State, charts: Charts): () => void {
  const table = document.getElementById('window-values')!, details = table.closest('details')!;
  let complete = false;
  const draw = (): void => {
    if (!details.open) return;
    if (!complete) void charts.loaded().then(() => { complete = true; draw(); });
    const body = made('tbody');
    for (const e of charts.extremes()) {
      body.append(row([e.name, byStep(e.low, e.step), byStep(e.high, e.step), Number.isNaN(e.now) ? '' : byStep(e.now, e.step), e.unit], NaN, 0));
    }
    table.replaceChildren(head('signal', 'lowest', 'highest', 'at the cursor', ''), body);
  };
  state.add({ window: draw, cursor: draw });
  details.ontoggle = draw;
  return draw;
}
