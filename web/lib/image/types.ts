/** Maps of range and azimuth, and bird's-eye views. */
import type {
  BatchEstimate,
  BatchSpectra,
  CubeChainOptions,
  EstimatorOptions,
  FrameCells,
  Mounting,
  RangeAzimuthMap,
} from '../types.js';

/** What an image needs of the estimates of a frame's cells: a batch of them, or anybody's own. */
export interface ImageEstimates {
  /** Of each source, the index of its cell. */
  cell: Uint32Array;
  azimuthDeg: Float64Array;
  powerDb: Float64Array;
  /** Of each source, 0 to 1; 1 where absent. */
  confidence?: Float64Array;
  /**
   * A pseudo-spectrum tells no power; its peak is given that of the cell. At several elevations the strongest counts.
   */
  spectra?: Pick<BatchSpectra, 'azimuthDeg' | 'power' | 'kind'>;
}

/** Angles of each cell as points, or the spectrum of each cell. */
export type ImageFrom = 'targets' | 'spectra';

/** Grid of a range-azimuth map. */
export interface MapGrid {
  /** First and last range. */
  rangeM: readonly [from: number, to: number];
  /** Points in range. */
  ranges: number;
  /** Half width of the field of view, at most 90. */
  fieldOfViewDeg: number;
  /** Points in azimuth, uniform in its sine. */
  azimuths: number;
}

export interface RangeAzimuthMapInput {
  cells: Pick<FrameCells, 'rangeM' | 'powerDb'>;
  estimates: ImageEstimates;
  from: ImageFrom;
  grid: MapGrid;
}

/** Grid of a bird's-eye view in the car's frame. */
export interface ViewGrid {
  /** Edges ahead (positive) and behind. */
  xM: readonly [from: number, to: number];
  /** Edges right (negative) and left. */
  yM: readonly [from: number, to: number];
  /** Width of a cell. */
  cellM: number;
}

export interface BirdsEyeViewInput {
  radars: readonly { map: RangeAzimuthMap; mounting: Mounting }[];
  grid: ViewGrid;
}

/**
 * What counts as the target itself: a circle, or as much of range and sine of azimuth to each side
 * as the radars cannot resolve (half widths).
 */
export type Gate = { gateM: number } | { rangeM: number; sine: number };

/** Options of the chain, of which `peakGrouping` is off here unless asked for: an image takes every detected cell. */
export interface ImageFrameOptions extends CubeChainOptions {
  /** Default `spectra` where the method of `angle` has them. */
  from?: ImageFrom;
  /** Default: the waveform's range bins, 512 azimuths over 60 deg to each side. */
  grid?: Partial<MapGrid>;
}

/** What {@link ImageFrameOptions} come to. */
export interface ImagePlan {
  estimator: EstimatorOptions;
  from: ImageFrom;
  grid: MapGrid;
}

/** The map of a frame and what it is made of. */
export interface ImageFrame {
  map: RangeAzimuthMap;
  cells: FrameCells;
  estimates: BatchEstimate;
}
