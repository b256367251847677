/**
 * Options and results of the package. Angles are in degrees, all else in SI units; the unit is in
 * the name. Azimuth is positive to the left of boresight, range rate positive when receding.
 */
export type * from './drive-types.js';
export type * from './image-types.js';

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

export type Method =
  | 'bartlett' | 'capon' | 'music' | 'single-snapshot-music' | 'root-music' | 'esprit'
  | 'min-norm' | 'iaa' | 'nomp' | 'maximum-likelihood' | 'sparse-bayesian';

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
}

export interface EstimatorOptions {
  method: Method;
  array: ArrayInput;
  /** Number of sources, or how to count them. Default `mdl`. */
  sources?: number | 'aic' | 'mdl';
  /** Half width of the field of view, default 90. */
  fieldOfViewDeg?: number;
  elevationFieldOfViewDeg?: number;
  /** Points of the azimuth grid over sin(azimuth) in [-1, 1), default 1024. */
  gridPoints?: number;
  elevationPoints?: number;
  forwardBackward?: boolean;
  /** Subarray length of spatial smoothing. */
  smoothing?: number;
  /** Diagonal loading as a share of the mean element power. */
  loading?: number;
  dynamicRangeDb?: number;
  maxPeaks?: number;
  esprit?: 'least-squares' | 'total-least-squares';
  iaa?: {
    iterations?: number;
    thresholding?: 'none' | 'hard' | 'soft';
    thresholdDb?: number;
    regularisation?: number;
    form?: 'auto' | 'fast' | 'dense';
    /** Single precision while that tells angles to 0.001 deg (`auto`, the default), or double throughout. */
    precision?: 'auto' | 'double';
  };
  nomp?: {
    falseAlarm?: number;
    noisePower?: number;
    oversampling?: number;
    singleRefinements?: number;
    cyclicRefinements?: number;
    maxSources?: number;
  };
  /**
   * Refine the sources on the matched model: those that noise explains are dropped, what stands out of the rest is added,
   * all are taken to the best fit by Gauss-Newton steps. With the false-alarm probability and noise power of `nomp`.
   */
  refine?: boolean;
  maxIterations?: number;
  tolerance?: number;
}

/** Snapshots (elements x snapshots, or a vector of elements) or a covariance. */
export type EstimateInput =
  | { snapshots: ComplexData }
  | { covariance: ComplexData; snapshotCount: number };

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
  targets:
    | readonly SnapshotTarget[]
    | SceneSampling;
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

export type WindowName = 'rectangular' | 'hann' | 'hamming' | 'blackman' | 'blackman-harris' | 'chebyshev' | 'taylor';
export type CfarKind = 'cell-averaging' | 'greatest-of' | 'smallest-of' | 'ordered-statistic';

export interface ChainOptions {
  /** Default: the preset whose virtual elements match the capture. */
  array?: ArrayInput;
  rangeWindow?: WindowName;
  dopplerWindow?: WindowName;
  /** Transform lengths as a multiple of the data's; powers of two. */
  rangePadding?: number;
  dopplerPadding?: number;
  staticClutterRemoval?: boolean;
  cfar?: {
    kind?: CfarKind;
    /** One-dimensional along range, along Doppler, or two-dimensional. */
    axes?: 'range' | 'doppler' | 'both';
    falseAlarm?: number;
    guardCells?: readonly [range: number, doppler: number];
    trainingCells?: readonly [range: number, doppler: number];
    /** Rank of the ordered statistic as a share of the training cells. */
    rank?: number;
  };
  peakGrouping?: boolean;
  /** Limits outside which detections are dropped (and counted). */
  region?: { rangeM?: readonly [number, number]; rateMps?: readonly [number, number]; azimuthDeg?: readonly [number, number] };
  /** Estimator for each detection's angle; its array is the chain's. */
  angle?: AngleOptions;
  maxDetections?: number;
}

/** Options of an estimator whose array is known; default method `bartlett`. */
export type AngleOptions = Omit<EstimatorOptions, 'array' | 'method'> & { method?: Method };

export interface CombineOptions extends ChainOptions {
  /** Default 0. */
  firstFrame?: number;
  /** Default all that are left. */
  frameCount?: number;
}

