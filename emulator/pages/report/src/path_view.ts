// The tool path in 3-D: WebGL through twgl, and a plain 2-D drawing where there is no WebGL. Colours are by a signal over
// the window of time; the rest of the path is faint.
import { type BufferInfo, type ProgramInfo, createBufferInfoFromArrays, createProgramInfo, setAttribInfoBufferFromArray, setBuffersAndAttributes,
  setUniforms } from 'twgl.js';
import { css, ramp, rgb } from './colours';
import { type Run, type Track, alike, one, tickAt } from './data';
import type { State } from './state';
import { fixed, made, say } from './text';

const MOST_DETAIL = 60_000, MOST_STROKES = 150_000, MOST_2D = 20_000, RAMP = 16;

const VERTEX = `
attribute vec3 position; attribute float value; uniform mat4 view; uniform vec2 squeeze; uniform vec2 shift; uniform vec2 range; uniform vec3 ramp[${RAMP}]; varying vec3 colour;
void main() {
  gl_Position = view * vec4(position, 1.0);
  gl_Position.xy = gl_Position.xy * squeeze + shift;
  float share = clamp((value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0) * ${RAMP - 1}.0;
  colour = ramp[0];
  for (int k = 1; k < ${RAMP}; ++k) colour = mix(colour, ramp[k], clamp(share - float(k - 1), 0.0, 1.0));
}`;
const FRAGMENT = `
precision mediump float; uniform vec4 flat_colour; varying vec3 colour;
void main() { gl_FragColor = flat_colour.a > 0.0 ? flat_colour : vec4(colour, 1.0); }`;

/** The largest value over control ticks [first, end). */
interface Colouring { name: string; unit: string; tracks: Track[]; value(first: number, end: number): number }

/** Part of the path: positions, and behind each the value of the stretch that leads to it. */
interface Strip { positions: Float32Array; values: Float32Array; ticks: Int32Array }

export class PathView {
  private readonly corners: Strip;
  private detail: Strip | null = null;  // every control tick of the window, where the page has them and they are not too many
  private readonly colourings: Colouring[] = [];
  private readonly axes: { k: number; step_u: number }[];
  private yaw = -0.6;
  private pitch = 0.95;
  private scale = 1;
  private shift: [number, number] = [0, 0];
  private centre: [number, number, number] = [0, 0, 0];
  private half: [number, number, number] = [0, 0, 0];  // of the path's box
  private range: [number, number] = [0, 1];            // of the colours
  private gl: WebGLRenderingContext | null = null;
  private flat: CanvasRenderingContext2D | null = null;
  private program?: ProgramInfo;
  private buffers?: { corners: BufferInfo; detail: BufferInfo };
  private frame = 0;
  private seen = true;
  private stale = false;
  readonly ready: Promise<void>;

  constructor(private readonly run: Run, private readonly state: State, private readonly canvas: HTMLCanvasElement, private readonly dot: HTMLElement,
    private readonly select: HTMLSelectElement) {
    this.axes = run.meta.axes.map((a, k) => ({ ...a, k })).filter((a) => a.unit === 'mm').slice(0, 3);
    const { ticks } = run.corners;
    this.corners = { positions: this.place(ticks.length, (axis, i) => run.corners.nodes[axis][i]), values: new Float32Array(ticks.length), ticks };
    this.box();
    this.colour();
    this.start();
    this.ready = this.recolour();
    void this.ready.then(() => run.positions.load()).then(() => { this.paint(); });
    state.add({ window: () => this.paint(), cursor: () => this.mark() });
    select.onchange = () => void this.recolour();
    this.gestures();
    new ResizeObserver(() => this.ask()).observe(canvas);
    new IntersectionObserver((all) => { this.seen = all[all.length - 1].isIntersecting; if (this.seen && this.stale) this.ask(); }).observe(canvas);
    matchMedia('print').addEventListener('change', () => this.draw());
  }

