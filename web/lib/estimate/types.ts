/** Estimators, alone and over batches; source counting and bounds. */
import type { Method, SharedEstimatorOptions } from '../generated/options.js';
import type { ArrayInput, ComplexData, Warning } from '../types.js';

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
