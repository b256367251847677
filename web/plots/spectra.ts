/** Estimates as the plots show them. */
import type { Estimate, Position, Source } from 'boresight';
import type { Marker } from './layers.ts';
import type { SeriesStyle } from './theme.ts';

export interface Curve {
  method: string;
  title: string;
  azimuthDeg: Float64Array;
  valuesDb: Float64Array;
}

/** Row of a spectrum nearest to zero elevation. */
export function cut(elevationDeg: Float64Array): number {
  let best = 0;
  elevationDeg.forEach((value, i) => {
    if (Math.abs(value) < Math.abs(elevationDeg[best] as number)) best = i;
  });
  return best;
}

/**
 * The spectrum at zero elevation. A pseudo-spectrum has no power of its own: it is shifted so that
 * its highest peak meets the strongest estimated power. The grid ends a step before 90 degrees; where the array `closes`
 * it, a spectrum goes on to where it began.
 */
export function curve(estimate: Estimate, title: string, periodic = false): Curve | null {
  const { spectrum } = estimate;
  if (!spectrum) return null;
  const size = spectrum.azimuthDeg.length;
  const row = cut(spectrum.elevationDeg);
  let valuesDb = spectrum.valuesDb.subarray(row * size, (row + 1) * size);
  if (spectrum.kind === 'pseudo') {
    const shift = (estimate.sources[0]?.powerDb ?? 0) - highest(valuesDb);
    valuesDb = valuesDb.map((value) => value + shift);
  }
  const { azimuthDeg } = spectrum;
  const whole = periodic && (azimuthDeg[0] ?? 0) < -89.9;
  return {
    method: estimate.method,
    title,
    azimuthDeg: whole ? appended(azimuthDeg, 90) : azimuthDeg,
    valuesDb: whole ? appended(valuesDb, valuesDb[0] ?? Number.NaN) : valuesDb,
  };
}

/** Whether what an array sees at 90 degrees is what it sees at -90: its elements are whole half wavelengths apart. */
export const closes = (positions: readonly Position[]): boolean =>
  positions.every(([, y]) => Math.abs(y - (positions[0]?.[1] ?? 0) - Math.round(y - (positions[0]?.[1] ?? 0))) < 1e-6);

function appended(values: Float64Array, last: number): Float64Array {
  const longer = new Float64Array(values.length + 1);
  longer.set(values);
  longer[values.length] = last;
  return longer;
}

/** Curves on the grid of the finest; those of coarser grids are lines between their points, and nothing beyond. */
export function onOneGrid(curves: readonly (Curve | null)[]): Curve[] {
  const some = curves.filter((item) => item !== null);
  const finest = some.reduce<Curve | undefined>(
    (most, item) => (most && most.azimuthDeg.length >= item.azimuthDeg.length ? most : item),
    undefined,
  );
  return some.map((item) => (finest && item !== finest ? { ...item, ...resampled(item, finest.azimuthDeg) } : item));
}

function resampled({ azimuthDeg, valuesDb }: Curve, onto: Float64Array): Pick<Curve, 'azimuthDeg' | 'valuesDb'> {
  const same = azimuthDeg.length === onto.length && azimuthDeg.every((azimuth, i) => azimuth === onto[i]);
  if (same) return { azimuthDeg, valuesDb };
  let right = 1;
  const between = (azimuth: number): number => {
    while (right + 1 < azimuthDeg.length && (azimuthDeg[right] as number) < azimuth) right += 1;
    const [a, b] = [azimuthDeg[right - 1] ?? Number.NaN, azimuthDeg[right] ?? Number.NaN];
    const share = (azimuth - a) / (b - a);
    const [from, to] = [valuesDb[right - 1] ?? Number.NaN, valuesDb[right] ?? Number.NaN];
    return share >= 0 && share <= 1 ? from + share * (to - from) : Number.NaN;
  };
  return { azimuthDeg: onto, valuesDb: onto.map(between) };
}

/** Sources of a method on its spectrum, with bars of the deviations they state. */
export function sourceMarkers(sources: readonly Source[], style: SeriesStyle): Marker[] {
  return sources.map(({ azimuthDeg, powerDb, deviation }) => ({
    x: azimuthDeg,
    y: powerDb,
    style,
    ...(deviation ? { deviation: { x: deviation.azimuthDeg, y: deviation.powerDb } } : {}),
  }));
}

/** Whether a method states deviations of its sources: what its entry in a legend says then. */
export const withBars = (title: string, sources: readonly Source[]): string =>
  sources.some(({ deviation }) => deviation) ? `${title}, bars ±σ it states` : title;

/** The highest level beyond the first minima beside the peak of a spectrum at zero elevation, over the peak; null where nothing is. */
export function peakSidelobeDb(estimate: Estimate): number | null {
  const values = curve(estimate, '')?.valuesDb;
  if (!values) return null;
  const peak = values.indexOf(highest(values));
  let [left, right] = [peak, peak];
  while (left > 0 && (values[left - 1] as number) <= (values[left] as number)) left -= 1;
  while (right < values.length - 1 && (values[right + 1] as number) <= (values[right] as number)) right += 1;
  const beyond = Math.max(highest(values.subarray(0, left)), highest(values.subarray(right + 1)));
  return Number.isFinite(beyond) ? beyond - (values[peak] as number) : null;
}

export function highest(values: ArrayLike<number>): number {
  let best = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < values.length; i++) best = Math.max(best, values[i] as number);
  return best;
}
