import { interpolateCividis, interpolateMagma, interpolateViridis } from 'd3-scale-chromatic';

/** Perceptually uniform maps; the first is the default. */
export const COLOR_MAPS = ['viridis', 'cividis', 'magma'] as const;
export type ColorMapName = (typeof COLOR_MAPS)[number];

const INTERPOLATORS: Record<ColorMapName, (t: number) => string> = {
  viridis: interpolateViridis,
  cividis: interpolateCividis,
  magma: interpolateMagma,
};

const tables = new Map<ColorMapName, Uint8ClampedArray>();

/** 256 RGBA colours. */
export function colorTable(name: ColorMapName): Uint8ClampedArray {
  const known = tables.get(name);
  if (known) return known;
  const table = new Uint8ClampedArray(256 * 4);
  for (let i = 0; i < 256; i++) {
    table.set(parseColor(INTERPOLATORS[name](i / 255)), i * 4);
  }
  tables.set(name, table);
  return table;
}

/** `rgb(r, g, b)` or `#rrggbb`. */
export function parseColor(text: string): [number, number, number, number] {
  if (text.startsWith('#')) {
    const value = Number.parseInt(text.slice(1), 16);
    return [(value >> 16) & 255, (value >> 8) & 255, value & 255, 255];
  }
  const [r = 0, g = 0, b = 0] = (text.match(/\d+(\.\d+)?/g) ?? []).map(Number);
  return [r, g, b, 255];
}
