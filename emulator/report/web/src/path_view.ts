// The tool path in 3-D: WebGL through twgl, and a plain 2-D drawing where there is no WebGL. Colours are by a signal over
// the window of time; the rest of the path is faint.
import * as twgl from 'twgl.js';
import { css, ramp, rgb } from './colours';
import { type Run, type Track, one, alike, pieceAt } from './data';
import type { State } from './state';
import { fixed, made, say } from './text';

const MOST_VERTICES = 500_000, MOST_2D = 20_000, DOT_PX = 9;

const VERTEX = `
attribute vec3 position; attribute float share; uniform mat4 view; uniform vec2 squeeze; uniform float dot; varying float v_share;
void main() { gl_Position = view * vec4(position, 1.0); gl_Position.xy *= squeeze; gl_PointSize = dot; v_share = share; }`;
const FRAGMENT = `
precision mediump float; uniform sampler2D ramp; uniform vec4 flat_colour; varying float v_share;
void main() { gl_FragColor = flat_colour.a > 0.0 ? flat_colour : vec4(texture2D(ramp, vec2(v_share, 0.5)).rgb, 1.0); }`;

interface Colouring { name: string; unit: string; value(piece: number): number }

const largest = (t: Track, i: number): number => Math.max(Math.abs(t.low[i]), Math.abs(t.high[i]));

export class PathView {
  private readonly positions: Float32Array;
  private readonly shares: Float32Array;
  private readonly every: number;  // pieces from one vertex to the next
  private readonly colourings: Colouring[] = [];
  private yaw = -0.6;
  private pitch = 0.95;
  private scale = 1;
  private shift: [number, number] = [0, 0];
  private centre: [number, number, number] = [0, 0, 0];
  private half: [number, number, number] = [0, 0, 0];  // of the path's box
  private gl: WebGLRenderingContext | null = null;
  private flat: CanvasRenderingContext2D | null = null;
  private program?: twgl.ProgramInfo;
  private buffers?: twgl.BufferInfo;
  private texture?: WebGLTexture;
  private frame = 0;

  constructor(private readonly run: Run, private readonly state: State, private readonly canvas: HTMLCanvasElement,
    private readonly select: HTMLSelectElement) {
    this.every = Math.max(1, Math.ceil(run.pieces / MOST_VERTICES));
    this.positions = this.place();
    this.shares = new Float32Array(this.positions.length / 3);
    this.colour();
    this.start();
    this.paint();
    state.add({ window: () => this.paint(), cursor: () => this.ask() });
    select.onchange = () => this.paint();
    this.gestures();
    new ResizeObserver(() => this.ask()).observe(canvas);
    matchMedia('print').addEventListener('change', () => this.draw());
  }

  get kind(): string { return this.gl ? 'webgl' : '2d'; }
  get vertices(): number { return this.shares.length; }

  /** Exact positions: lattice node times step, of the first three linear axes. */
  private place(): Float32Array {
    const { run } = this, n = Math.ceil(run.pieces / this.every);
    const axes = run.meta.axes.map((a, k) => ({ ...a, k })).filter((a) => a.unit === 'mm').slice(0, 3);
    const out = new Float32Array(3 * n);
    axes.forEach((axis, d) => {
      let low = Infinity, high = -Infinity;
      for (let i = 0; i < n; i++) {
        const value = run.nodes[axis.k][Math.min(run.pieces - 1, i * this.every)] * axis.step_u;
        out[3 * i + d] = value;
        if (value < low) low = value;
        if (value > high) high = value;
      }
      this.centre[d] = (low + high) / 2;
      this.half[d] = (high - low) / 2;
    });
    return out;
  }

  private colour(): void {
    const { run } = this;
    const feed = one(run, 'feed.commanded'), error = one(run, 'path.error');
    const vibration = alike(run, 'axis.', '.vibration').filter((t) => t.unit === 'um');
    if (feed) this.colourings.push({ name: 'feed', unit: feed.unit, value: (i) => feed.high[i] });
    if (error) this.colourings.push({ name: 'path error', unit: error.unit, value: (i) => error.high[i] });
    if (vibration.length) this.colourings.push({ name: 'vibration', unit: 'um', value: (i) => Math.hypot(...vibration.map((t) => largest(t, i))) });
    this.colourings.push({ name: 'time', unit: 's', value: (i) => run.first_s + (i + 1) * run.piece_s });
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
    this.program = twgl.createProgramInfo(this.gl, [VERTEX, FRAGMENT]);
    this.buffers = twgl.createBufferInfoFromArrays(this.gl, {
      position: { numComponents: 3, data: this.positions }, share: { numComponents: 1, data: this.shares, drawType: this.gl.DYNAMIC_DRAW },
    });
  }

