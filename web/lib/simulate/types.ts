/** Simulated snapshots, data cubes and frames of a street. */
import type {
  ArrayInput,
  CubeRequest,
  CubeTarget,
  SceneSampling,
  SnapshotRequest,
  SnapshotTarget,
  StreetOptions,
  Waveform,
} from '../types.js';

export interface SnapshotOptions extends SnapshotRequest {
  array: ArrayInput;
  /** Given targets, or a rule to sample them from. */
  targets: readonly SnapshotTarget[] | SceneSampling;
}

export interface CubeOptions extends CubeRequest {
  waveform: Waveform;
  array: ArrayInput;
  targets: readonly CubeTarget[];
}

export interface SimulateStreetOptions extends StreetOptions {
  /** Name of the radar. */
  radar: string;
}
