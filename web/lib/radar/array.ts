import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { ArrayGeometry, ArrayInput } from '../types.js';

/** Names of the array presets; `ulaN` (such as `ula8`) comes on top. */
export function arrayPresets(): string[] {
  return call(() => glue.arrayPresets() as string[]);
}

/** Positions, channels and properties of an array. */
export function array(input: ArrayInput): ArrayGeometry {
  return call(() => glue.array(input) as ArrayGeometry);
}
