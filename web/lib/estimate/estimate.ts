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

/** The estimators and what each needs and gives. */
export function methods(): MethodInfo[] {
  return call(() => glue.methods() as MethodInfo[]);
}

/** Why an estimator with these options could not work on so many snapshots; null where it can. */
export function unsuited(options: EstimatorOptions, snapshots: number): Unsuited | null {
  return call(() => glue.unsuited(options, snapshots) as Unsuited | null);
}

/** Estimates angles once. To run one method on many cells, keep an {@link Estimator}. */
export function estimate(input: EstimateInput, options: EstimatorOptions): Estimate {
  return call(() => glue.estimate(input, options) as Estimate);
}

/** An estimator that keeps its grids, plans and scratch space between cells. */
export class Estimator extends Handle<glue.Estimator> {
  constructor(options: EstimatorOptions) {
    super(core, () => new glue.Estimator(options));
  }

  estimate(input: EstimateInput): Estimate {
    return this.use((raw) => raw.estimate(input) as Estimate);
  }

  /** Estimates every cell of a batch; each gives what {@link Estimator.estimate} gives for it alone. */
  estimateBatch(input: BatchInput, options?: BatchOptions): BatchEstimate {
    return this.use((raw) => raw.estimateBatch(input, options) as BatchEstimate);
  }
}
