/** Maps of range and azimuth, and bird's-eye views. */
import type {
  BatchEstimate,
  BatchSpectra,
  CubeChainOptions,
  EstimatorOptions,
  FrameCells,
  ImageFrom,
  MapGrid,
  Mounting,
  RangeAzimuthMap,
  ViewGrid,
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

/** What a map of range and azimuth is made of. */
export interface RangeAzimuthMapInput {
  /** Range and power of each detected cell. */
  cells: Pick<FrameCells, 'rangeM' | 'powerDb'>;
  /** Targets and spectra of the cells. */
  estimates: ImageEstimates;
  /** Which of them are drawn. */
  from: ImageFrom;
  /** Ranges and azimuths of the map. */
  grid: MapGrid;
}

/** What a view of the ground is made of. */
export interface BirdsEyeViewInput {
  /** The map of each radar, and where in the car it sits. */
  radars: readonly { map: RangeAzimuthMap; mounting: Mounting }[];
  /** Extent and cells of the ground, in the car's frame. */
  grid: ViewGrid;
}

/**
 * What counts as the target itself: a circle, or as much of range and sine of azimuth to each side
 * as the radars cannot resolve (half widths).
 */
export type Gate = { gateM: number } | { rangeM: number; sine: number };

/**
 * Options of the chain, of which `peakGrouping` is off here unless asked for: an image takes every detected cell, and up
 * to 4096 of them.
 */
export interface ImageFrameOptions extends CubeChainOptions {
  /** Default `spectra` where the method of `angle` has them. */
  from?: ImageFrom;
  /** Default: the waveform's range bins, 512 azimuths over 60 deg to each side. */
  grid?: Partial<MapGrid>;
}

/** What {@link ImageFrameOptions} come to. */
export interface ImagePlan {
  /** Of the chain that finds the cells. */
  chain: CubeChainOptions;
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
