// A run as kadr wrote it into the page (emulator/log_tools/report/run_data.cpp).
import { Pyramid } from './pyramid';

export interface TrackMeta { name: string; unit: string; low: number; step: number }
export interface AxisMeta { name: string; unit: string; step_u: number }
export interface EventMeta { t_s: number; line: number; kind: string; text: string }
/** Control ticks [first, first + ticks) that the page holds one by one, though the rest is in pieces of several; `at`: where in `fine`. */
export interface WindowMeta { first: number; ticks: number; at: number }
export interface Meta {
  kadr: string; title: string; program: string; path_unit: string;
  control_tick_s: number; first_control_tick: number; control_ticks: number; every: number; pieces: number;
  tracks: TrackMeta[]; axes: AxisMeta[]; limited_by: string[]; events: EventMeta[]; events_left_out: number; windows: WindowMeta[]; has_path: boolean;
}
export interface Blocks {
  t_s: number[]; line: number[]; length_u: number[]; planned_s: number[]; programmed_u_s: number[]; peak_u_s: number[];
  limited_by: number[]; words: string[]; text: string[]; left_out: number;
}

/** Part of the page that is unpacked when somebody first needs it. */
export class Later<T> {
  value: T | undefined;
  private promise?: Promise<T>;
  constructor(private readonly make: () => Promise<T>) {}
  load(): Promise<T> { return (this.promise ??= this.make().then((value) => (this.value = value))); }
}

const NONE = new Float32Array();

/** One signal: lowest and highest value of every piece, the same array while a piece is one control tick; no values before it is loaded. */
export class Track {
  readonly name: string;
  readonly unit: string;
  readonly step: number;
  private readonly data: Later<{ low: Float32Array; high: Float32Array; fine: Float32Array }>;
  private pyramid_?: Pyramid;
  lowest = NaN;
  highest = NaN;

  constructor(meta: TrackMeta, pieces: number, id: string, fineId: string) {
    this.name = meta.name;
    this.unit = meta.unit;
    this.step = meta.step;
    this.data = new Later(async () => {
      const all = reals(await unpacked(id), meta.low, meta.step), fine = fineId ? reals(await unpacked(fineId), meta.low, meta.step) : NONE;
      return all.length > pieces ? { low: all.subarray(0, pieces), high: all.subarray(pieces), fine } : { low: all, high: all, fine };
    });
  }
  load(): Promise<unknown> { return this.data.load(); }
  get loaded(): boolean { return this.data.value !== undefined; }
  get low(): Float32Array { return this.data.value?.low ?? NONE; }
  get high(): Float32Array { return this.data.value?.high ?? NONE; }
  /** Of the windows, one behind the other. */
  get fine(): Float32Array { return this.data.value?.fine ?? NONE; }
  get pyramid(): Pyramid { return (this.pyramid_ ??= new Pyramid(this.low, this.high)); }

  /** Sets lowest and highest to the extremes of control ticks [first, end); lowest > highest: no values. Where the page has pieces of
   * several, those of whole pieces. */
  ask(run: Run, first: number, end: number): void {
    const { every } = run.meta, w = run.windowAt(first);
    this.lowest = Infinity;
    this.highest = -Infinity;
    if (!this.loaded) return;
    if (w && end <= w.first + w.ticks) {
      const { fine } = this;
      for (let i = w.at + first - w.first, stop = i + end - first; i < stop; i++) {
        if (fine[i] < this.lowest) this.lowest = fine[i];
        if (fine[i] > this.highest) this.highest = fine[i];
      }
      return;
    }
    const { pyramid } = this;
    pyramid.ask(Math.floor(first / every), Math.min(run.pieces, Math.ceil(end / every)));
    this.lowest = pyramid.low;
    this.highest = pyramid.high;
  }
}

/** Lattice nodes of each axis: after each piece, and after each control tick of the windows. */
export interface Nodes { pieces: Int32Array[]; fine: Int32Array[] }

/** Corners of the commanded path: exact positions after some of the control ticks; between them it is straight within micrometres. */
export interface Corners { ticks: Int32Array; nodes: Int32Array[] }

export class Run {
  readonly pieces: number;
  readonly ticks: number;  // control ticks that the pieces cover
  readonly piece_s: number;
  readonly first_s: number;
  readonly end_s: number;
  private path?: Float64Array;

  constructor(readonly meta: Meta, readonly tracks: Map<string, Track>, readonly positions: Later<Nodes>, readonly corners: Corners,
    private readonly path_milli: Int32Array, readonly blocks: Blocks, readonly program: string[], readonly settings: string) {
    this.pieces = meta.pieces;
    this.ticks = meta.pieces * meta.every;
    this.piece_s = meta.control_tick_s * meta.every;
    this.first_s = meta.first_control_tick * meta.control_tick_s;
    this.end_s = this.first_s + meta.pieces * this.piece_s;
  }
  /** Length of path at each piece's end. */
  get path_u(): Float64Array { return (this.path ??= Float64Array.from(this.path_milli, (v) => v / 1000)); }

