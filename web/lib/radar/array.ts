import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { ArrayGeometry, ArrayInput } from '../types.js';

/** Names of the array presets; `ulaN` (such as `ula8`) comes on top. */
export function arrayPresets(): string[] {
  return call(() => glue.arrayPresets() as string[]);
}

/**
 * Positions, channels and properties of an array.
 *
 * @example
 * ```js
 * import { array, init } from 'boresight';
 *
 * await init();
 * const { positions, resolutionDeg, unambiguousDeg } = array('ula8');
 * console.log(positions.length, resolutionDeg.toFixed(1), unambiguousDeg); // → 8 14.5 90
 * ```
 */
export function array(input: ArrayInput): ArrayGeometry {
  return call(() => glue.array(input) as ArrayGeometry);
}