  get kind(): string { return this.gl ? 'webgl' : '2d'; }
  get vertices(): number { return this.corners.ticks.length; }

  /** Exact positions: lattice node times step, of the first three linear axes. */
  private place(n: number, node: (axis: number, i: number) => number): Float32Array {
    const out = new Float32Array(3 * n);
    this.axes.forEach(({ k, step_u }, d) => { for (let i = 0; i < n; i++) out[3 * i + d] = node(k, i) * step_u; });
    return out;
  }

  private box(): void {
    const { positions } = this.corners;
    for (let d = 0; d < 3; d++) {
      let low = Infinity, high = -Infinity;
      for (let i = d; i < positions.length; i += 3) { low = Math.min(low, positions[i]); high = Math.max(high, positions[i]); }
      this.centre[d] = (low + high) / 2;
      this.half[d] = (high - low) / 2;
    }
  }

  private colour(): void {
    const { run } = this;
    const largest = (t: Track, first: number, end: number): number => { t.ask(run, first, end); return t.lowest <= t.highest ? Math.max(-t.lowest, t.highest) : NaN; };
    const feed = one(run, 'feed.commanded'), error = one(run, 'path.error');
    const vibration = alike(run, 'axis.', '.vibration').filter((t) => t.unit === 'um');
    if (feed) this.colourings.push({ name: 'feed', unit: feed.unit, tracks: [feed], value: (a, b) => largest(feed, a, b) });
    if (error) this.colourings.push({ name: 'path error', unit: error.unit, tracks: [error], value: (a, b) => largest(error, a, b) });
    if (vibration.length) this.colourings.push({ name: 'vibration', unit: 'um', tracks: vibration, value: (a, b) => Math.sqrt(vibration.reduce((sum, t) => sum + largest(t, a, b) ** 2, 0)) });
    this.colourings.push({ name: 'time', unit: 's', tracks: [], value: (_, b) => run.first_s + b * run.meta.control_tick_s });
    this.words();
  }

  /** Names of the choice, in the page's language. */
  words(): void {
    const at = this.select.value || '0';
    this.select.replaceChildren(...this.colourings.map((c, k) => { const o = made('option', say(c.name)); o.value = String(k); return o; }));
    this.select.value = at;
  }