  windowAt(tick: number): WindowMeta | undefined {
    if (this.meta.windows.length === 0) return undefined;
    const w = this.windowBefore(tick);
    return w && tick < w.first + w.ticks ? w : undefined;
  }
  /** Where the next window begins. */
  windowAfter(tick: number): number {
    const { windows } = this.meta, w = this.windowBefore(tick);
    return windows[w ? windows.indexOf(w) + 1 : 0]?.first ?? Infinity;
  }
  private windowBefore(tick: number): WindowMeta | undefined {
    const { windows } = this.meta;
    let low = 0, high = windows.length;
    while (low < high) { const middle = (low + high) >> 1; if (windows[middle].first <= tick) low = middle + 1; else high = middle; }
    return windows[low - 1];
  }
  /** Lattice node after a control tick; the piece's last one where it is not in a window. Once positions are loaded. */
  node(axis: number, tick: number): number {
    const w = this.windowAt(tick), at = this.positions.value;
    if (!at) return 0;
    return w ? at.fine[axis][w.at + tick - w.first] : at.pieces[axis][Math.floor(tick / this.meta.every)];
  }
}

const NO_VALUE = 65535;

function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no ${id}`);
  return found;
}

function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  const own = (Uint8Array as unknown as { fromBase64?: (t: string) => Uint8Array<ArrayBuffer> }).fromBase64;
  if (own) return own(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function unpacked(id: string): Promise<Uint8Array<ArrayBuffer>> {
  const at = element(id);
  const bytes = fromBase64(at.textContent ?? '');
  at.remove();
  const unpacker = new DecompressionStream('deflate-raw');
  const writer = unpacker.writable.getWriter();
  void writer.write(bytes);
  void writer.close();
  const parts: Uint8Array[] = [];
  let size = 0;
  for (const reader = unpacker.readable.getReader(); ;) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    size += value.length;
  }
  const out = new Uint8Array(size);
  let end = 0;
  for (const part of parts) {
    out.set(part, end);
    end += part.length;
  }
  return out;
}

/** Planes of low and high bytes of differences modulo 2^16. */
function reals(bytes: Uint8Array, low: number, step: number): Float32Array {
  const n = bytes.length / 2;
  const out = new Float32Array(n);
  for (let i = 0, q = 0; i < n; i++) {
    q = (q + bytes[i] + (bytes[n + i] << 8)) & 65535;
    out[i] = q === NO_VALUE ? NaN : low + step * q;
  }
  return out;
}

/** Four planes of bytes of differences modulo 2^32. */
function counts(bytes: Uint8Array): Int32Array {
  const n = bytes.length / 4;
  const out = new Int32Array(n);
  for (let i = 0, value = 0; i < n; i++) {
    value = (value + (bytes[i] | (bytes[n + i] << 8) | (bytes[2 * n + i] << 16) | (bytes[3 * n + i] << 24))) | 0;
    out[i] = value;
  }
  return out;
}

/** @param prefix  of the ids of the run's elements: pages of several runs have several */
export async function readRun(prefix = ''): Promise<Run> {
  const meta = JSON.parse(element(`${prefix}meta`).textContent ?? '') as Meta;
  const fine = meta.windows.length > 0, axes = meta.axes.length;
  const all = async (name: string, n: number): Promise<Int32Array[]> =>
    (await Promise.all(Array.from({ length: n }, (_, k) => unpacked(`${prefix}${name}${k}`)))).map(counts);
  const text = async (name: string): Promise<string> => new TextDecoder().decode(await unpacked(`${prefix}data-${name}`));
  const tracks = new Map(meta.tracks.map((m, k) => [m.name, new Track(m, meta.pieces, `${prefix}track${k}`, fine ? `${prefix}fine${k}` : '')]));
  const positions = new Later(async () => ({ pieces: await all('nodes', axes), fine: await all('fine-nodes', fine ? axes : 0) }));
  const [[ticks, ...at], path, blocks, program, settings] = await Promise.all([
    all('corner', axes + 1), meta.has_path ? unpacked(`${prefix}path`).then(counts) : new Int32Array(), text('blocks'), text('program'), text('settings')]);
  return new Run(meta, tracks, positions, { ticks, nodes: at }, path, JSON.parse(blocks) as Blocks, program.split(/\r?\n/), settings);
}

/** Tracks whose names begin and end like that: "axis." and ".speed". */
export function alike(run: Run, begin: string, part: string): Track[] {
  return [...run.tracks.values()].filter((t) => t.name.startsWith(begin) && t.name.includes(part));
}
export function one(run: Run, begin: string): Track | undefined {
  return [...run.tracks.values()].find((t) => t.name.startsWith(begin));
}
/** The control tick that holds a time. */
export const tickAt = (run: Run, t_s: number): number =>
  Math.max(0, Math.min(run.ticks - 1, Math.ceil((t_s - run.first_s) / run.meta.control_tick_s - 1e-6) - 1));
/** The block under way at a time; -1: none yet. */
export function blockAt(run: Run, t_s: number): number {
  let low = 0, high = run.blocks.t_s.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (run.blocks.t_s[middle] <= t_s) low = middle + 1; else high = middle;
  }
  return low - 1;
}
