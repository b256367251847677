/** Simulated snapshots and data cubes. */
import type { ArrayInput, ComplexData, Imperfections, Waveform } from '../types.js';

export interface SnapshotTarget {
  azimuthDeg: number;
  elevationDeg?: number;
  /** Power at one element, dB. Default 0. */
  powerDb?: number;
  /** Phase of the first snapshot; random if absent. */
  phaseDeg?: number;
}

/** Rule by which scenes are drawn, every quantity uniform. */
export interface SceneSampling {
  /** Default 0 to 16. */
  count?: readonly [fewest: number, most: number];
  /** Half width, default 60. */
  fieldOfViewDeg?: number;
  /** Half width, default 0. */
  elevationFieldOfViewDeg?: number;
  /** Default -13 to 0. */
  powerDb?: readonly [lowest: number, highest: number];
}

export interface SnapshotOptions {
  array: ArrayInput;
  /** Given targets, or a rule to sample them from. */
  targets: readonly SnapshotTarget[] | SceneSampling;
  snrDb: number;
  /** Snapshots a scene, default 1. */
  snapshots?: number;
  /** Scenes, default 1. */
  scenes?: number;
  /** First scene's number, for splitting a sweep; default 0. */
  firstScene?: number;
  /**
   * How amplitudes change from snapshot to snapshot: a new phase for each target (default), a new
   * complex normal amplitude (the model of the stochastic bound), or one new phase for all.
   */
  fluctuation?: 'random-phase' | 'complex-normal' | 'coherent';
  imperfections?: Imperfections;
  seed: number | bigint;
}

export interface TrueTarget {
  azimuthDeg: number;
  elevationDeg: number;
  powerDb: number;
  /** Phase of the first snapshot, unless amplitudes are complex normal. */
  phaseDeg?: number;
}

export interface SnapshotResult extends ComplexData {
  /** scenes x elements x snapshots. */
  data: Float64Array;
  shape: [scenes: number, elements: number, snapshots: number];
  /** Targets of each scene. */
  truth: TrueTarget[][];
}

export interface CubeTarget {
  rangeM: number;
  rateMps?: number;
  azimuthDeg?: number;
  elevationDeg?: number;
  /** Power of one raw sample at one element, dB. Default 0. */
  powerDb?: number;
  /** Phase of the reflection; drawn from the seed if absent. */
  phaseDeg?: number;
}

export interface CubeOptions {
  waveform: Waveform;
  array: ArrayInput;
  targets: readonly CubeTarget[];
  /** Power of a 0 dB target over noise power, both per raw sample. */
  snrDb: number;
  frames?: number;
  /** Spherical wavefronts instead of plane ones. */
  nearField?: boolean;
  imperfections?: Imperfections;
  seed: number | bigint;
}

/** frames x loops x transmitters x receivers x samples. */
export interface CubeResult extends ComplexData {
  data: Float32Array;
  shape: [frames: number, loops: number, transmitters: number, receivers: number, samples: number];
}
