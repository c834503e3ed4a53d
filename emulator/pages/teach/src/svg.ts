// Elements of drawings: shapes get classes, colours are the style sheet's.

export type Attributes = Record<string, string | number>;

export function shape(name: string, attributes: Attributes = {}, text = ''): SVGElement {
  const out = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) out.setAttribute(key, typeof value === 'number' ? String(Math.round(value * 100) / 100) : value);
  if (text) out.textContent = text;
  return out;
}

/** A drawing of a size in its own units; it grows with its place on the page. */
export function drawing(width: number, height: number, label: string, className = ''): SVGElement {
  const out = shape('svg', { viewBox: `0 0 ${Math.round(width)} ${Math.round(height)}`, role: 'img', 'aria-label': label });
  if (className) out.setAttribute('class', className);
  return out;
}

export const polyline = (points: readonly (readonly [number, number])[], className: string): SVGElement =>
  shape('polyline', { points: points.map(([x, y]) => `${x.toFixed(2)},${y.toFixed(2)}`).join(' '), class: className });

/** How a sign looks, in shape as well as in colour: a disc below the curve, a ring above it, a square on it. */
export function signMark(x: number, y: number, r: number, sign: number, className = ''): SVGElement {
  const look = sign < 0 ? 'below' : sign > 0 ? 'above' : 'on';
  const square = sign === 0;
  return square ? shape('rect', { x: x - r, y: y - r, width: 2 * r, height: 2 * r, class: `${look} ${className}` })
    : shape('circle', { cx: x, cy: y, r: sign > 0 ? r * 0.92 : r, class: `${look} ${className}` });
}

/** A corner looked at: a diamond, full or hollow by the sign of F. */
export function testedMark(x: number, y: number, r: number, sign: number, className = ''): SVGElement {
  const look = sign < 0 ? 'below' : sign > 0 ? 'above' : 'on';
  return shape('path', { d: `M${(x - r).toFixed(2)} ${y.toFixed(2)}l${r.toFixed(2)} ${(-r).toFixed(2)} ${r.toFixed(2)} ${r.toFixed(2)} ${(-r).toFixed(2)} ${r.toFixed(2)}z`, class: `tested ${look} ${className}` });
}

/** A round step for an axis: 1, 2 or 5 times a power of ten, so that about `most` fit. */
export function roundStep(range: number, most: number): number {
  const raw = range / most, power = 10 ** Math.floor(Math.log10(raw));
  return [1, 2, 5, 10].map((m) => m * power).find((step) => step >= raw) ?? 10 * power;
}
