/**
 * Options and results of the package. Angles are in degrees, all else in SI units; the unit is in
 * the name. Azimuth is positive to the left of boresight, range rate positive when receding.
 */
import type { Method, SharedEstimatorOptions } from './generated/options.js';

export type * from './calibrate/types.js';
export type * from './capture/types.js';
export type * from './drive/types.js';
export type * from './generated/options.js';
export type * from './image/types.js';
export type * from './neural/types.js';
export type * from './simulate/types.js';

/** Interleaved [re, im] numbers in C order with their shape (complex numbers, not floats). */
export interface ComplexData {
  data: Float32Array | Float64Array;
  shape: readonly number[];
}

/** Real numbers in C order with their shape. */
export interface RealData {
  data: Float32Array | Float64Array;
  shape: readonly number[];
}

/** Antenna position in half wavelengths: x forward, y left, z up. */
export type Position = readonly [x: number, y: number, z: number];

/** A preset's name (`lrr48`, `awr1642`, `awr1843`, `cascade86`, `ula8` for any N) or positions. */
export type ArrayInput =
  | string
  | { positions: readonly Position[] }
  | { tx: readonly Position[]; rx: readonly Position[]; withoutDuplicates?: boolean };

export interface ArrayGeometry {
  positions: Position[];
  tx: Position[];
  rx: Position[];
  /** Transmitter and receiver of each element. */
  channels: { tx: number; rx: number }[];
  /** Length along y, half wavelengths. */
  aperture: number;
  extent: 'point' | 'azimuth' | 'line' | 'area';
  uniform: boolean;
  /** Half width of the sector without grating lobes; 90 when there is none. */
  unambiguousDeg: number;
  /** Where the beam at boresight has its first null: from there on two equal targets are told apart; 90 when there is none. */
  resolutionDeg: number;
}

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

/** What a method needs and gives. */
export interface MethodInfo {
  name: Method;
  title: string;
  reference: string;
  minSnapshots: number;
  maxSnapshots: number | null;
  takesCovariance: boolean;
  uniformArray: boolean;
  lattice: boolean;
  elevation: boolean;
  sourceCount: boolean;
  spectrum: boolean;
  cost: string;
  /** Whether a network estimates: `boresight/neural`, or a pool with a network loaded. */
  network: boolean;
}

/** Why a method cannot work on an array, or on so many snapshots of it. */
export type Unsuited = 'one-place' | 'uniform-array' | 'grid' | 'elevation' | 'few-snapshots' | 'many-snapshots';

/** An estimator: its method, the array it works on, and its options. */
export interface EstimatorOptions extends SharedEstimatorOptions {
  method: Method;
  array: ArrayInput;
}

/** Snapshots (elements x snapshots, or a vector of elements) or a covariance. */
export type EstimateInput = { snapshots: ComplexData } | { covariance: ComplexData; snapshotCount: number };

/** Something to know of a result; not an error. */
export interface Warning {
  /** A stable name for programs. */
  code: string;
  message: string;
}

export interface Source {
  azimuthDeg: number;
  elevationDeg: number;
  powerDb: number;
  /** How sure a network is of it, from 0 to 1; absent from other methods. */
  confidence?: number;
  /** Complex amplitude at the array's origin, where one snapshot determines it. */
  amplitude?: readonly [re: number, im: number];
}

export interface Spectrum {
  azimuthDeg: Float64Array;
  /** One zero where the array sees azimuth only. */
  elevationDeg: Float64Array;
  /** Elevation-major, dB. */
  valuesDb: Float64Array;
  kind: 'power' | 'pseudo';
}

export interface Estimate {
  method: Method;
  /** Strongest first. */
  sources: Source[];
  spectrum?: Spectrum;
  resolved: boolean;
  iterations: number;
  warnings: Warning[];
}

/** Snapshots of many cells: [cells, elements] or [cells, elements, snapshots]. */
export interface BatchInput {
  snapshots: ComplexData;
}

export interface BatchOptions {
  /** Whether spectra are kept, of methods that have them. Default false. */
  spectra?: boolean;
}

/** The estimates of many cells, flat: numbers of each source, those of a cell together, strongest first. */
export interface BatchEstimate {
  method: Method;
  cells: number;
  /** The index of each source's cell. */
  cell: Uint32Array;
  azimuthDeg: Float64Array;
  elevationDeg: Float64Array;
  powerDb: Float64Array;
  spectra?: BatchSpectra;
  /** Cells in which not all sources asked for or counted were found. */
  unresolved: number;
  /** Each kind once. */
  warnings: BatchWarning[];
}

export interface BatchSpectra {
  azimuthDeg: Float64Array;
  /** One zero where the array sees azimuth only. */
  elevationDeg: Float64Array;
  /** Linear. */
  power: Float32Array;
  /** Elevations are an axis where there are several. */
  shape: [cells: number, azimuths: number] | [cells: number, elevations: number, azimuths: number];
  kind: 'power' | 'pseudo';
}

/** A warning of the first cell that has one of its kind. */
export interface BatchWarning extends Warning {
  /** Number of cells that have one. */
  cells: number;
}

export interface CountOptions {
  /** Default `mdl`. */
  criterion?: 'aic' | 'mdl';
  /** Average the covariance with its reversal (evenly spaced arrays). */
  forwardBackward?: boolean;
}

export interface CountResult {
  count: number;
  /** Eigenvalues, largest first. */
  eigenvalues: Float64Array;
  /** Criterion for 0, 1, 2 ... sources. */
  criterion: Float64Array;
}

export interface BoundOptions {
  array: ArrayInput;
  /** Uncorrelated targets; their phases matter to the deterministic bound of one snapshot only. */
  targets: readonly { azimuthDeg: number; elevationDeg?: number; snrDb: number; phaseDeg?: number }[];
  snapshots: number;
  /** Default `deterministic`. */
  kind?: 'deterministic' | 'stochastic';
}

export interface Bound {
  /** Standard deviation of each target's azimuth; infinite where the data do not determine it. */
  azimuthDeg: Float64Array;
  /** Of each elevation; present where the array sees elevation. */
  elevationDeg?: Float64Array;
}

export interface Waveform {
  startFrequencyHz: number;
  slopeHzPerS: number;
  sampleRateHz: number;
  samples: number;
  adcStartS: number;
  chirpIntervalS: number;
  transmitters: number;
  loops: number;
  frameIntervalS: number;
}

/** Numbers engineers look for first. */
export interface WaveformSummary {
  bandwidthHz: number;
  centreFrequencyHz: number;
  wavelengthM: number;
  rangeResolutionM: number;
  maxRangeM: number;
  rateResolutionMps: number;
  maxRateMps: number;
  frameTimeS: number;
}

/** A binary file. */
export type BytesInput = Uint8Array | ArrayBuffer;

/** A text file: its text or its bytes. */
export type TextInput = string | Uint8Array | ArrayBuffer;

/** An array of a `.npy` file: `complex` data is interleaved, integers become `Float64Array`. */
export interface NpyArray extends RealData {
  kind: 'real' | 'complex';
}
