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

/** Snapshots that are simulated. */
export interface SnapshotOptions extends SnapshotRequest {
  array: ArrayInput;
  /** Given targets, or a rule to sample them from. */
  targets: readonly SnapshotTarget[] | SceneSampling;
}

/** A cube that is simulated. */
export interface CubeOptions extends CubeRequest {
  waveform: Waveform;
  array: ArrayInput;
  targets: readonly CubeTarget[];
}

/** A frame of the street that is simulated. */
export interface SimulateStreetOptions extends StreetOptions {
  /** Name of the radar. */
  radar: string;
}
