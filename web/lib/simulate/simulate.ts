import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { CubeOptions, CubeResult, SnapshotOptions, SnapshotResult } from '../types.js';

/**
 * Snapshots of scenes with given or sampled targets; the same bits on every platform.
 *
 * @example
 * ```js
 * import { init, simulateSnapshots } from 'boresight';
 *
 * await init();
 * const { shape, truth } = simulateSnapshots({ array: 'ula8', targets: { count: [2, 2] }, snrDb: 20, scenes: 500, seed: 7 });
 * console.log(shape, truth.length); // → [ 500, 8, 1 ] 500
 * ```
 */
export function simulateSnapshots(options: SnapshotOptions): SnapshotResult {
  return call(() => glue.simulateSnapshots(options) as SnapshotResult);
}

/**
 * Raw samples of a time-division MIMO radar; the same bits on every platform.
 *
 * @example
 * ```js
 * import { init, processCube, simulateCube, waveformPreset } from 'boresight';
 *
 * await init();
 * const radar = { waveform: waveformPreset('3dcnn-simulated'), array: 'ula8' };
 * const targets = [{ rangeM: 70, rateMps: 5, azimuthDeg: -4 }];
 * const cube = simulateCube({ ...radar, targets, snrDb: 10, seed: 2 });
 * const [{ detections }] = processCube(cube, radar);
 * console.log(detections.map(({ rangeM, azimuthDeg }) => `${rangeM.toFixed(0)} m, ${azimuthDeg.toFixed(0)} deg`));
 * // → [ '70 m, -4 deg' ]
 * ```
 */
export function simulateCube(options: CubeOptions): CubeResult {
  return call(() => glue.simulateCube(options) as CubeResult);
}
