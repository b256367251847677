/** The numbers that a field takes. */
import { power } from '../../plots/format.ts';

export interface Range {
  /** -Infinity where nothing limits it. */
  min: number;
  max: number;
  /** `min` itself is none of them. */
  above?: boolean | undefined;
  integer?: boolean | undefined;
}

export function within(value: number, { min, max, above, integer }: Range): boolean {
  const high = above ? value > min : value >= min;
  return Number.isFinite(value) && high && value <= max && (!integer || Number.isInteger(value));
}

/** `A whole number from 1 to 64`. */
export function rangeText({ min, max, above, integer }: Range): string {
  const low = min === Number.NEGATIVE_INFINITY ? '' : ` ${above ? 'above' : 'from'} ${power(min)}`;
  const high = max === Number.POSITIVE_INFINITY ? '' : ` ${above ? 'up ' : ''}to ${power(max)}`;
  return `A ${integer ? 'whole ' : ''}number${low}${high}`;
}
