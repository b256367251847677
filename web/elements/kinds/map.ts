/** What elements of colour-coded maps have in common. */

import { COLOR_MAPS, type ColorMapName } from '../../plots/colormap.ts';
import { limitsBelow } from '../../plots/heat.ts';

/** Attributes of colours. */
export const COLOR_ATTRIBUTES = ['colors', 'low-db', 'high-db', 'span-db'];

/** The colour map an attribute names; the first where it names none. */
export function colorsOf(given: string | null): ColorMapName {
  return COLOR_MAPS.find((name) => name === given) ?? COLOR_MAPS[0];
}

/** Levels of the first and last colour: from attributes, else from the highest level down. */
export function limitsOf(
  values: ArrayLike<number>,
  number: (name: string, absent: number) => number,
  span: number,
): [number, number] {
  let top = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < values.length; i++) if ((values[i] as number) > top) top = values[i] as number;
  const down = Math.abs(number('span-db', span)) || span;
  const high = number('high-db', limitsBelow(top, down)[1]);
  const low = number('low-db', high - down);
  return low < high ? [low, high] : [high - span, high];
}
