/** What elements of colour-coded maps have in common. */
import { COLOR_MAPS, type ColorMapName } from '../plots/colormap.ts';

/** Attributes of colours. */
export const COLOR_ATTRIBUTES = ['colors', 'low-db', 'high-db', 'span-db'];

/** The colour map an attribute names; the first where it names none. */
export function colorsOf(given: string | null): ColorMapName {
  return COLOR_MAPS.find((name) => name === given) ?? COLOR_MAPS[0];
}

/**
 * Levels of the first and last colour: from attributes, else the highest level, rounded up, and so many decibels below it.
 */
export function limitsOf(
  values: ArrayLike<number>,
  number: (name: string, absent: number) => number,
  span: number,
): [number, number] {
  let top = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < values.length; i++) if ((values[i] as number) > top) top = values[i] as number;
  const high = number('high-db', Number.isFinite(top) ? Math.ceil(top) : 0);
  const low = number('low-db', high - Math.abs(number('span-db', span)));
  return low < high ? [low, high] : [high - span, high];
}
