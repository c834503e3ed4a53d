// The run as kadr wrote it into the page (emulator/report/page/report_page.cpp).

export interface TrackMeta { name: string; unit: string; low: number; step: number }
export interface AxisMeta { name: string; unit: string; step_u: number }
export interface EventMeta { t_s: number; line: number; kind: string; text: string }
export interface Meta {
  kadr: string; title: string; program: string; path_unit: string;
  control_tick_s: number; first_control_tick: number; control_ticks: number; every: number; pieces: number;
  tracks: TrackMeta[]; axes: AxisMeta[]; limited_by: string[]; events: EventMeta[]; events_left_out: number;
}
export interface Blocks {
  t_s: number[]; line: number[]; length_u: number[]; planned_s: number[]; programmed_u_s: number[]; peak_u_s: number[];
  limited_by: number[]; words: string[]; text: string[]; left_out: number;
}
/** One signal: lowest and highest value of every piece; the same array while a piece is one control tick. */
export interface Track { name: string; unit: string; step: number; low: Float32Array; high: Float32Array }

export interface Run {
  meta: Meta; tracks: Map<string, Track>; nodes: Int32Array[]; blocks: Blocks; program: string[]; settings: string;
  pieces: number; piece_s: number; first_s: number; end_s: number;
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

async function unpackedText(id: string): Promise<string> {
  return new TextDecoder().decode(await unpacked(id));
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

export async function readRun(): Promise<Run> {
  const meta = JSON.parse(element('meta').textContent ?? '') as Meta;
  const tracks = new Map<string, Track>();
  const bytes = await Promise.all(meta.tracks.map((_, k) => unpacked(`track${k}`)));
  meta.tracks.forEach((m, k) => {
    const all = reals(bytes[k], m.low, m.step);
    const low = meta.every > 1 ? all.subarray(0, meta.pieces) : all;
    tracks.set(m.name, { name: m.name, unit: m.unit, step: m.step, low, high: meta.every > 1 ? all.subarray(meta.pieces) : all });
  });
  const nodes = (await Promise.all(meta.axes.map((_, a) => unpacked(`nodes${a}`)))).map(counts);
  const piece_s = meta.control_tick_s * meta.every;
  const first_s = meta.first_control_tick * meta.control_tick_s;
  return {
    meta, tracks, nodes, piece_s, first_s, pieces: meta.pieces, end_s: first_s + meta.pieces * piece_s,
    blocks: JSON.parse(await unpackedText('data-blocks')) as Blocks,
    program: (await unpackedText('data-program')).split(/\r?\n/),
    settings: await unpackedText('data-settings'),
  };
}

/** Tracks whose names begin and end like that: "axis." and ".speed". */
export function alike(run: Run, begin: string, part: string): Track[] {
  return [...run.tracks.values()].filter((t) => t.name.startsWith(begin) && t.name.includes(part));
}
export function one(run: Run, begin: string): Track | undefined {
  return [...run.tracks.values()].find((t) => t.name.startsWith(begin));
}
/** Time at the end of a piece, and the piece that holds a time. */
export const timeOf = (run: Run, piece: number): number => run.first_s + (piece + 1) * run.piece_s;
export const pieceAt = (run: Run, t_s: number): number =>
  Math.max(0, Math.min(run.pieces - 1, Math.ceil((t_s - run.first_s) / run.piece_s - 1e-6) - 1));
/** The block under way at a time; -1: none yet. */
export function blockAt(run: Run, t_s: number): number {
  let low = 0, high = run.blocks.t_s.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (run.blocks.t_s[middle] <= t_s) low = middle + 1; else high = middle;
  }
  return low - 1;
}
