// Time series: one chart a quantity, all with one window and one cursor.
import uPlot from 'uplot';
import { css } from './colours';
import { type Run, type Track, alike, one, pieceAt, timeOf } from './data';
import { Pyramid } from './pyramid';
import type { State } from './state';
import { byStep, fixed, made, say } from './text';

const BUCKETS_A_PIXEL = 16;  // fewer make slanted strokes, which a software raster draws several times slower
const DASHES = [[], [7, 3], [2, 3], [10, 3, 2, 3], [4, 2], [1, 2]];

interface Group { title: string; unit: string; tracks: Track[]; names: string[] }

function groups(run: Run): Group[] {
  const out: Group[] = [];
  const add = (title: string, tracks: (Track | undefined)[], names: string[]): void => {
    const there = tracks.map((t, k) => ({ t, name: names[k] })).filter((x) => x.t) as { t: Track; name: string }[];
    if (there.length) out.push({ title, unit: there[0].t.unit, tracks: there.map((x) => x.t), names: there.map((x) => x.name) });
  };
  add('Feed', [one(run, 'feed.commanded'), one(run, 'feed.programmed')], ['commanded', 'programmed']);
  add('Feed override', [one(run, 'feed.override_used'), one(run, 'feed.override_requested')], ['used', 'requested']);
  add('Path error', [one(run, 'path.error')], ['path error']);
  add('Acceleration along the path', [one(run, 'feed.acceleration')], ['acceleration']);
  add('Jerk along the path', [one(run, 'feed.jerk')], ['jerk']);
  // axes of one unit share a chart
  for (const [title, part] of [['Following error', '.following'], ['Vibration', '.vibration'], ['Axis speed', '.speed'],
    ['Axis acceleration', '.acceleration'], ['Axis jerk', '.jerk'], ['Step rate', '.step_rate']] as const) {
    const tracks = alike(run, 'axis.', part);
    for (const unit of new Set(tracks.map((t) => t.unit))) {
      const same = tracks.filter((t) => t.unit === unit);
      add(title, same, same.map((t) => t.name.split('.')[1]));
    }
  }
  return out;
}

function tick(value: number, step: number): string {
  return fixed(value, Math.max(0, Math.min(9, Math.ceil(-Math.log10(step) - 1e-9))));
}

export class Charts {
  private readonly pyramids = new Map<string, Pyramid>();
  private readonly groups: Group[];
  private plots: uPlot[] = [];
  private values: HTMLElement[][] = [];

  constructor(private readonly run: Run, private readonly state: State, private readonly host: HTMLElement) {
    this.groups = groups(run);
    for (const g of this.groups) for (const t of g.tracks) this.pyramids.set(t.name, new Pyramid(t));
    this.make();
    state.add({ window: () => this.draw(), cursor: (t) => this.showCursor(t) });
    host.addEventListener('wheel', (e) => this.wheel(e), { passive: false });
    host.addEventListener('keydown', (e) => this.key(e));
    new ResizeObserver(() => this.resize()).observe(host);
  }

  /** Builds everything anew: language or theme changed. */
  make(): void {
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
    this.values = [];
    this.host.replaceChildren();
    this.groups.forEach((g, k) => this.add(g, k === this.groups.length - 1));
    this.draw();
  }