/** Options of the chain over a cube, of which nothing else is known. */
export interface CubeChainOptions extends ChainOptions {
  waveform: Waveform;
  array: ArrayInput;
}

/** A cell of the range-Doppler map. */
export interface Cell {
  rangeBin: number;
  dopplerBin: number;
  /** One frame, for one snapshot; else one snapshot of each frame. */
  frame?: number;
}

export interface Detection {
  frame: number;
  rangeM: number;
  rateMps: number;
  azimuthDeg: number;
  elevationDeg: number;
  /** Power at one element, dB relative to full scale (1.0). */
  powerDb: number;
  /** Over the local noise estimate. */
  snrDb: number;
  rangeBin: number;
  dopplerBin: number;
}

/** What became of cells and samples. */
export interface FrameCounts {
  cellsOverThreshold: number;
  /** Of these, cells grouped under a stronger neighbour. */
  grouped: number;
  outsideRegion: number;
  beyondLimit: number;
  /** Cells in which the method found no angle. */
  withoutAngle: number;
  /** Samples at an end of the converter's range. */
  clippedSamples: number;
}

export interface FrameResult {
  /** The first one where frames were combined. */
  frame: number;
  /** Frames that went in. */
  frames: number;
  rangeM: Float64Array;
  rateMps: Float64Array;
  /** Mean over channels, Doppler summed, dB. */
  rangeProfileDb: Float64Array;
  /** range x Doppler, dB, mean over channels. */
  rangeDopplerDb: Float32Array;
  shape: [range: number, doppler: number];
  detections: Detection[];
  counts: FrameCounts;
  warnings: Warning[];
}

/** A binary file. */
export type BytesInput = Uint8Array | ArrayBuffer;

/** A text file: its text or its bytes. */
export type TextInput = string | Uint8Array | ArrayBuffer;

export interface RadarConfig {
  waveform: Waveform;
  summary: WaveformSummary;
  /** Number of receivers and of transmitters in use. */
  receivers: number;
  transmitters: number;
  /** Their numbers on the chip, from 0; transmitters in order of transmission. */
  receiverNumbers: number[];
  transmitterNumbers: number[];
  /** Preset that fits the platform and channels, if there is one. */
  array: string | null;
  platform: string | null;
  sdkVersion: string | null;
  sampleBits: number;
  /** Bytes of one frame of raw samples. */
  frameBytes: number;
  /** Frames to record; null until stopped. */
  frames: number | null;
  /** Lines that were not understood, and other remarks. */
  warnings: Warning[];
}

export interface CaptureInfo {
  config: RadarConfig;
  frames: number;
  /** Bytes after the last whole frame. */
  trailingBytes: number;
  /** Virtual array of the configured channels; null for a platform that is not known. */
  array: ArrayGeometry | null;
  warnings: Warning[];
}

/** An object the board itself detected. */
export interface BoardObject {
  rangeM: number;
  /** Null where the packet holds a Doppler bin only and no configuration tells its width. */
  rateMps: number | null;
  azimuthDeg: number;
  elevationDeg: number;
  /** Forward, left and up. */
  xM: number;
  yM: number;
  zM: number;
  /** As sent by SDK 1 and 2. */
  rangeBin?: number;
  dopplerBin?: number;
  peak?: number;
  /** As sent by SDK 3. */
  snrDb?: number;
}

export interface BoardFrame {
  frameNumber: number;
  platform: string;
  sdkVersion: string;
  objects: BoardObject[];
  /** Range profile at zero Doppler as sent, where present. */
  rangeProfileDb?: Float64Array;
  noiseProfileDb?: Float64Array;
  /** False for a packet the end of the input cut. */
  complete: boolean;
}

/** What was lost of a board's output. */
export interface BoardLogCounts {
  /** Bytes that belong to no packet. */
  skippedBytes: number;
  /** Packets that were cut or damaged. */
  damagedPackets: number;
  warnings: Warning[];
}

export interface BoardLog extends BoardLogCounts {
  frames: BoardFrame[];
}

/** An array of a `.npy` file: `complex` data is interleaved, integers become `Float64Array`. */
export interface NpyArray extends RealData {
  kind: 'real' | 'complex';
}

