/** Which estimate belongs to which target. */
import type { Source } from 'boresight';

export interface Assignment {
  /** Index of each target's estimate. */
  matched: (number | undefined)[];
  /** Estimates that belong to no target. */
  extra: number[];
}

/** One to one, nearest pairs first, none further apart than `gateDeg`. */
export function assign(targetsDeg: readonly number[], sources: readonly Source[], gateDeg: number): Assignment {
  const pairs = targetsDeg.flatMap((azimuth, target) =>
    sources.map((source, estimate) => ({ target, estimate, distance: Math.abs(source.azimuthDeg - azimuth) })),
  );
  pairs.sort((a, b) => a.distance - b.distance);
  const matched: (number | undefined)[] = targetsDeg.map(() => undefined);
  const taken = new Set<number>();
  for (const { target, estimate, distance } of pairs) {
    if (distance > gateDeg) break;
    if (matched[target] !== undefined || taken.has(estimate)) continue;
    matched[target] = estimate;
    taken.add(estimate);
  }
  return { matched, extra: sources.map((_, i) => i).filter((i) => !taken.has(i)) };
}
