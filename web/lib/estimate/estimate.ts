import * as glue from '../../wasm/boresight.js';
import { Handle } from '../runtime/handle.js';
import { call, core } from '../runtime/instance.js';
import type {
  BatchEstimate,
  BatchInput,
  BatchOptions,
  Estimate,
  EstimateInput,
  EstimatorOptions,
  MethodInfo,
  Unsuited,
} from '../types.js';

/**
 * The estimators and what each needs and gives.
 *
 * @example
 * ```js
 * import { init, methods } from 'boresight';
 *
 * await init();
 * const names = methods().map(({ name }) => name);
 * console.log(names.slice(0, 4)); // → [ 'bartlett', 'capon', 'music', 'single-snapshot-music' ]
 * ```
 */
export function methods(): MethodInfo[] {
  return call(() => glue.methods() as MethodInfo[]);
}

/** Why an estimator with these options could not work on so many snapshots; null where it can. */
export function unsuited(options: EstimatorOptions, snapshots: number): Unsuited | null {
  return call(() => glue.unsuited(options, snapshots) as Unsuited | null);
}

/**
 * Estimates angles once. To run one method on many cells, keep an {@link Estimator}.
 *
 * @example
 * ```js
 * import { estimate, init, simulateSnapshots } from 'boresight';
 *
 * await init();
 * const targets = [{ azimuthDeg: -12 }, { azimuthDeg: 20 }];
 * const { data, shape } = simulateSnapshots({ array: 'ula8', targets, snapshots: 50, snrDb: 20, seed: 1 });
 * // One scene of so many scenes: elements x snapshots.
 * const snapshots = { data, shape: shape.slice(1) };
 * const { sources } = estimate({ snapshots }, { array: 'ula8', method: 'music', sources: 2 });
 * console.log(sources.map(({ azimuthDeg }) => azimuthDeg.toFixed(1))); // → [ '20.0', '-12.0' ]
 * ```
 */
export function estimate(input: EstimateInput, options: EstimatorOptions): Estimate {
  return call(() => glue.estimate(input, options) as Estimate);
}

/**
 * An estimator that keeps its grids, plans and scratch space between cells.
 *
 * @example
 * ```js
 * import { Estimator, init, simulateSnapshots } from 'boresight';
 *
 * await init();
 * const targets = [{ azimuthDeg: 5 }];
 * const many = { snapshots: 4, scenes: 1000, seed: 1 };
 * const { data, shape } = simulateSnapshots({ array: 'ula8', targets, snrDb: 10, ...many });
 * const estimator = new Estimator({ array: 'ula8', method: 'capon', maxPeaks: 1 });
 * const { azimuthDeg } = estimator.estimateBatch({ snapshots: { data, shape } });
 * estimator.free();
 * const mean = azimuthDeg.reduce((sum, angle) => sum + angle) / azimuthDeg.length;
 * console.log(azimuthDeg.length, mean.toFixed(2)); // → 1000 5.00
 * ```
 */
export class Estimator extends Handle<glue.Estimator> {
  constructor(options: EstimatorOptions) {
    super(core, () => new glue.Estimator(options));
  }

  /** Estimates the angles of one cell. */
  estimate(input: EstimateInput): Estimate {
    return this.use((raw) => raw.estimate(input) as Estimate);
  }

  /** Estimates every cell of a batch; each gives what {@link Estimator.estimate} gives for it alone. */
  estimateBatch(input: BatchInput, options?: BatchOptions): BatchEstimate {
    return this.use((raw) => raw.estimateBatch(input, options) as BatchEstimate);
  }
}
