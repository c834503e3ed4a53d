// The example of paper 004: a quadratic and a cubic in space that meet in (5, -0.5, 2).
import { repair, setChain, type Vector } from './core';
import type { Joint } from './state';

export const PAPER: Vector[][] = [
  [[0, 0, 0], [2, 2, 4], [5, -0.5, 2]],
  [[5, -0.5, 2], [8, -3, 0], [11, -1, -2], [12, 1, -1]],
];

/** The chain of the paper, or with the second and third point of curve 2 that make the joint G2 or C2. */
export function chainOf(kind: Joint): Vector[][] {
  setChain(PAPER);
  const found = kind === 'paper' ? null : repair(kind);
  const chain = found ? [PAPER[0], [PAPER[1][0], ...found, PAPER[1][3]]] : PAPER;
  setChain(chain);
  return chain;
}
