// A ramp of colours that is monotone in lightness and safe for the common colour blindnesses (after cividis). Its ends
// are clipped by theme: dark blue drowns on a dark ground, yellow on white.

const ANCHORS = [[0, 32, 77], [39, 60, 110], [87, 92, 109], [124, 123, 120], [165, 156, 116], [210, 193, 94], [255, 233, 69]];

export const isDark = (): boolean => document.documentElement.classList.contains('dark');

export function ramp(share: number): [number, number, number] {
  const [from, to] = isDark() ? [0.22, 1] : [0, 0.8];
  const at = (from + (to - from) * Math.max(0, Math.min(1, share))) * (ANCHORS.length - 1);
  const i = Math.min(ANCHORS.length - 2, Math.floor(at)), part = at - i;
  const mix = (k: number): number => (ANCHORS[i][k] + (ANCHORS[i + 1][k] - ANCHORS[i][k]) * part) / 255;
  return [mix(0), mix(1), mix(2)];
}

export const css = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function rgb(hex: string): [number, number, number] {
  const n = parseInt(hex.slice(1), 16);
  return [(n >> 16) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}
