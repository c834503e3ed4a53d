// One chart a quantity, all with one window and one cursor. Charts out of sight are drawn when they come into it.
import uPlot from 'uplot';
import { css } from './colours';
import type { Points } from './curve';
import type { Group } from './groups';
import type { State } from './state';
import { byStep, fixed, made, say } from './text';
import { type Columns, DASHES, WIDTH_PX, bars, line } from './trace';

/** An instant that charts show by an upright line. */
export interface Mark { x: number; alarm: boolean }
const CALM_MS = 1200, LEFT_PX = 80;
type Picture = { points: Points } | { columns: Columns };

/** As many decimals as the step between ticks has. */
function tick(value: number, step: number): string {
  let decimals = 0;
  while (decimals < 9 && Math.abs(step * 10 ** decimals - Math.round(step * 10 ** decimals)) > 1e-6) decimals++;
  return fixed(value, decimals);
}

export class Charts {
  readonly plots: uPlot[] = [];
  private values: HTMLElement[][] = [];
  private pictures: Picture[][] = [];
  private stale = new Set<number>();
  private seen = new Set<number>();
  private later = 0;
  private readonly watch = new IntersectionObserver((all) => this.see(all), { rootMargin: '60px' });

  /** @param label  what the charts run over, with its unit */
  constructor(readonly groups: Group[], private readonly state: State, private readonly host: HTMLElement, private readonly label: () => string,
    private readonly marks: Mark[]) {
    this.make();
    state.add({ window: () => this.draw(), cursor: (x) => this.showCursor(x) });
  }

  /** The wheel and the keyboard move the window. */
  listen(): this {
    this.host.onwheel = (e) => this.wheel(e);
    this.host.onkeydown = (e) => this.key(e);
    new ResizeObserver(() => this.resize()).observe(this.host);
    return this;
  }

  /** Others take the place. */
  leave(): void {
    this.watch.disconnect();
    this.stale.clear();
    clearTimeout(this.later);
    for (const plot of this.plots) plot.destroy();
  }

  /** Builds everything anew: language or theme changed. */
  make(): void {
    for (const plot of this.plots) plot.destroy();
    this.watch.disconnect();
    this.plots.length = 0;
    this.values = [];
    this.pictures = this.groups.map((g) => g.curves.map(() => ({ columns: { low: new Float32Array(), high: new Float32Array() } })));
    this.host.replaceChildren();
    const width = this.width();  // asked once: after each change of the page the answer costs a layout
    this.groups.forEach((g, k) => this.add(g, k, k === this.groups.length - 1, width));
    this.draw();
  }

