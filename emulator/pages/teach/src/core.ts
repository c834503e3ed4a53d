// The C++ core of kadr, compiled to WebAssembly: the one place where the page gets numbers. Answers are rows of eight-byte
// words in the order of core.cpp.
import bytes from 'core.wasm';

type Call = (...args: (number | bigint)[]) => number;
const core = {} as Record<string, Call> & { memory: WebAssembly.Memory; sweep: (first: number, count: number, hash: bigint) => bigint; sweep_begin: () => bigint };

export async function loadCore(): Promise<void> {
  const { instance } = await WebAssembly.instantiate(bytes as BufferSource, {}) as unknown as WebAssembly.WebAssemblyInstantiatedSource;
  Object.assign(core, instance.exports);
  core._initialize();
  for (let i = 0; i < core.method_count(); i++) methods.push(textAt(core.method_name(i)));
}

/** Memory may have moved since the last look at it. */
function textAt(at: number): string {
  const memory = new Uint8Array(core.memory.buffer), end = memory.indexOf(0, at);
  return new TextDecoder().decode(memory.subarray(at, end));
}
function answer(): { whole: BigInt64Array; real: Float64Array } {
  const size = core.answer_size(), at = core.answer();
  return { whole: new BigInt64Array(core.memory.buffer, at, size).slice(), real: new Float64Array(core.memory.buffer, at, size).slice() };
}

/** Names of all methods, in the order of the core. */
export const methods: string[] = [];

export interface Row {
  x: number; y: number;
  step: [number, number];
  forced: boolean;
  value: bigint; tested: bigint; testedY: bigint;
  /** Where F was tested, in steps, and its sign there. */
  places: { x: number; y: number; sign: number }[];
  deviation: number;
  t: number;
  crossing: number;
  foot: [number, number];
}

/** A case followed by a method, as `kadr teach table` shows it. */
export interface Followed {
  method: string;
  valueName: string; testedName: string; testedYName: string;
  rows: Row[];
  slots: number; pulses: number; diagonals: number; idle: number; forced: number;
  reached: boolean;
  end: [number, number];
  hash: string;
  worst: number; rms: number; worstSquare: number; length: number;
  curve: [number, number][];
}

export const FAULTS = ['none', 'kind', 'number', 'beyond', 'turn', 'count', 'polynomial', 'degree', 'half_axes', 'far_parabola', 'flat_parabola'] as const;
export type Fault = { fault: (typeof FAULTS)[number]; word: string; place: number };

/** Makes these words the case that all calls are about. */
export function readCase(words: string[]): Fault | null {
  const text = new TextEncoder().encode(words.join('\n')).subarray(0, 4095);
  new Uint8Array(core.memory.buffer, core.text(), text.length).set(text);
  const fault = core.read_case(text.length);
  return fault ? { fault: FAULTS[fault], word: textAt(core.fault_word()), place: core.fault_place() } : null;
}

export const axes = (): number => core.axes();
export const legs = (): number => core.legs();
export const knownMethods = (): string[] => methods.filter((_, i) => core.method_knows(i));

export const REFUSALS = ['none', 'no_length', 'range', 'other_curve', 'off_curve', 'one_quadrant', 'in_line', 'too_long'] as const;
export const MOST_SLOTS = 4000;
const WORDS_A_ROW = 17;

export function follow(method: string): Followed | (typeof REFUSALS)[number] {
  const refusal = core.follow(methods.indexOf(method), MOST_SLOTS);
  if (refusal) return REFUSALS[refusal < 0 ? REFUSALS.length - 1 : refusal];
  core.summary();
  const s = answer(), n = (i: number): number => Number(s.whole[i]);
  core.curve();
  const c = answer().real;
  core.rows();
  const r = answer(), rows: Row[] = [];
  for (let at = 0; at < r.whole.length; at += WORDS_A_ROW) {
    const whole = (i: number): number => Number(r.whole[at + i]);
    const places = [];
    for (const i of [8, 10]) if (r.whole[at + i] > -(1n << 63n)) places.push({ x: whole(i) / 2, y: whole(i + 1) / 2, sign: core.sign_at(whole(i), whole(i + 1)) });
    rows.push({
      x: whole(0), y: whole(1), step: [whole(2), whole(3)], forced: whole(4) !== 0, value: r.whole[at + 5], tested: r.whole[at + 6], testedY: r.whole[at + 7],
      places, deviation: r.real[at + 12], t: r.real[at + 13], crossing: r.real[at + 14], foot: [r.real[at + 15], r.real[at + 16]],
    });
  }
  return {
    method, valueName: textAt(core.column_name(0)), testedName: textAt(core.column_name(1)), testedYName: textAt(core.column_name(2)), rows,
    slots: n(0), pulses: n(1), diagonals: n(2), idle: n(3), forced: n(4), reached: n(5) !== 0, end: [n(6), n(7)],
    hash: BigInt.asUintN(64, s.whole[8]).toString(16).padStart(16, '0'),
    worst: s.real[9], rms: s.real[10], worstSquare: s.real[11], length: s.real[12],
    curve: Array.from({ length: c.length / 2 }, (_, i) => [c[2 * i], c[2 * i + 1]] as [number, number]),
  };
}

