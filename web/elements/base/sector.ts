import type { Interval } from '../../plots/types.ts';

/** Azimuths that an attribute names: so many degrees to each side, or from where to where; the default otherwise. */
export function sectorOf(given: string | null, absent: Interval): Interval {
  const [first = Number.NaN, second = Number.NaN] = (given ?? '').trim().split(/\s+/).map(Number);
  if (first < second) return [Math.max(first, -180), Math.min(second, 180)];
  const reach = Math.min(Math.abs(first), 180);
  return reach > 0 ? [-reach, reach] : absent;
}
