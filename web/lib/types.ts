/**
 * Options and results of the package. Angles are in degrees, all else in SI units; the unit is in
 * the name. Azimuth is positive to the left of boresight, range rate positive when receding.
 * Each subject's are in its folder, what all share is here.
 */

export type * from './array-calibration/types.js';
export type * from './capture/types.js';
export type * from './drive/types.js';
export type * from './estimate/types.js';
export type * from './generated/options.js';
export type * from './generated/results.js';
export type * from './image/types.js';
export type * from './live/types.js';
export type * from './mounting/types.js';
export type * from './neural/types.js';
export type * from './radar/types.js';
export type * from './simulate/types.js';

/** Interleaved [re, im] numbers in C order with their shape (complex numbers, not floats). */
export interface ComplexData {
  data: Float32Array | Float64Array;
  shape: readonly number[];
}

/** Real numbers in C order with their shape. */
export interface RealData {
  data: Float32Array | Float64Array;
  shape: readonly number[];
}

/** A binary file. */
export type BytesInput = Uint8Array | ArrayBuffer;

/** A text file: its text or its bytes. */
export type TextInput = string | Uint8Array | ArrayBuffer;
