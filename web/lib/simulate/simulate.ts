import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { CubeOptions, CubeResult, SnapshotOptions, SnapshotResult } from '../types.js';

/** Snapshots of scenes with given or sampled targets; the same bits on every platform. */
export function simulateSnapshots(options: SnapshotOptions): SnapshotResult {
  return call(() => glue.simulateSnapshots(options) as SnapshotResult);
}

/** Raw samples of a time-division MIMO radar; the same bits on every platform. */
export function simulateCube(options: CubeOptions): CubeResult {
  return call(() => glue.simulateCube(options) as CubeResult);
}
