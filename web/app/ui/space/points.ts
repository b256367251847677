/** Points in space, what colours them, and what is said of them: all of the 3-D view that needs no WebGL. */
import { colorTable } from '../../../plots/colormap.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { type ThemeName, weightColor } from '../../../plots/theme.ts';

/** A point in the radar's frame. */
export interface SpacePoint {
  /** Forward, m. */
  xM: number;
  /** To the left, m. */
  yM: number;
  /** Up, m. */
  zM: number;
  /** Positive when receding; not a number where it is not known. */
  rateMps: number;
  /** A level, such as a power or an SNR; not a number where there is none. */
  powerDb: number;
  /** Tells what belongs together: points of one key are chosen together. */
  key: string;
}

export const COLOURED_BY = ['rate', 'power', 'height'] as const;
export type ColouredBy = (typeof COLOURED_BY)[number];

/** What colours tell; the level is what a page calls it. */
export const colourNames = (level: string): Readonly<Record<ColouredBy, string>> => ({
  rate: 'Range rate (m/s)',
  power: level,
  height: 'Height (m)',
});

const VALUES: Readonly<Record<ColouredBy, (point: SpacePoint) => number>> = {
  rate: ({ rateMps }) => rateMps,
  power: ({ powerDb }) => powerDb,
  height: ({ zM }) => zM,
};

/** Values to colours: of what, from where to where. */
export interface ColourScale {
  by: ColouredBy;
  limits: readonly [low: number, high: number];
}

/** The scale that holds all points; that of range rates is as wide to both sides, and grey stands still. */
export function colourScale(points: readonly SpacePoint[], by: ColouredBy): ColourScale {
  let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (const point of points) {
    const value = VALUES[by](point);
    if (!Number.isFinite(value)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) [low, high] = [0, 1];
  if (by === 'rate') {
    const most = Math.max(Math.abs(low), Math.abs(high), 0.1);
    return { by, limits: [-most, most] };
  }
  const middle = (low + high) / 2;
  const half = Math.max((high - low) / 2, 0.5);
  return { by, limits: [middle - half, middle + half] };
}

/** Red, green and blue, 0 to 255, at a share of a scale. */
export function colourAt(by: ColouredBy, share: number, theme: ThemeName): readonly [number, number, number] {
  if (by === 'rate') {
    const [r = 0, g = 0, b = 0] = (weightColor(1 - share, theme).match(/\d+/g) ?? []).map(Number);
    return [r, g, b];
  }
  const table = colorTable('viridis');
  // The ends of the map would vanish on white, and on black.
  const [from, to] = theme === 'light' ? [0, 0.85] : [0.25, 1];
  const at = 4 * Math.round(255 * (from + (to - from) * Math.min(Math.max(share, 0), 1)));
  return [table[at] ?? 0, table[at + 1] ?? 0, table[at + 2] ?? 0];
}

export function pointColour(point: SpacePoint, { by, limits: [low, high] }: ColourScale, theme: ThemeName) {
  const value = VALUES[by](point);
  return Number.isFinite(value) ? colourAt(by, (value - low) / (high - low), theme) : ([128, 128, 128] as const);
}

/** How far axes go, m: whole tens or fives around all points, and the radar. */
export interface SpaceExtent {
  x: readonly [number, number];
  y: readonly [number, number];
  z: readonly [number, number];
}

/** The extent that holds points and what was shown before, so that a view does not jump while frames play. */
export function widened(points: readonly SpacePoint[], before: SpaceExtent | null): SpaceExtent {
  const span = { x: [...(before?.x ?? [0, 2])], y: [...(before?.y ?? [-1, 1])], z: [...(before?.z ?? [-1, 1])] };
  const take = (axis: number[], value: number): void => {
    if (!Number.isFinite(value)) return;
    axis[0] = Math.min(axis[0] as number, value);
    axis[1] = Math.max(axis[1] as number, value);
  };
  for (const { xM, yM, zM } of points) {
    take(span.x, xM);
    take(span.y, yM);
    take(span.z, zM);
  }
  const round = (axis: number[]): [number, number] => {
    const step = gridStep((axis[1] as number) - (axis[0] as number));
    return [step * Math.floor((axis[0] as number) / step), step * Math.ceil((axis[1] as number) / step)];
  };
  return { x: round(span.x), y: round(span.y), z: round(span.z) };
}

/** Metres between lines of a grid, so that there are four to ten of them. */
export function gridStep(span: number): number {
  const rough = Math.max(span, 1e-3) / 10;
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5, 10].find((factor) => factor * power >= rough) ?? 10);
}

/** Multiples of the step in an interval. */
export function ticks([low, high]: readonly [number, number], step: number): number[] {
  const first = Math.ceil(low / step - 1e-9);
  return Array.from({ length: Math.max(Math.floor(high / step + 1e-9) - first + 1, 0) }, (_, k) => (first + k) * step);
}

/** A point in words. */
export function pointWords({ xM, yM, zM, rateMps, powerDb }: SpacePoint): string {
  return [
    `forward ${fixed(xM, 2)} m`,
    `left ${signed(yM, 2)} m`,
    `up ${signed(zM, 2)} m`,
    ...(Number.isFinite(rateMps) ? [`rate ${signed(rateMps, 2)} m/s`] : []),
    ...(Number.isFinite(powerDb) ? [`${fixed(powerDb, 1)} dB`] : []),
  ].join('   ');
}

/** All of them, for who does not see them. */
export function cloudWords(points: readonly SpacePoint[]): string {
  if (!points.length) return 'No detections.';
  const of = (value: (point: SpacePoint) => number) => {
    const all = points.map(value);
    return [Math.min(...all), Math.max(...all)] as const;
  };
  const [near, far] = of(({ xM }) => xM);
  const [right, left] = of(({ yM }) => yM);
  const [low, high] = of(({ zM }) => zM);
  return `${points.length} detections from ${fixed(near, 1)} to ${fixed(far, 1)} m forward, ${signed(right, 1)} to ${signed(left, 1)} m to the left and ${signed(low, 1)} to ${signed(high, 1)} m up.`;
}

/** The key of the point after, or before, the chosen one in order of range, round and round. */
export function stepped(points: readonly SpacePoint[], chosen: string | null, by: 1 | -1): string | null {
  const keys = [...new Set([...points].sort((a, b) => rangeOf(a) - rangeOf(b)).map(({ key }) => key))];
  if (!keys.length) return null;
  const at = chosen === null ? -1 : keys.indexOf(chosen);
  return keys[at < 0 ? (by > 0 ? 0 : keys.length - 1) : (at + by + keys.length) % keys.length] ?? null;
}

const rangeOf = ({ xM, yM, zM }: SpacePoint): number => Math.hypot(xM, yM, zM);
