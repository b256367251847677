import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { Bound, BoundOptions, CountOptions, CountResult, EstimateInput } from '../types.js';

/** Counts sources by an information criterion on the eigenvalues of the covariance. */
export function countSources(input: EstimateInput, options?: CountOptions): CountResult {
  return call(() => glue.countSources(input, options) as CountResult);
}

/** The Cramer-Rao bound: the least error any unbiased estimator can have. */
export function cramerRaoBound(options: BoundOptions): Bound {
  return call(() => glue.cramerRaoBound(options) as Bound);
}
