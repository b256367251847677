import type {
  BatchEstimate,
  BatchSpectra,
  ComplexData,
  CubeChainOptions,
  CubeResult,
  EstimatorOptions,
  FrameCounts,
  StreetOptions,
  Waveform,
} from '../types.js';

/** Where a radar sits in the car's frame (origin at the rear axle, x forward, y left) and which way it looks. */
export interface Mounting {
  xM: number;
  yM: number;
  /** Direction of boresight, counter-clockwise from the car's x. */
  yawDeg: number;
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

/** Detected cells of a frame, strongest first, with what estimators take. */
export interface FrameCells {
  /** Of each cell; interpolated between bins. */
  rangeM: Float64Array;
  rateMps: Float64Array;
  /** Power at one element, dB relative to full scale (1.0). */
  powerDb: Float64Array;
  /** Over the local noise estimate. */
  snrDb: Float64Array;
  rangeBin: Uint32Array;
  dopplerBin: Uint32Array;
  /** cells x elements; the Doppler phase of the transmitters' turns taken off. */
  snapshots: ComplexData;
  counts: FrameCounts;
}

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

/** Power over range and azimuth: what the cells' targets or spectra add up to. */
export interface RangeAzimuthMap {
  rangeM: Float64Array;
  azimuthDeg: Float64Array;
  /** ranges x azimuths, linear. */
  power: Float32Array;
  shape: [ranges: number, azimuths: number];
  /** What fell off the grid: how many targets (or points of spectra), and their power. */
  outside: { count: number; power: number };
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

/** Maps of one or several radars on the ground around the car. */
export interface BirdsEyeView {
  /** Middles of the cells. */
  xM: Float64Array;
  yM: Float64Array;
  /** x by y (y fastest), linear: the maximum over the radars that see the cell, 0 where none does. */
  power: Float32Array;
  /** 1 where a radar sees the cell. */
  seen: Uint8Array;
  /** Index of the radar whose power it is; -1 where none sees it. */
  radar: Int8Array;
  shape: [x: number, y: number];
  cellM: number;
  /** Of each radar. */
  mountings: Mounting[];
}

/**
 * What counts as the target itself: a circle, or as much of range and sine of azimuth to each side
 * as the radars cannot resolve (half widths).
 */
export type Gate = { gateM: number } | { rangeM: number; sine: number };

/** How much of an image is not where targets are. */
export interface SidelobeMeasure {
  /** Energy outside the gates over all energy, dB; -Infinity if there is none outside. */
  outsideDb: number;
  /** Strongest cell outside the gates over the strongest of all, dB. */
  peakOutsideDb: number;
  /** Share of the cells outside the gates that stand less than 40 dB below the strongest of all. */
  litOutside: number;
  /** Share of the targets in view in whose gate a cell stands less than 40 dB below the strongest of all. */
  litTargets: number;
  /** Targets in view. */
  targets: number;
  /** Share of the cells seen that lie in gates. */
  gated: number;
}

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
