/** The seed of what a page simulates. */
import { number } from './codec.ts';

export const seed = number(1, [0, 2 ** 32 - 1], 'integer');
