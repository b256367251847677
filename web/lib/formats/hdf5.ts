import * as glue from '../../wasm/boresight_drives.js';
import { drives } from '../drive/drive.js';
import type { ArrayEntry, BytesInput, NpyArray, ReadArrayOptions } from '../types.js';

/**
 * Reads an array of MATLAB's `.mat` (saved with `-v7.3`) or of an HDF5 file, as {@link readNpy} reads NumPy's; in the
 * module of drives, which holds the reader of HDF5. Axes are in MATLAB's order.
 *
 * @example
 * ```js
 * import { readFile } from 'node:fs/promises';
 * import { initDrives, listArrays, readArray } from 'boresight';
 *
 * await initDrives();
 * const bytes = await readFile('measured.mat');
 * console.log(listArrays(bytes).map(({ dataset }) => dataset).join(', ')); // → X, counts, cube, single, board/gain
 * const { kind, shape } = readArray(bytes, { dataset: 'X' });
 * console.log(kind, shape.join(' x ')); // → complex 3 x 2
 * ```
 */
export function readArray(bytes: BytesInput, options?: ReadArrayOptions): NpyArray {
  return drives.call(() => glue.readArray(bytes, options) as NpyArray);
}

/** The arrays of real and complex numbers in a file that {@link readArray} reads. */
export function listArrays(bytes: BytesInput): ArrayEntry[] {
  return drives.call(() => glue.listArrays(bytes) as ArrayEntry[]);
}
