/** Simulated snapshots, data cubes and frames of a street. */
import type { ArrayInput, ComplexData, Mounting, StreetOptions, Waveform } from '../types.js';

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

export type StreetKind = 'parked-car' | 'guard-rail' | 'wall' | 'pole' | 'pedestrian' | 'vehicle';

/** A point that scatters, in the car's frame. */
export interface StreetTarget {
  xM: number;
  yM: number;
  /** Over ground. */
  vxMps: number;
  vyMps: number;
  rcsDbsm: number;
  kind: StreetKind;
  /** Index of the outline it belongs to. */
  outline: number;
}

/** The shape of an object on the ground, for drawing; it also throws the shadows. */
export interface StreetOutline {
  kind: StreetKind;
  /** Corners, m: a polygon, two ends of a line, or one point. */
  xM: Float64Array;
  yM: Float64Array;
}

export interface StreetRadar {
  /** `right`, `front-right`, `front-left` or `left`: by the way it looks. */
  name: string;
  mounting: Mounting;
  /** A preset's name. */
  array: string;
  waveform: Waveform;
  /** Half width of what it sees. */
  fieldOfViewDeg: number;
}

export interface StreetScene {
  egoSpeedMps: number;
  radars: StreetRadar[];
  targets: StreetTarget[];
  outlines: StreetOutline[];
}

export interface SimulateStreetOptions extends StreetOptions {
  /** Name of the radar. */
  radar: string;
}

/** A point of the street as a radar sees it. */
export interface VisibleTarget {
  /** Index in the scene's targets. */
  target: number;
  rangeM: number;
  rateMps: number;
  azimuthDeg: number;
  /** Power of one raw sample at one element, dB. */
  powerDb: number;
}

/** One frame of one radar of the street. */
export interface SimulatedStreet {
  cube: CubeResult;
  radar: StreetRadar;
  /** The points in its field of view and in no deep shadow. */
  targets: VisibleTarget[];
}