  private add(group: Group, last: boolean): void {
    const box = made('div', '', 'chart'), title = made('h3', `${say(group.title)}, ${group.unit}`);
    const values: HTMLElement[] = [];
    const colours = group.tracks.map((_, k) => css(`--c${k % 6}`));
    group.names.forEach((name, k) => {
      const entry = made('span'), value = made('span', '', 'v');
      const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
      const line = document.createElementNS('http://www.w3.org/2000/svg', 'path');
      for (const [key, text] of Object.entries({ d: 'M0 4H22', stroke: colours[k], 'stroke-width': '2', 'stroke-dasharray': DASHES[k % 6].join(' ') })) line.setAttribute(key, text);
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
      width: this.width(), height: last ? 150 : 122,
      cursor: { y: false, drag: { x: true, y: false, setScale: false }, points: { show: false } },
      legend: { show: false },
      scales: { x: { time: false, range: () => [this.state.from_s, this.state.to_s] }, y: { range: (_, lo, hi) => this.scale(lo, hi, Math.max(...group.tracks.map((t) => t.step))) } },
      axes: [{ ...axis, size: last ? 46 : 28, label: last ? `${say('time')}, s` : undefined, labelSize: 16, values: values_ }, { ...axis, size: 62, space: 18, values: values_ }],
      series: [{}, ...group.tracks.map((_, k) => ({ stroke: colours[k], width: 1.2, dash: DASHES[k % 6], points: { show: false }, spanGaps: false }))],
      hooks: {
        setSelect: [(u) => this.select(u)],
        draw: [(u) => this.marks(u)],
      },
    }, [[], ...group.tracks.map(() => [])] as unknown as uPlot.AlignedData, box));
    // of the mouse alone: uPlot's own hook also speaks when a window moves below a cursor at rest
    const plot = this.plots[this.plots.length - 1];
    plot.over.addEventListener('mousemove', (e) => this.state.setCursor(plot.posToVal(e.clientX - plot.over.getBoundingClientRect().left, 'x')));
  }

  /** Room round the values, from 0 if they come near it; what is finer than the data's own steps is not magnified. */
  private scale(lo: number, hi: number, step: number): [number, number] {
    if (!Number.isFinite(lo) || !Number.isFinite(hi)) return [0, 1];
    const least = Math.max(40 * step, 1e-3 * Math.abs(hi)) || 1, middle = (lo + hi) / 2;
    if (hi - lo < least) [lo, hi] = [middle - least / 2, middle + least / 2];
    const room = 0.06 * (hi - lo);
    return [lo >= 0 && lo < 0.3 * hi ? 0 : lo - room, hi + room];
  }

  private width(): number { return Math.max(300, this.host.clientWidth); }
  private resize(): void {
    if (this.plots.length && this.plots[0].width !== this.width()) {
      for (const plot of this.plots) plot.setSize({ width: this.width(), height: plot.height });
      this.draw();
    }
  }

  private range(): [number, number] {
    return [pieceAt(this.run, this.state.from_s), Math.min(this.run.pieces, pieceAt(this.run, this.state.to_s) + 2)];
  }

  draw(): void {
    const [from, to] = this.range(), buckets = BUCKETS_A_PIXEL * this.width() / 2;
    this.groups.forEach((group, k) => {
      const size = this.pyramids.get(group.tracks[0].name)!.size(from, to, buckets);
      const pairs = size > 1 || this.run.meta.every > 1;
      const ys = group.tracks.map((t) => this.pyramids.get(t.name)!.read(from, to, size, pairs));
      const xs = new Float64Array(ys[0].length), first = Math.floor(from / size);
      for (let i = 0; i < xs.length; i++)
        xs[i] = pairs ? timeOf(this.run, (first + (i >> 1)) * size + ((i & 1) ? size - 1 : (size - 1) / 2)) : timeOf(this.run, first + i);
      // uPlot takes null for a gap; NaN would spoil the scale
      const clean = ys.map((y) => (y.some(Number.isNaN) ? Array.from(y, (v) => (Number.isNaN(v) ? null : v)) : y));
      this.plots[k].setData([xs, ...clean] as unknown as uPlot.AlignedData);
    });
  }

  /** Extremes of every signal in the window. */
  extremes(): { name: string; unit: string; step: number; low: number; high: number }[] {
    const [from, to] = this.range();
    return this.groups.flatMap((g) => g.tracks.map((t) => {
      const [low, high] = this.pyramids.get(t.name)!.extremes(from, Math.min(to, this.run.pieces));
      return { name: t.name, unit: t.unit, step: t.step, low, high };
    }));
  }

  private select(u: uPlot): void {
    const { left, width } = u.select;
    if (width > 3) this.state.setWindow(u.posToVal(left, 'x'), u.posToVal(left + width, 'x'));
    u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
  }

  private showCursor(t_s: number): void {
    const piece = pieceAt(this.run, t_s), there = !Number.isNaN(t_s);
    this.plots.forEach((plot, k) => {
      plot.setCursor({ left: there ? plot.valToPos(t_s, 'x') : -10, top: 10 }, false);
      this.groups[k].tracks.forEach((t, i) => {
        const text = !there ? '' : t.low[piece] === t.high[piece] || Number.isNaN(t.low[piece]) ? byStep(t.high[piece], t.step)
          : `${byStep(t.low[piece], t.step)} .. ${byStep(t.high[piece], t.step)}`;
        this.values[k][i].textContent = text;
      });
    });
  }

  /** Events: full height when there are few in the window, alarms always. */
  private marks(u: uPlot): void {
    const { ctx, bbox } = u;
    const there = this.run.meta.events.filter((e) => e.t_s >= this.state.from_s && e.t_s <= this.state.to_s);
    const few = there.length <= 25;
    ctx.save();
    ctx.setLineDash([3, 3]);
    for (const e of there.slice(0, 1000)) {
      const x = u.valToPos(e.t_s, 'x', true), alarm = e.kind === 'alarm';
      ctx.strokeStyle = css(alarm ? '--bad' : '--soft');
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + (few || alarm ? bbox.height : 8));
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
