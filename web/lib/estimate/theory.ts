import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { Bound, BoundOptions, CountOptions, CountResult, EstimateInput } from '../types.js';

/**
 * Counts sources by the eigenvalues of the covariance: by the largest-root test, which is valid from two snapshots on, or by an
 * information criterion.
 *
 * @example
 * ```js
 * import { countSources, init, simulateSnapshots } from 'boresight';
 *
 * await init();
 * const targets = [-12, 20, 40].map((azimuthDeg) => ({ azimuthDeg }));
 * const { data, shape } = simulateSnapshots({ array: 'ula8', targets, snapshots: 100, snrDb: 20, seed: 1 });
 * const { count } = countSources({ snapshots: { data, shape: shape.slice(1) } });
 * console.log(count); // → 3
 * ```
 */
export function countSources(input: EstimateInput, options?: CountOptions): CountResult {
  return call(() => glue.countSources(input, options) as CountResult);
}

/**
 * The Cramer-Rao bound: the least error any unbiased estimator can have.
 *
 * @example
 * ```js
 * import { cramerRaoBound, init } from 'boresight';
 *
 * await init();
 * const targets = [{ azimuthDeg: 10, snrDb: 10 }];
 * // Standard deviations that no unbiased estimator is below.
 * const { azimuthDeg } = cramerRaoBound({ array: 'ula8', targets, snapshots: 100 });
 * console.log(azimuthDeg[0].toFixed(4)); // → 0.0639
 * ```
 */
export function cramerRaoBound(options: BoundOptions): Bound {
  return call(() => glue.cramerRaoBound(options) as Bound);
}