  private start(): void {
    this.gl = location.hash.includes('no-webgl') ? null : this.canvas.getContext('webgl', { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) {
      this.flat = this.canvas.getContext('2d');
      return;
    }
    const gl = this.gl, buffer = ({ positions, values }: Strip): BufferInfo => createBufferInfoFromArrays(gl, {
      position: { numComponents: 3, data: positions }, value: { numComponents: 1, data: values, drawType: gl.DYNAMIC_DRAW } });
    this.program = createProgramInfo(gl, [VERTEX, FRAGMENT]);
    this.buffers = { corners: buffer(this.corners), detail: buffer({ positions: new Float32Array(3), values: new Float32Array(1), ticks: new Int32Array(1) }) };
  }

  private upload(to: BufferInfo, { positions, values }: Strip, all: boolean): void {
    if (all) setAttribInfoBufferFromArray(this.gl!, to.attribs!.position, positions);
    setAttribInfoBufferFromArray(this.gl!, to.attribs!.value, values.map((v) => (Number.isFinite(v) ? v : -1e30)));  // no value: the ramp's low end
  }

  /** Another signal, or other colours. */
  private async recolour(): Promise<void> {
    const c = this.colourings[Number(this.select.value)], { values, ticks } = this.corners;
    await Promise.all(c.tracks.map((t) => t.load()));
    if (c !== this.colourings[Number(this.select.value)]) return;
    for (let i = 0; i < ticks.length; i++) values[i] = c.value(i > 0 ? ticks[i - 1] + 1 : 0, ticks[i] + 1);
    if (this.buffers) this.upload(this.buffers.corners, this.corners, false);
    this.paint();
  }

  /** Every control tick of the window; null: too many, or the page does not hold them. */
  private single(): Strip | null {
    if (!this.run.positions.value) return null;
    const { run, state } = this, first = Math.max(0, tickAt(run, state.from_s) - 1), n = tickAt(run, state.to_s) + 1 - first;
    const w = run.windowAt(first);
    if (n > MOST_DETAIL || (run.meta.every > 1 && !(w && first + n <= w.first + w.ticks))) return null;
    const c = this.colourings[Number(this.select.value)];
    return { positions: this.place(n, (axis, i) => run.node(axis, first + i)), values: Float32Array.from({ length: n }, (_, i) => c.value(first + i, first + i + 1)),
      ticks: Int32Array.from({ length: n }, (_, i) => first + i) };
  }

  /** The window in colours of its own range: with that of the whole run one peak would make all the rest one colour. */
  paint(): void {
    const c = this.colourings[Number(this.select.value)];
    this.detail = this.single();
    if (this.detail && this.buffers) this.upload(this.buffers.detail, this.detail, true);
    const [from, to] = this.window(), values = (this.detail?.values ?? this.corners.values.subarray(from, to)).filter(Number.isFinite).sort();
    const low = values[0] ?? 0, high = values[Math.floor(0.995 * (values.length - 1))] ?? 1;
    this.range = [low, high];
    const decimals = c.unit === 's' ? 3 : 1;
    document.getElementById('scale-low')!.textContent = fixed(low, decimals);
    document.getElementById('scale-high')!.textContent = `${values[values.length - 1] > high ? '≥ ' : ''}${fixed(high, decimals)} ${c.unit}`;
    const strip = document.getElementById('ramp') as HTMLCanvasElement, pen = strip.getContext('2d')!;
    for (let x = 0; x < strip.width; x++) {
      pen.fillStyle = `rgb(${ramp(x / (strip.width - 1)).map((v) => Math.round(255 * v)).join(',')})`;
      pen.fillRect(x, 0, 1, strip.height);
    }
    this.ask();
  }

  /** Corners of the window of time. */
  private window(): [number, number] {
    const { ticks } = this.corners;
    const from = Math.max(0, lower(ticks, tickAt(this.run, this.state.from_s)) - 1);
    return [from, Math.min(ticks.length, Math.max(from + 2, lower(ticks, tickAt(this.run, this.state.to_s)) + 1))];
  }

  /** How the picture is wider than high. */
  private squeeze(): [number, number] {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    return width > height ? [height / width, 1] : [1, width / height];
  }

  /** Rows of a matrix that turns about Z, then tilts, and fits the path's box into the picture. */
  private matrix(): number[] {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    const [x, y, z] = this.centre;
    const rows = [[cy, -sy, 0], [sy * cp, cy * cp, sp], [sy * sp, cy * sp, -cp]];
    const squeeze = this.squeeze(), reach = [0, 1].map((d) => rows[d].reduce((sum, r, c) => sum + Math.abs(r) * this.half[c], 0) * squeeze[d]);
    const k = 0.92 * this.scale / Math.max(1e-9, ...reach);
    // depth is not tested: it only has to stay within the picture's range
    rows[2] = rows[2].map((r) => r * 0.01);
    const move = rows.map((r, d) => -k * (r[0] * x + r[1] * y + r[2] * z) + (d < 2 ? this.shift[d] : 0));
    return [0, 1, 2].flatMap((c) => [k * rows[0][c], k * rows[1][c], k * rows[2][c], 0]).concat([move[0], move[1], move[2], 1]);
  }

  /** Draws with the next frame, or when the picture comes into sight. */
  private ask(): void {
    this.stale = true;
    if (this.frame || !this.seen) return;
    this.frame = requestAnimationFrame(() => { this.frame = 0; this.draw(); });
  }

  draw(): void {
    this.stale = false;
    const ratio = Math.min(2, devicePixelRatio || 1), { canvas } = this;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    if (this.gl) this.drawGl(); else if (this.flat) this.draw2d();
    this.mark();
  }

  private drawGl(): void {
    const gl = this.gl!, [from, to] = this.window(), { program, buffers } = this;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    const [r, g, b] = rgb(css('--ground'));
    gl.clearColor(r, g, b, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program!.program);
    setUniforms(program!, { view: this.matrix(), squeeze: this.squeeze(), range: this.range, ramp: Array.from({ length: RAMP }, (_, k) => ramp(k / (RAMP - 1))).flat() });
    const strip = (buffer: BufferInfo, first: number, end: number, flat_colour: number[]): void => {
      setBuffersAndAttributes(gl, program!, buffer);
      // lines of WebGL are one pixel wide: drawn several times, a little aside, they are two, on a dense screen three; a path of so many
      // lines is seen anyway
      const aside = this.canvas.width > 1.2 * this.canvas.clientWidth ? [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]] : [[0, 0], [1, 0], [0, 1]];
      const few = flat_colour[3] > 0 || (end - first) * aside.length > MOST_STROKES;
      for (const [x, y] of few ? [[0, 0]] : aside) {
        setUniforms(program!, { flat_colour, shift: [2 * x / this.canvas.width, 2 * y / this.canvas.height] });
        gl.drawArrays(gl.LINE_STRIP, first, end - first);
      }
    };
    const faint = [...rgb(css('--rule')), 1];
    if (from > 0) strip(buffers!.corners, 0, from + 1, faint);
    if (to < this.vertices) strip(buffers!.corners, to - 1, this.vertices, faint);
    if (this.detail) strip(buffers!.detail, 0, this.detail.ticks.length, [0, 0, 0, 0]);
    else strip(buffers!.corners, from, to, [0, 0, 0, 0]);
  }

