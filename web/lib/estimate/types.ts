/** Estimators, alone and over batches; source counting and bounds. */
import type { BoundRequest, BoundTarget, Method, SharedEstimatorOptions } from '../generated/options.js';
import type { ArrayInput, ComplexData } from '../types.js';

/** An estimator: its method, the array it works on, and its options. */
export interface EstimatorOptions extends SharedEstimatorOptions {
  method: Method;
  array: ArrayInput;
}

/** Snapshots (elements x snapshots, or a vector of elements) or a covariance. */
export type EstimateInput = { snapshots: ComplexData } | { covariance: ComplexData; snapshotCount: number };

/** Snapshots of many cells: [cells, elements] or [cells, elements, snapshots]. */
export interface BatchInput {
  snapshots: ComplexData;
}

export interface BatchOptions {
  /** Whether spectra are kept, of methods that have them. Default false. */
  spectra?: boolean;
}

export interface BoundOptions extends BoundRequest {
  array: ArrayInput;
  /** Uncorrelated targets; their phases matter to the deterministic bound of one snapshot only. */
  targets: readonly BoundTarget[];
}
