// The program's text, only the rows in sight; the line under way at the cursor is marked, a click shows the line's motion.
import { type Run, blockAt } from './data';
import type { State } from './state';
import { made } from './text';

const ROW_PX = 20, AROUND = 10;

export class Listing {
  private readonly begins = new Map<number, { from_s: number; to_s: number }>();
  private readonly alarms: Set<number>;
  private line = 0;

  constructor(private readonly run: Run, private readonly state: State, private readonly box: HTMLElement, private readonly rows: HTMLElement) {
    const { t_s, line } = run.blocks;
    // a line's motion: from its first block's beginning to the next other line's
    for (let i = 0; i < t_s.length; i++) {
      const end = t_s[i + 1] ?? run.end_s, known = this.begins.get(line[i]);
      if (!known) this.begins.set(line[i], { from_s: t_s[i], to_s: end });
      else if (line[i - 1] === line[i] && known.to_s === t_s[i]) known.to_s = end;
    }
    this.alarms = new Set(run.meta.events.filter((e) => e.kind === 'alarm').map((e) => e.line));
    rows.style.height = `${run.program.length * ROW_PX}px`;
    box.addEventListener('scroll', () => this.draw());
    box.addEventListener('keydown', (e) => this.key(e));
    state.add({ cursor: (t) => this.follow(t) });
    this.draw();
  }

  get current(): number { return this.line; }

  /** Marks a line and brings it into sight. */
  show(line: number): void {
    this.line = line;
    const top = (line - 1) * ROW_PX, { scrollTop, clientHeight } = this.box;
    if (top < scrollTop + ROW_PX || top > scrollTop + clientHeight - 2 * ROW_PX) this.box.scrollTop = top - clientHeight / 2;
    this.draw();
  }

  /** Shows when a line is run; false: it moves nothing. */
  go(line: number): boolean {
    const span = this.begins.get(line);
    this.show(line);
    if (!span) return false;
    const width = Math.max(span.to_s - span.from_s, 1e-6);
    this.state.setWindow(span.from_s - 0.2 * width, span.to_s + 0.2 * width);
    this.state.setCursor(span.from_s);
    this.show(line);
    return true;
  }

  private follow(t_s: number): void {
    if (Number.isNaN(t_s)) return;
    const block = blockAt(this.run, t_s);
    if (block >= 0 && this.run.blocks.line[block] !== this.line) this.show(this.run.blocks.line[block]);
  }

  private draw(): void {
    const first = Math.max(0, Math.floor(this.box.scrollTop / ROW_PX) - AROUND);
    const end = Math.min(this.run.program.length, first + Math.ceil(this.box.clientHeight / ROW_PX) + 2 * AROUND);
    const rows: HTMLElement[] = [];
    for (let i = first; i < end; i++) {
      const line = i + 1, row = made('div', '', `row${line === this.line ? ' now' : ''}${this.alarms.has(line) ? ' alarm' : ''}`);
      row.style.top = `${i * ROW_PX}px`;
      row.dataset.line = String(line);
      row.setAttribute('role', 'option');
      row.setAttribute('aria-selected', String(line === this.line));
      row.append(made('b', String(line)), this.run.program[i]);
      row.onclick = () => this.go(line);
      rows.push(row);
    }
    this.rows.replaceChildren(...rows);
  }

  private key(e: KeyboardEvent): void {
    const by = { ArrowUp: -1, ArrowDown: 1, PageUp: -20, PageDown: 20 }[e.key];
    if (e.key === 'Enter') this.go(this.line);
    else if (by !== undefined) this.show(Math.max(1, Math.min(this.run.program.length, this.line + by)));
    else return;
    e.preventDefault();
  }
}