/** How a mounting angle is estimated. */
export type CalibrationMethod =
  | 'weighted-mean' | 'kabsch' | 'least-squares' | 'orthogonal-distance' | 'recursive';

/** How the radar's own motion is estimated; the recursive method has `tracked` alone. */
export type MotionMethod = 'ransac' | 'weighted-least-squares' | 'orthogonal-distance' | 'tracked';

export interface CalibrationMethodInfo {
  name: CalibrationMethod;
  title: string;
  reference: string;
}

/** The car's frame is centred on the rear axle, x forward, y left; angles are positive to the left. */
export interface CalibrationOptions {
  method: CalibrationMethod;
  /** Default: the one that belongs to the method. */
  motion?: MotionMethod;
  /** The radar's place ahead of the rear axle. */
  xM: number;
  /** Left of the centre line, default 0. */
  yM?: number;
  /** The angle the radar should be mounted at: where the search begins, and what the alarm compares with. */
  nominalDeg?: number;
  /** How far from nominal is a misalignment. */
  alarmDeg?: number;
  /** Standard deviation below which the estimate may count as converged. */
  convergedDeg?: number;
  /** Standard deviations of a detection. */
  rangeRateSigmaMps?: number;
  azimuthSigmaDeg?: number;
  /** Frames slower than this are left out. */
  minSpeedMps?: number;
  /** Frames turning faster than this are left out. */
  maxYawRateDegps?: number;
  /** Residual below which RANSAC takes a detection as static. */
  inlierResidualMps?: number;
  /** Weight from which a detection counts as static. */
  inlierThreshold?: number;
  /** Frames with a smaller share of static detections are left out. */
  inlierRatioThreshold?: number;
  minInliers?: number;
  /** Probability that RANSAC draws a pair of static detections. */
  confidence?: number;
  seed?: number | bigint;
}

/** One radar frame with the car's motion at that time; arrays have a number for each detection. */
export interface CalibrationFrame {
  /** Must not run backwards. */
  timeS: number;
  /** In the radar's frame. */
  azimuthDeg: Float32Array | Float64Array;
  /** Not compensated for the car's motion. */
  rangeRateMps: Float32Array | Float64Array;
  rangeM?: Float32Array | Float64Array;
  /** As measured; null where there is none at this time. */
  yawRateDegps: number | null;
  /** Forward speed of the rear axle, for the method that needs it. */
  speedMps?: number | null;
}

/** The radar's own motion in its own frame, from one frame. */
export interface RadarMotion {
  velocityMps: [x: number, y: number];
  covariance: [[xx: number, xy: number], [xy: number, yy: number]];
  /** Detections taken as static, and all. */
  inliers: number;
  detections: number;
}

/** What became of a frame. */
export interface FrameOutcome {
  verdict: 'used' | 'standing' | 'slow' | 'turning' | 'sparse' | 'without-motion';
  motion?: RadarMotion;
  /** The angle this frame alone gives, and its standard deviation. */
  angleDeg?: number;
  angleSigmaDeg?: number;
  /** Weight in the estimate, 1/rad^2; 0 if unused. */
  weight: number;
  /** For each detection the weight, 0 to 1, with which it was taken as static. */
  weights: Float32Array;
}

/** How many frames became what. */
export interface CalibrationCounts {
  given: number;
  used: number;
  standing: number;
  slow: number;
  turning: number;
  sparse: number;
  withoutMotion: number;
}

/** A mounting angle and what it rests on. Standard deviations are infinite where the drive says nothing. */
export interface CalibrationResult {
  angleDeg: number;
  sigmaDeg: number;
  /** Of the yaw rate, measured over true; standard deviation 0 where it was not estimated. */
  scale: number;
  scaleSigma: number;
  /** Of the yaw rate. */
  biasDegps: number;
  biasSigmaDegps: number;
  /** Static detections over all, of the frames used. */
  inlierShare: number;
  frames: CalibrationCounts;
  /** The angle has settled. */
  converged: boolean;
  /** Whether it differs from nominal beyond limit and chance; null without a nominal angle. */
  misaligned: boolean | null;
  warnings: Warning[];
}
