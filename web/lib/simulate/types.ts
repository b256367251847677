/** Simulated snapshots, data cubes and frames of a street. */
import type { ArrayInput, SceneSampling, StreetOptions, Waveform } from '../types.js';

export interface Imperfections {
  /** Standard deviations drawn from the seed. */
  gainDb?: number;
  phaseDeg?: number;
  /** Along y, half wavelengths. */
  position?: number;
  /** Coupling of elements half a wavelength apart, dB; absent for none. */
  couplingDb?: number;
  seed?: number | bigint;
}

export interface SnapshotTarget {
  azimuthDeg: number;
  elevationDeg?: number;
  /** Power at one element, dB. Default 0. */
  powerDb?: number;
  /** Phase of the first snapshot; random if absent. */
  phaseDeg?: number;
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

export interface SimulateStreetOptions extends StreetOptions {
  /** Name of the radar. */
  radar: string;
}