  private add(group: Group, k: number, last: boolean, width: number): void {
    const box = made('div', '', 'chart'), title = made('h3', say(group.title) + (group.unit ? `, ${group.unit}` : ''));
    const values: HTMLElement[] = [];
    const colours = group.curves.map((_, i) => css(`--c${i % 6}`));
    group.names.forEach((name, i) => {
      const entry = made('span'), value = made('span', '', 'v');
      const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
      const line = document.createElementNS('http://www.w3.org/2000/svg', 'path');
      for (const [key, text] of Object.entries({ d: 'M0 4H22', stroke: colours[i], 'stroke-width': '2', 'stroke-dasharray': DASHES[i % 6].join(' ') })) line.setAttribute(key, text);
      svg.append(line);
      entry.append(svg, `${say(name)} `, value);
      title.append(entry);
      values.push(value);
    });
    box.append(title);
    this.host.append(box);
    this.values.push(values);
    const axis = { stroke: css('--ink'), grid: { stroke: css('--grid'), width: 1 }, ticks: { stroke: css('--rule'), width: 1 } };
    const values_ = (_: uPlot, splits: number[], _a: number, _s: number, step: number): string[] => splits.map((v) => tick(v, step));
    this.plots.push(new uPlot({
      width, height: last ? 150 : 122,
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { show: false } },
      legend: { show: false },
      scales: { x: { time: false, range: () => [this.state.from_s, this.state.to_s] }, y: { range: (_, lo, hi) => this.scale(lo, hi, Math.max(...group.curves.map((c) => c.track.step))) } },
      axes: [{ ...axis, size: last ? 46 : 28, label: last ? this.label() : undefined, labelSize: 16, values: values_ }, { ...axis, size: LEFT_PX, space: 18, values: values_ }],
      series: [{}, ...colours.map((colour, i) => ({
        stroke: colour, width: WIDTH_PX, dash: DASHES[i % 6], points: { show: false },
        paths: (u: uPlot) => this.trace(u, this.pictures[k][i], colour, DASHES[i % 6]),
      }))],
      hooks: {
        setSelect: [(u) => this.select(u)],
        draw: [(u) => this.drawMarks(u)],
      },
    }, [[], ...group.curves.map(() => [])] as unknown as uPlot.AlignedData, box));
    // of the mouse alone: uPlot's own hook also speaks when a window moves below a cursor at rest
    const plot = this.plots[k];
    plot.over.addEventListener('mousemove', (e) => this.state.setCursor(plot.posToVal(e.clientX - plot.over.getBoundingClientRect().left, 'x')));
    this.watch.observe(box);
  }

  private see(changes: IntersectionObserverEntry[]): void {
    for (const { target, isIntersecting } of changes) {
      const k = [...this.host.children].indexOf(target);
      if (isIntersecting) this.seen.add(k); else this.seen.delete(k);
      if (isIntersecting && this.stale.has(k)) this.drawOne(k);
    }
  }

  /** Room round the values, from 0 if they come near it; what is finer than the data's own steps is not magnified. */
  private scale(lo: number, hi: number, step: number): [number, number] {
    if (!Number.isFinite(lo) || !Number.isFinite(hi)) return [0, 1];
    if (lo === hi && lo !== 0) return lo > 0 ? [0, 1.15 * hi] : [1.15 * lo, 0];
    const least = Math.max(40 * step, 1e-3 * Math.abs(hi)) || 1, middle = (lo + hi) / 2;
    if (hi - lo < least) [lo, hi] = [middle - least / 2, middle + least / 2];
    const room = 0.06 * (hi - lo);
    return [lo >= 0 && lo < 0.3 * hi ? 0 : lo - room, hi + room];
  }

  private width(): number { return Math.max(300, this.host.clientWidth); }
  private resize(): void {
    const width = this.width();
    if (!this.plots.length || this.plots[0].width === width) return;
    for (const plot of this.plots) plot.setSize({ width, height: plot.height });
    this.draw();
  }

  /** @param all  those out of sight too: for paper */
  draw(all = false): void {
    this.groups.forEach((_, k) => {
      if (all || this.seen.has(k)) this.drawOne(k); else this.stale.add(k);
    });
    clearTimeout(this.later);
    this.later = setTimeout(() => void this.rest(), CALM_MS);
  }

  /** Charts out of sight, one at a time, once nothing has moved for a while. */
  private async rest(): Promise<void> {
    const [k] = this.stale;
    if (k === undefined) return;
    await Promise.all(this.groups[k].curves.map((c) => c.track.load()));
    this.drawOne(k);
    this.later = setTimeout(() => void this.rest(), 0);
  }

  /** Nothing in sight waits for its data. */
  get drawn(): boolean { return ![...this.seen].some((k) => this.stale.has(k)); }
  /** Everything is unpacked. */
  async loaded(): Promise<void> { await Promise.all(this.groups.flatMap((g) => g.curves.map((c) => c.track.load()))); }

  private drawOne(k: number): void {
    const missing = this.groups[k].curves.filter((c) => !c.track.loaded);
    if (missing.length) {
      this.stale.add(k);
      void Promise.all(missing.map((c) => c.track.load())).then(() => { if (this.stale.has(k)) this.drawOne(k); });
      return;
    }
    this.stale.delete(k);
    const { from_s: from, to_s: to } = this.state, plot = this.plots[k], n = Math.max(100, Math.round(plot.bbox.width));
    const extremes = this.groups[k].curves.map((curve, i) => {
      const points = curve.points(from, to, 2 * n), columns = { low: new Float32Array(points ? 0 : n), high: new Float32Array(points ? 0 : n) };
      if (!points) curve.columns(from, to, columns.low, columns.high);
      this.pictures[k][i] = points ? { points } : { columns };
      let lo = Infinity, hi = -Infinity;
      for (const values of points ? [points.y] : [columns.low, columns.high])
        for (const v of values) {
          if (v < lo && v !== -Infinity) lo = v;
          if (v > hi && v !== Infinity) hi = v;
        }
      return lo <= hi ? [lo, hi] : [null, null];
    });
    // uPlot makes scales and axes of it; traces come from the pictures
    plot.setData([[from, to], ...extremes] as uPlot.AlignedData);
  }

  private trace(u: uPlot, picture: Picture, colour: string, dash: number[]): uPlot.Series.Paths | null {
    if ('points' in picture) return line(u, picture.points);
    bars(u, picture.columns, colour, dash);
    return null;
  }

  /** Extremes of every signal in the window. */
  extremes(): { name: string; unit: string; step: number; low: number; high: number; now: number }[] {
    return this.groups.flatMap((g) => g.curves.map((c, i) => {
      const [low, high] = c.range(this.state.from_s, this.state.to_s);
      const name = g.curves.some((o) => o.run !== c.run) ? `${g.names[i]} ${c.track.name}` : c.track.name;
      return { name, unit: g.unit, step: c.track.step, low, high, now: c.at(this.state.cursor_s)[1] };
    }));
  }

  private select(u: uPlot): void {
    const { left, width } = u.select;
    if (width > 3) this.state.setWindow(u.posToVal(left, 'x'), u.posToVal(left + width, 'x'));
    u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  }

  private showCursor(x: number): void {
    const there = !Number.isNaN(x), { from_s: from, to_s: to } = this.state;
    this.plots.forEach((plot, k) => {
      // by the window of now: uPlot's own scales follow a little later
      plot.setCursor({ left: there ? (x - from) / (to - from) * plot.bbox.width / (devicePixelRatio || 1) : -10, top: 10 }, false);
      this.groups[k].curves.forEach((c, i) => {
        const [low, high] = there ? c.at(x) : [NaN, NaN];
        const text = Number.isNaN(high) ? '' : low === high ? byStep(high, c.track.step) : `${byStep(low, c.track.step)} .. ${byStep(high, c.track.step)}`;
        if (this.values[k][i].textContent !== text) this.values[k][i].textContent = text;
      });
    });
  }

  /** Full height when there are few in the window, alarms always. */
  private drawMarks(u: uPlot): void {
    const { ctx, bbox } = u;
    const there = this.marks.filter((m) => m.x >= this.state.from_s && m.x <= this.state.to_s);
    const few = there.length <= 25, bad = css('--bad'), soft = css('--soft');
    ctx.save();
    ctx.setLineDash([3, 3]);
    for (const m of there.slice(0, 1000)) {
      const x = u.valToPos(m.x, 'x', true);
      ctx.strokeStyle = m.alarm ? bad : soft;
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + (few || m.alarm ? bbox.height : 8));
      ctx.stroke();
    }
    ctx.restore();
  }

  private wheel(e: WheelEvent): void {
    const over = this.plots[0]?.over.getBoundingClientRect();
    if (!over || (!e.ctrlKey && !e.shiftKey)) return;  // a plain wheel scrolls the page
    e.preventDefault();
    const share = (e.clientX - over.left) / over.width;
    const round = this.state.from_s + share * (this.state.to_s - this.state.from_s);
    if (e.shiftKey) this.state.pan((e.deltaX || e.deltaY) / 1000);
    else this.state.zoom(Math.exp(e.deltaY / 400), round);
  }

  private key(e: KeyboardEvent): void {
    const s = this.state, step = (s.to_s - s.from_s) / 200;
    const at = Number.isNaN(s.cursor_s) ? (s.from_s + s.to_s) / 2 : s.cursor_s;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => (e.shiftKey ? s.setCursor(Math.max(s.from_s, at - step)) : s.pan(-0.1)),
      ArrowRight: () => (e.shiftKey ? s.setCursor(Math.min(s.to_s, at + step)) : s.pan(0.1)),
      '+': () => s.zoom(0.5, at), '=': () => s.zoom(0.5, at), '-': () => s.zoom(2, at), Home: () => s.whole(),
    };
    const action = actions[e.key];
    if (!action) return;
    e.preventDefault();
    action();
  }
}
