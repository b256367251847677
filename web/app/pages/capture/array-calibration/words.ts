/** What the parts of array calibration say alike. */
import { fixed } from '../../../../plots/format.ts';

/** Of a saved file's name. */
export type FileParts = readonly (string | number)[];

/** With its standard deviation where that is known. */
export const withDeviation = (value: string, deviation: number | undefined, digits: number): string =>
  deviation === undefined ? value : `${value} ± ${fixed(deviation, digits)}`;
