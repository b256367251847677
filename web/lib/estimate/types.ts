/** Estimators, alone and over batches; source counting and bounds. */
import type { BoundRequest, BoundTarget, Method, SharedEstimatorOptions } from '../generated/options.js';
import type { ArrayCalibrationInput, ArrayInput, ComplexData } from '../types.js';

/** An estimator: its method, the array it works on, and its options. */
export interface EstimatorOptions extends SharedEstimatorOptions {
  /** Its name, of those that `methods()` lists. */
  method: Method;
  /** A preset by name, or positions of elements in half wavelengths. */
  array: ArrayInput;
  /** What is known of the array's errors, which is taken off the snapshots. */
  calibration?: ArrayCalibrationInput;
}

/** Snapshots (elements x snapshots, or a vector of elements) or a covariance. */
export type EstimateInput = { snapshots: ComplexData } | { covariance: ComplexData; snapshotCount: number };

/** Snapshots of many cells: [cells, elements] or [cells, elements, snapshots]. */
export interface BatchInput {
  snapshots: ComplexData;
}

/** What is kept of a batch. */
export interface BatchOptions {
  /** Whether spectra are kept, of methods that have them. Default false. */
  spectra?: boolean;
}

/** The scene that a bound is for. */
export interface BoundOptions extends BoundRequest {
  /** A preset by name, or positions of elements in half wavelengths. */
  array: ArrayInput;
  /** Uncorrelated targets; their phases matter to the deterministic bound of one snapshot only. */
  targets: readonly BoundTarget[];
}