/** Signs of F at nodes, row by row; 2: the curve has no F. */
export function signs(x: number, y: number, columns: number, rows: number): number[] {
  core.signs(x, y, columns, rows);
  return [...answer().whole].map(Number);
}

/** Times between pulses of the case last followed, in us: least and most by axis. */
export interface Spacing { all: number; axes: { least: number; most: number }[] }
export function spacing(crossing: boolean, feedSteps_s: number): Spacing | null {
  if (!core.spacing(crossing ? 1 : 0, feedSteps_s)) return null;
  const us = [...answer().whole].map((ticks) => Number(ticks) / 10);
  return { all: us[0], axes: [1, 3].filter((i) => i < us.length).map((i) => ({ least: us[i], most: us[i + 1] })) };
}

/** Speed along lines in all directions, steps a slot. */
export function rose(method: string, directions: number, radius: number): { angle: number; speed: number }[] {
  core.rose(methods.indexOf(method), directions, radius);
  const r = answer().real;
  return Array.from({ length: r.length / 2 }, (_, i) => ({ angle: r[2 * i], speed: r[2 * i + 1] }));
}

export type Vector = [number, number, number];
const vector = (r: Float64Array, at: number): Vector => [r[at], r[at + 1], r[at + 2]];

/** Makes two Beziers end to end the chain that the calls below are about. */
export function setChain(curves: Vector[][]): void {
  const numbers = new Float64Array(core.memory.buffer, core.numbers(), 24);
  curves.forEach((points, c) => points.forEach((p, i) => numbers.set(p, (c * 4 + i) * 3)));
  core.chain(curves[0].length - 1, curves[1].length - 1);
}
export function comb(curve: number, places: number): { at: Vector; curvature: Vector }[] {
  core.comb(curve, places);
  const r = answer().real;
  return Array.from({ length: places + 1 }, (_, i) => ({ at: vector(r, 6 * i), curvature: vector(r, 6 * i + 3) }));
}
export function segment(curve: number): { length: number; radius: number; t: number } {
  core.segment(curve);
  const [length, radius, t] = answer().real;
  return { length, radius, t };
}
export function joint(): { gap: number; tangentAngle: number; speedRatio: number; normalAngle: number; before: number; after: number; jump: number; secondJump: number; tangent: Vector } {
  core.joint();
  const r = answer().real;
  return { gap: r[0], tangentAngle: r[1], speedRatio: r[2], normalAngle: r[3], before: r[4], after: r[5], jump: r[6], secondJump: r[7], tangent: vector(r, 8) };
}
export function repair(kind: 'g2' | 'c2'): [Vector, Vector] | null {
  if (!core.repair(kind === 'g2' ? 0 : 1)) return null;
  const r = answer().real;
  return [vector(r, 0), vector(r, 3)];
}

export const FITS = ['newton', 'minimax', 'exact', 'table'] as const;
export type Fit = (typeof FITS)[number];
export interface LengthErrors { t: number; place: number; feed: number; at: { u: number; t: number; feed: number }[] }
/** @param every every so manyth of 1201 places; 0: only the largest errors */
export function lengthErrors(curve: number, fit: Fit, degree: number, every: number): LengthErrors {
  core.length_errors(curve, FITS.indexOf(fit), degree, every);
  const r = answer().real;
  return { t: r[0], place: r[1], feed: r[2], at: Array.from({ length: (r.length - 3) / 3 }, (_, i) => ({ u: r[3 + 3 * i], t: r[4 + 3 * i], feed: r[5 + 3 * i] })) };
}

/** One hash over cases 0 to count - 1, to be compared with `kadr teach sweep`. */
export const sweep = (count: number): string => BigInt.asUintN(64, core.sweep(0, count, core.sweep_begin())).toString(16).padStart(16, '0');
