import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { BytesInput, NpyArray } from '../types.js';

/**
 * Reads NumPy's `.npy`.
 *
 * @example
 * ```js
 * import { init, readNpy, writeNpy } from 'boresight';
 *
 * await init();
 * const bytes = writeNpy({ kind: 'real', data: new Float32Array([1, 2, 3, 4, 5, 6]), shape: [2, 3] });
 * console.log(readNpy(bytes).shape); // → [ 2, 3 ]
 * ```
 */
export function readNpy(bytes: BytesInput): NpyArray {
  return call(() => glue.readNpy(bytes) as NpyArray);
}

/** The bytes of a `.npy` file, in the precision of the data. */
export function writeNpy(array: NpyArray): Uint8Array {
  return call(() => glue.writeNpy(array));
}
