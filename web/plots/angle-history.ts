/** Angles over time with the deviations they claim, and how much of them is worth showing. */
import { areaBetween, type Layer, polyline } from './layers.ts';
import { quantiles } from './quantiles.ts';
import type { SeriesStyle } from './theme.ts';
import type { Interval } from './types.ts';

/** An angle over time, columns of one length. */
export interface History {
  angleDeg: ArrayLike<number>;
  sigmaDeg: ArrayLike<number>;
}

/** A band of so many deviations, and the line in it. */
export function angleBand(
  x: ArrayLike<number>,
  { angleDeg, sigmaDeg }: History,
  sigmas: number,
  style: SeriesStyle,
): { band: Layer; line: Layer } {
  const edge = (sign: number): Float64Array =>
    Float64Array.from(angleDeg, (angle, i) => angle + sign * sigmas * (sigmaDeg[i] as number));
  return { band: areaBetween(x, edge(-1), edge(1), style), line: polyline(x, angleDeg, style) };
}

/** Most that is shown on either side of the angle, deg: a method that is far off must not hide what the others do. */
const REACH_DEG = 4;

/** What is worth showing: the first part of the drive, when little is known, may run out of sight. */
export function angleExtent(
  histories: readonly History[],
  sigmas: number,
  {
    trueDeg,
    nominalDeg,
    shownDeg,
    alwaysDeg = [],
  }: {
    trueDeg?: number | undefined;
    nominalDeg: number | null;
    /** The middle, where the truth is not known. */
    shownDeg?: number | undefined;
    /** Angles that are shown wherever they are. */
    alwaysDeg?: readonly number[];
  },
): Interval {
  const edges: number[] = [];
  const ends: number[] = trueDeg === undefined ? [] : [trueDeg];
  for (const { angleDeg, sigmaDeg } of histories) {
    for (let i = Math.floor(angleDeg.length * 0.1); i < angleDeg.length; i++) {
      const [angle, sigma] = [angleDeg[i] as number, sigmas * (sigmaDeg[i] as number)];
      if (Number.isFinite(sigma)) edges.push(angle - sigma, angle + sigma);
    }
    const last = angleDeg[angleDeg.length - 1];
    if (last !== undefined && Number.isFinite(last)) ends.push(last);
  }
  const [low, high] = quantiles(edges, 0.04, 0.96) ?? [nominalDeg ?? -1, nominalDeg ?? 1];
  const centre = trueDeg ?? shownDeg ?? (low + high) / 2;
  const bottom = Math.min(Math.max(Math.min(low, ...ends), centre - REACH_DEG), ...alwaysDeg);
  const top = Math.max(Math.min(Math.max(high, ...ends), centre + REACH_DEG), ...alwaysDeg);
  const room = Math.max(0.2 * (top - bottom), 0.05);
  const shown: [number, number] = [bottom - room, top + room];
  // The nominal angle is drawn in where that leaves the rest readable.
  if (nominalDeg !== null && nominalDeg > shown[1] && nominalDeg - shown[1] < top - bottom)
    shown[1] = nominalDeg + room;
  if (nominalDeg !== null && nominalDeg < shown[0] && shown[0] - nominalDeg < top - bottom)
    shown[0] = nominalDeg - room;
  return shown;
}
