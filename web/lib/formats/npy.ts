import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { BytesInput, NpyArray } from '../types.js';

/** Reads NumPy's `.npy`. */
export function readNpy(bytes: BytesInput): NpyArray {
  return call(() => glue.readNpy(bytes) as NpyArray);
}

/** The bytes of a `.npy` file, in the precision of the data. */
export function writeNpy(array: NpyArray): Uint8Array {
  return call(() => glue.writeNpy(array));
}