  /** A position in pixels of the element. */
  private project(m: number[], [sx, sy]: number[], p: Float32Array, i: number): [number, number] {
    const { clientWidth: width, clientHeight: height } = this.canvas, [x, y, z] = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
    return [(1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) * sx) * width / 2, (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) * sy) * height / 2];
  }

  private draw2d(): void {
    const pen = this.flat!, m = this.matrix(), squeeze = this.squeeze(), [from, to] = this.window(), ratio = this.canvas.width / this.canvas.clientWidth;
    const [low, high] = this.range;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = css('--ground');
    pen.fillRect(0, 0, this.canvas.clientWidth, this.canvas.clientHeight);
    pen.lineWidth = 2;
    const line = ({ positions, values }: Strip, first: number, end: number, faint = ''): void => {
      const step = Math.max(1, Math.ceil((end - first) / MOST_2D));
      // neighbours of one colour are one stroke
      let colour = '';
      for (let i = first; i + 1 < end; i += step) {
        const j = Math.min(end - 1, i + step), share = (values[j] - low) / (high - low || 1);
        const own = faint || `rgb(${ramp(Math.round(63 * (share || 0)) / 63).map((v) => Math.round(255 * v)).join(',')})`;
        if (own !== colour) {
          if (colour) pen.stroke();
          pen.strokeStyle = colour = own;
          pen.beginPath();
          pen.moveTo(...this.project(m, squeeze, positions, i));
        }
        pen.lineTo(...this.project(m, squeeze, positions, j));
      }
      if (colour) pen.stroke();
    };
    line(this.corners, 0, Math.min(from + 1, this.vertices), css('--rule'));
    line(this.corners, to - 1, this.vertices, css('--rule'));
    if (this.detail) line(this.detail, 0, this.detail.ticks.length); else line(this.corners, from, to);
  }

  /** The cursor's point, an element of its own: the picture stays as it is. */
  private mark(): void {
    const t = this.state.cursor_s, there = !Number.isNaN(t) && this.run.positions.value !== undefined;
    this.dot.hidden = !there;
    if (!there) return;
    const tick = tickAt(this.run, t), at = this.place(1, (axis) => this.run.node(axis, tick));
    const [x, y] = this.project(this.matrix(), this.squeeze(), at, 0);
    this.dot.hidden = x < 0 || y < 0 || x > this.canvas.clientWidth || y > this.canvas.clientHeight;
    this.dot.style.transform = `translate(${x}px,${y}px)`;
  }

  view(name: string): void {
    [this.yaw, this.pitch] = name === 'top' ? [0, 0] : name === 'front' ? [0, Math.PI / 2] : [-0.6, 0.95];
    this.scale = 1;
    this.shift = [0, 0];
    this.ask();
  }

  private gestures(): void {
    const { canvas } = this;
    let last: [number, number] | null = null;
    canvas.addEventListener('pointerdown', (e) => { last = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
    canvas.addEventListener('pointerup', () => { last = null; });
    canvas.addEventListener('pointermove', (e) => {
      if (!last) return;
      const [dx, dy] = [e.clientX - last[0], e.clientY - last[1]];
      last = [e.clientX, e.clientY];
      if (e.shiftKey || e.buttons === 2) {
        const half = Math.min(canvas.clientWidth, canvas.clientHeight) / 2;
        this.shift = [this.shift[0] + dx / half, this.shift[1] - dy / half];
      } else {
        this.yaw += dx * 0.008;
        this.pitch = Math.max(0, Math.min(Math.PI, this.pitch + dy * 0.008));
      }
      this.ask();
    });
    canvas.addEventListener('dblclick', (e) => this.pick(e));
    canvas.addEventListener('wheel', (e) => { if (!e.ctrlKey && document.activeElement !== canvas) return; e.preventDefault(); this.scale *= Math.exp(-e.deltaY / 500); this.ask(); }, { passive: false });
    canvas.addEventListener('keydown', (e) => {
      const actions: Record<string, () => void> = {
        ArrowLeft: () => { this.yaw -= 0.1; }, ArrowRight: () => { this.yaw += 0.1; }, ArrowUp: () => { this.pitch -= 0.1; }, ArrowDown: () => { this.pitch += 0.1; },
        '+': () => { this.scale *= 1.25; }, '=': () => { this.scale *= 1.25; }, '-': () => { this.scale /= 1.25; }, Home: () => this.view('iso'),
      };
      const action = actions[e.key];
      if (!action) return;
      e.preventDefault();
      action();
      this.ask();
    });
  }

  /** A double click on the path takes the cursor to that point's instant. */
  private pick(e: MouseEvent): void {
    const box = this.canvas.getBoundingClientRect(), m = this.matrix(), squeeze = this.squeeze();
    const x = e.clientX - box.left, y = e.clientY - box.top, { positions, ticks } = this.corners;
    let best = Infinity, tick = 0, [ax, ay] = this.project(m, squeeze, positions, 0);
    for (let i = 1; i < ticks.length; i++) {
      const [bx, by] = this.project(m, squeeze, positions, i), [dx, dy] = [bx - ax, by - ay];
      const part = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
      const off = (ax + part * dx - x) ** 2 + (ay + part * dy - y) ** 2;
      if (off < best) { best = off; tick = ticks[i - 1] + part * (ticks[i] - ticks[i - 1]); }
      [ax, ay] = [bx, by];
    }
    const t_s = this.run.first_s + (Math.round(tick) + 1) * this.run.meta.control_tick_s;
    if (t_s < this.state.from_s || t_s > this.state.to_s) this.state.jump(t_s, this.state.to_s - this.state.from_s);
    else this.state.setCursor(t_s);
  }
}

/** Index of the first entry that is not below. */
function lower(values: Int32Array, at: number): number {
  let low = 0, high = values.length;
  while (low < high) { const middle = (low + high) >> 1; if (values[middle] < at) low = middle + 1; else high = middle; }
  return low;
}