  /** Colours anew, by the range of the window: with that of the whole run one peak would make all the rest one colour. */
  paint(): void {
    const c = this.colourings[Number(this.select.value)], { shares } = this;
    const [from, to] = this.window(), values: number[] = [], pick = Math.max(1, Math.floor((to - from) / 20000));
    for (let i = 0; i < shares.length; i++) {
      shares[i] = c.value(Math.min(this.run.pieces - 1, i * this.every));
      if (i >= from && i < to && (i - from) % pick === 0 && Number.isFinite(shares[i])) values.push(shares[i]);
    }
    values.sort((a, b) => a - b);
    const low = values[0] ?? 0, high = values[Math.floor(0.995 * (values.length - 1))] ?? 1;
    for (let i = 0; i < shares.length; i++) shares[i] = (shares[i] - low) / (high - low || 1);
    const decimals = c.unit === 's' ? 3 : 1;
    document.getElementById('scale-low')!.textContent = fixed(low, decimals);
    document.getElementById('scale-high')!.textContent = `${values[values.length - 1] > high ? '≥ ' : ''}${fixed(high, decimals)} ${c.unit}`;
    const strip = document.getElementById('ramp') as HTMLCanvasElement, pen = strip.getContext('2d')!;
    const texels = new Uint8Array(256 * 4);
    for (let k = 0; k < 256; k++) texels.set([...ramp(k / 255).map((v) => Math.round(255 * v)), 255], 4 * k);
    for (let x = 0; x < strip.width; x++) {
      const k = Math.round(x / (strip.width - 1) * 255) * 4;
      pen.fillStyle = `rgb(${texels[k]},${texels[k + 1]},${texels[k + 2]})`;
      pen.fillRect(x, 0, 1, strip.height);
    }
    if (this.gl && this.buffers) {
      if (this.texture) this.gl.deleteTexture(this.texture);
      this.texture = twgl.createTexture(this.gl, { src: texels, width: 256, height: 1, minMag: this.gl.LINEAR, wrap: this.gl.CLAMP_TO_EDGE, auto: false });
      twgl.setAttribInfoBufferFromArray(this.gl, this.buffers.attribs!.share, shares);
    }
    this.ask();
  }

  /** Vertices of the window of time. */
  private window(): [number, number] {
    const from = Math.floor(pieceAt(this.run, this.state.from_s) / this.every);
    return [from, Math.min(this.shares.length, Math.max(from + 2, Math.ceil((pieceAt(this.run, this.state.to_s) + 1) / this.every)))];
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

  private ask(): void {
    if (this.frame) return;
    this.frame = requestAnimationFrame(() => { this.frame = 0; this.draw(); });
  }

  draw(): void {
    const ratio = Math.min(2, devicePixelRatio || 1), { canvas } = this;
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const squeeze = this.squeeze();
    if (this.gl) this.drawGl(squeeze, ratio); else if (this.flat) this.draw2d(squeeze);
  }

  private mark(): number {
    const t = this.state.cursor_s;
    return Number.isNaN(t) ? -1 : Math.min(this.shares.length - 1, Math.round(pieceAt(this.run, t) / this.every));
  }

  private drawGl(squeeze: number[], ratio: number): void {
    const gl = this.gl!, [from, to] = this.window(), faint = [...rgb(css('--rule')), 1];
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    const [r, g, b] = rgb(css('--ground'));
    gl.clearColor(r, g, b, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.program!.program);
    twgl.setBuffersAndAttributes(gl, this.program!, this.buffers!);
    const uniforms = { view: this.matrix(), squeeze, ramp: this.texture, dot: DOT_PX * ratio };
    const strip = (first: number, end: number, flat_colour: number[], mode: number): void => {
      twgl.setUniforms(this.program!, { ...uniforms, flat_colour });
      gl.drawArrays(mode, first, end - first);
    };
    if (from > 0 || to < this.shares.length) strip(0, this.shares.length, faint, gl.LINE_STRIP);
    strip(from, to, [0, 0, 0, 0], gl.LINE_STRIP);
    const mark = this.mark();
    if (mark >= 0) strip(mark, mark + 1, [...rgb(css('--mark')), 1], gl.POINTS);
  }

  private draw2d(squeeze: number[]): void {
    const pen = this.flat!, m = this.matrix(), { width, height } = this.canvas, [from, to] = this.window();
    const at = (i: number): [number, number] => {
      const [x, y, z] = this.positions.subarray(3 * i, 3 * i + 3);
      return [(1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) * squeeze[0]) * width / 2, (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) * squeeze[1]) * height / 2];
    };
    pen.fillStyle = css('--ground');
    pen.fillRect(0, 0, width, height);
    const line = (first: number, end: number, colour?: string): void => {
      const step = Math.max(1, Math.ceil((end - first) / MOST_2D));
      for (let i = first; i + 1 < end; i += step) {
        pen.strokeStyle = colour ?? `rgb(${ramp(this.shares[i]).map((v) => Math.round(255 * v)).join(',')})`;
        pen.beginPath();
        pen.moveTo(...at(i));
        pen.lineTo(...at(Math.min(end - 1, i + step)));
        pen.stroke();
      }
    };
    line(0, this.shares.length, css('--rule'));
    line(from, to);
    const mark = this.mark();
    if (mark < 0) return;
    pen.fillStyle = css('--mark');
    pen.beginPath();
    pen.arc(...at(mark), DOT_PX / 2, 0, 7);
    pen.fill();
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
    const box = this.canvas.getBoundingClientRect(), m = this.matrix();
    const squeeze = this.squeeze();
    const x = (2 * (e.clientX - box.left) / box.width - 1) / squeeze[0], y = (1 - 2 * (e.clientY - box.top) / box.height) / squeeze[1];
    let best = Infinity, at = 0;
    for (let i = 0; i < this.shares.length; i++) {
      const [px, py, pz] = [this.positions[3 * i], this.positions[3 * i + 1], this.positions[3 * i + 2]];
      const dx = m[0] * px + m[4] * py + m[8] * pz + m[12] - x, dy = m[1] * px + m[5] * py + m[9] * pz + m[13] - y;
      if (dx * dx + dy * dy < best) { best = dx * dx + dy * dy; at = i; }
    }
    const t_s = this.run.first_s + (at * this.every + 1) * this.run.piece_s;
    if (t_s < this.state.from_s || t_s > this.state.to_s) this.state.jump(t_s, this.state.to_s - this.state.from_s);
    else this.state.setCursor(t_s);
  }
}
