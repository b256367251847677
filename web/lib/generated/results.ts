// Written by `npm run generate` from the descriptions in Rust; not edited by hand.
import type { CalibrationMethod, CfarOptions, DriveFormat, DriveScenario, MapGrid, Method } from './options.js';

/** Transmitter and receiver a virtual element comes from. */
export interface Channel {
  /** Index of the transmitter, in the order of transmission. */
  tx: number;
  /** Index of the receiver. */
  rx: number;
}

/**
 * Which angles an array can tell apart.
 *
 * - `point`: All elements at one point: no angle at all.
 * - `azimuth`: Elements spread along y alone: azimuth.
 * - `line`: Elements on one line that is not the y axis: the angle to that line only.
 * - `area`: Elements spread over an area or a volume: azimuth and elevation.
 */
export type Extent = 'point' | 'azimuth' | 'line' | 'area';

/** Where the elements of an array are, and what follows from that. */
export interface ArrayGeometry {
  /** Elements, half wavelengths: x forward, y left, z up. */
  positions: [number, number, number][];
  /** Transmitters, half wavelengths. */
  tx: [number, number, number][];
  /** Receivers, half wavelengths. */
  rx: [number, number, number][];
  /** Transmitter and receiver of each element. */
  channels: Channel[];
  /** Length along y, half wavelengths. */
  aperture: number;
  /** Which angles it can tell apart. */
  extent: Extent;
  /** Whether the elements are evenly spaced along y, in order. */
  uniform: boolean;
  /** Half width of the sector without grating lobes; 90 deg where there are none. */
  unambiguousDeg: number;
  /**
   * Where the beam at boresight has its first null: from there on two equal targets are told apart; 90 deg where it
   * has none.
   */
  resolutionDeg: number;
}

/**
 * What the receivers' converters give.
 *
 * - `complex`: I and Q: beat frequencies from zero to the sample rate are told apart.
 * - `real`: I alone: beat frequencies from zero to half the sample rate. The spectrum is the same, mirrored, at
 * negative ones, so that a target has half the signal-to-noise ratio in its bin that complex samples give.
 */
export type Sampling = 'complex' | 'real';

/**
 * How transmitters share the chirps.
 *
 * - `time-division`: One transmitter a chirp, in turn.
 * - `binary-phase`: All transmitters in each chirp, with the signs of a Hadamard matrix over the chirps of a loop;
 * transmitters are a power of two.
 * - `doppler-division`: All transmitters in each chirp, each with its own phase step from chirp to chirp, which moves
 * it to its own band of Doppler frequencies; a loop is one chirp.
 */
export type Multiplexing = 'time-division' | 'binary-phase' | 'doppler-division';

/**
 * Timing and frequency plan of one frame: `loops` times through the chirps of a loop, which the transmitters share as
 * `multiplexing` says, `samples` samples a chirp.
 */
export interface Waveform {
  /** Frequency at the start of the ramp, Hz. */
  startFrequencyHz: number;
  /** Slope of the ramp, Hz per second. */
  slopeHzPerS: number;
  /** Sample rate, Hz. */
  sampleRateHz: number;
  /** Whether samples are complex or real. */
  sampling: Sampling;
  /** Samples a chirp; an even number of real ones. */
  samples: number;
  /** Time from the start of the ramp to the first sample, s. */
  adcStartS: number;
  /** Time from the start of one chirp to the start of the next, s. */
  chirpIntervalS: number;
  /** Number of transmitters. */
  transmitters: number;
  /** Loops in a frame: how often each transmitter's turn comes, or, in Doppler division, chirps. */
  loops: number;
  /** Time from the start of one frame to the start of the next, s. */
  frameIntervalS: number;
  /** How the transmitters share the chirps. */
  multiplexing?: Multiplexing;
  /**
   * Doppler bands of Doppler division, more than transmitters, so that some are empty and tell which band is whose;
   * half as many more as transmitters if absent.
   */
  dopplerBands?: number;
}

/** What follows from a waveform: the numbers engineers look for first. */
export interface WaveformSummary {
  /** Bandwidth swept while samples are taken. */
  bandwidthHz: number;
  /** Frequency in the middle of the samples. */
  centreFrequencyHz: number;
  /** Wavelength at the centre frequency. */
  wavelengthM: number;
  /** Range resolution. */
  rangeResolutionM: number;
  /** Largest unambiguous range. */
  maxRangeM: number;
  /** Range-rate resolution. */
  rateResolutionMps: number;
  /** Largest unambiguous range rate of either sign. */
  maxRateMps: number;
  /** Time over which the chirps of a frame are sent. */
  frameTimeS: number;
}

/** What a method needs and gives. */
export interface MethodInfo {
  /** Its name. */
  name: Method;
  /** Name for people. */
  title: string;
  /** Where it was published. */
  reference: string;
  /** Fewest snapshots it is of use with (after smoothing where that applies). */
  minSnapshots: number;
  /** Most snapshots it takes, if there is a limit. */
  maxSnapshots: number | null;
  /** Whether a covariance will do. */
  takesCovariance: boolean;
  /** Whether the elements must be evenly spaced on a line along y. */
  uniformArray: boolean;
  /** Whether the elements must stand on a grid along y (gaps allowed). */
  lattice: boolean;
  /** Whether it also estimates elevation on arrays that span an area. */
  elevation: boolean;
  /** Whether the number of sources must be given or counted beforehand. */
  sourceCount: boolean;
  /** Whether it returns a spectrum over angle. */
  spectrum: boolean;
  /** Whether it is a trained network, which needs a model's file. */
  network: boolean;
  /** Operation count of one estimate, in words. */
  cost: string;
}

/**
 * Why a method cannot work on an array, or on so many snapshots of it.
 *
 * - `one-place`: All elements are at one place along y, so no azimuth can be told.
 * - `uniform-array`: It needs elements evenly spaced along y, in order.
 * - `grid`: It needs elements on a grid along y.
 * - `no-neighbours`: It needs elements on neighbouring places of the grid.
 * - `elevation`: It tells no elevation, and the array spans an area.
 * - `few-snapshots`: It needs more snapshots, averaging or smoothing.
 * - `many-snapshots`: It takes fewer snapshots.
 */
export type Unsuited =
  | 'one-place'
  | 'uniform-array'
  | 'grid'
  | 'no-neighbours'
  | 'elevation'
  | 'few-snapshots'
  | 'many-snapshots';

/** Standard deviations of what is told of a source. */
export interface SourceDeviation {
  /** Of the azimuth. */
  azimuthDeg: number;
  /** Of the power. */
  powerDb: number;
}

/** One source found. */
export interface Source {
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg: number;
  /** Its power at one element. */
  powerDb: number;
  /** Its complex amplitude at the array's origin, where a single snapshot determines it. */
  amplitude?: readonly [re: number, im: number];
  /** How sure a network is of it, from 0 to 1; absent from other methods. */
  confidence?: number;
  /** Standard deviations that a network states of its answer; absent where the method states none. */
  deviation?: SourceDeviation;
}

/**
 * What the values of a spectrum mean.
 *
 * - `power`: Power at one element.
 * - `pseudo`: A pseudo-spectrum: its peaks tell angles, its height no power.
 */
export type SpectrumKind = 'power' | 'pseudo';

/** Values over a grid of angles. */
export interface Spectrum {
  /** Azimuths, ascending. */
  azimuthDeg: Float64Array;
  /** Elevations, ascending; one zero where the array sees azimuth only. */
  elevationDeg: Float64Array;
  /** Values, elevation-major: all azimuths of the first elevation, then those of the next. */
  valuesDb: Float64Array;
  /** What they mean. */
  kind: SpectrumKind;
}

/** Something to know of a result; not an error. */
export interface Warning {
  /** A stable name for programs, in kebab case. */
  code: string;
  /** What a reader should know. */
  message: string;
}

/** Result of an estimator. */
export interface Estimate {
  /** The method that made it. */
  method: Method;
  /** Sources, strongest first. */
  sources: Source[];
  /** The spectrum, from methods that have one. */
  spectrum?: Spectrum;
  /**
   * Whether all sources asked for or counted were found and each stands out of the noise: what it explains beside the
   * others is more than the strongest peak of noise would, with the false-alarm probability of `nomp`. Methods that
   * list what they find are resolved where one source stands out. False where the data cannot tell.
   */
  resolved: boolean;
  /** Iterations done, 0 for closed forms. */
  iterations: number;
  /** What a reader should know. */
  warnings: Warning[];
}

/** Spectra of many cells over the same angles. */
export interface BatchSpectra {
  /** Azimuths, ascending. */
  azimuthDeg: Float64Array;
  /** Elevations, ascending; one zero where the array sees azimuth only. */
  elevationDeg: Float64Array;
  /** Linear, the last axis of the shape fastest. */
  power: Float32Array;
  /** Cells, then elevations where there are several, then azimuths. */
  shape: [cells: number, azimuths: number] | [cells: number, elevations: number, azimuths: number];
  /** What the values mean. */
  kind: SpectrumKind;
}

/** A kind of warning, told by the first cell that has one. */
export interface BatchWarning {
  /** A stable name for programs, in kebab case. */
  code: string;
  /** What a reader should know. */
  message: string;
  /** Number of cells it holds for. */
  cells: number;
}

/** The estimates of many cells, flat: numbers of each source, those of a cell together, strongest first. */
export interface BatchEstimate {
  /** The method that made them. */
  method: Method;
  /** Number of cells. */
  cells: number;
  /** The index of each source's cell, ascending. */
  cell: Uint32Array;
  /** Azimuth of each source. */
  azimuthDeg: Float64Array;
  /** Elevation of each source. */
  elevationDeg: Float64Array;
  /** Power of each source at one element. */
  powerDb: Float64Array;
  /** How sure a network is of each source, from 0 to 1; absent from other methods. */
  confidence?: Float64Array;
  /** Standard deviation that a network states of each azimuth; absent where the method states none. */
  azimuthDeviationDeg?: Float64Array;
  /** The same of each power. */
  powerDeviationDb?: Float64Array;
  /** The spectra, where they were asked for and the method has them. */
  spectra?: BatchSpectra;
  /** Cells in which not all sources asked for or counted were found. */
  unresolved: number;
  /** Each kind once. */
  warnings: BatchWarning[];
}

/** How many sources there are, and why. */
export interface CountResult {
  /** Number of sources. */
  count: number;
  /** Eigenvalues of the covariance, largest first. */
  eigenvalues: Float64Array;
  /**
   * For 0, 1, 2, ... sources: the information criterion, smallest at their number, or the largest eigenvalue left over
   * the level of the largest-root test, above 1 for a source. Empty where nothing can be tested: of a single snapshot.
   */
  criterion: Float64Array;
}

/** Lower bound of the error of unbiased estimators. */
export interface Bound {
  /** Standard deviation of each source's azimuth; infinite where the data do not determine the angles. */
  azimuthDeg: Float64Array;
  /** Of each elevation; absent where the array sees none. */
  elevationDeg?: Float64Array;
}

/** Interleaved [re, im] numbers in C order with their shape (complex numbers, not floats). */
export interface ComplexArray {
  /** Real and imaginary parts, one after the other. */
  data: Float64Array;
  /** Lengths of the axes. */
  shape: number[];
}

/** A cube as results carry it. */
export interface CubeResult {
  /** Real and imaginary parts, one after the other. */
  data: Float32Array;
  /** Lengths of the axes. */
  shape: [frames: number, loops: number, chirps: number, receivers: number, samples: number];
}

/** Something that reflects. */
export interface TrueTarget {
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg: number;
  /** Its power at one element, `20 log10` of its amplitude (-300 to 300 dB). */
  powerDb: number;
  /** Phase of its amplitude in the first snapshot; drawn uniformly if absent. Complex normal amplitudes have none. */
  phaseDeg?: number;
  /**
   * Distance from the array's origin: its wave is spherical, with the paths of each transmitter and receiver, and
   * equally strong at all elements. Without it the wave is plane (0.001 to 1000000000 m).
   */
  rangeM?: number;
}

/** Snapshots of several scenes. */
export interface SnapshotResult {
  /** Scenes x elements x snapshots: real and imaginary parts, one after the other. */
  data: Float64Array;
  /** Lengths of the axes. */
  shape: [scenes: number, elements: number, snapshots: number];
  /** Targets of each scene, with their phase in the first snapshot where they have one. */
  truth: TrueTarget[][];
}

/** Where a radar sits in the car's frame and which way it looks. */
export interface Mounting {
  /** Ahead of the rear axle. */
  xM: number;
  /** Left of the centre line. */
  yM: number;
  /** Direction of boresight, counter-clockwise from the car's x. */
  yawDeg: number;
}

/** A radar on the car. */
export interface StreetRadar {
  /** `right`, `front-right`, `front-left`, `left` or `rear`: by the way it looks. */
  name: string;
  /** Its place and direction. */
  mounting: Mounting;
  /** The preset of its array. */
  array: string;
  /** Its waveform. */
  waveform: Waveform;
  /** Half width of what it sees. */
  fieldOfViewDeg: number;
}

/**
 * What a point belongs to.
 *
 * - `parked-car`: A car at the kerb.
 * - `guard-rail`: A rail on posts, over which radars see.
 * - `wall`: House fronts.
 * - `pole`: A lamp post or a tree.
 * - `pedestrian`: Somebody on foot.
 * - `vehicle`: A car that drives.
 */
export type StreetKind = 'parked-car' | 'guard-rail' | 'wall' | 'pole' | 'pedestrian' | 'vehicle';

/** A point that scatters, in the car's frame. */
export interface StreetTarget {
  /** Ahead of the rear axle. */
  xM: number;
  /** Left of the centre line. */
  yM: number;
  /** Velocity ahead over ground. */
  vxMps: number;
  /** Velocity to the left over ground. */
  vyMps: number;
  /** Radar cross-section. */
  rcsDbsm: number;
  /** What it belongs to. */
  kind: StreetKind;
  /** Index of that thing's outline. */
  outline: number;
}

/** The shape of a thing on the ground. */
export interface StreetOutline {
  /** What it is. */
  kind: StreetKind;
  /** Ahead of the rear axle: corners of a polygon, the two ends of a line, or one point. */
  xM: Float64Array;
  /** Left of the centre line. */
  yM: Float64Array;
}

/** The street at the start of a frame. */
export interface StreetScene {
  /** The things in it come from stream 0 of this seed, the cube of radar `i` from one that stream `i + 1` gives. */
  seed: number;
  /**
   * Speed of the car along x. The faster it is, the farther Doppler tells apart what stands at one range in different
   * directions (-30 to 30 m/s).
   */
  egoSpeedMps: number;
  /** The car's radars, the four of the `RadarScenes` car as mounted there, and one that looks back. */
  radars: StreetRadar[];
  /** All points. */
  targets: StreetTarget[];
  /** All things. */
  outlines: StreetOutline[];
}

/** A point of the street as a radar sees it. */
export interface VisibleTarget {
  /** Index among the street's targets. */
  target: number;
  /** Distance from the array's origin at the start of the first chirp. */
  rangeM: number;
  /** Rate at which the range grows (-100000 to 100000 m/s). */
  rateMps: number;
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg: number;
  /** Power of one raw sample at one element (-200 to 200 dB). */
  powerDb: number;
  /** Phase of its reflection; drawn from the seed if absent. */
  phaseDeg?: number;
}

/** One frame of one radar of the street. */
export interface SimulatedStreet {
  /** Frames (one) x loops x transmitters x receivers x samples. */
  cube: CubeResult;
  /** The radar. */
  radar: StreetRadar;
  /** The points in its field of view and in no deep shadow. */
  targets: VisibleTarget[];
}

/**
 * How samples lie in the bytes of a capture, as little-endian 16-bit numbers.
 *
 * - `two-lane`: Two lanes (xWR16xx, xWR18xx, xWR64xx, xWR68xx): the receivers of a chirp one after another; complex
 * samples in pairs `I0 I1 Q0 Q1`.
 * - `four-lane`: Four lanes (xWR12xx, xWR14xx, xWR22xx): of each sample the four receivers, all I before all Q; lanes
 * of receivers that are off hold zeros.
 * - `cascade`: Four chips (MMWCAS-RF-EVM with MMWCAS-DSP-EVM), a file each: of each sample the four receivers, `I Q`
 * of each; the chips' frames in turn, as the reader of cascades puts them.
 */
export type Layout = 'two-lane' | 'four-lane' | 'cascade';

/** What a configuration says of the radar and its samples. */
export interface RadarConfig {
  /** Timing and frequency plan of a frame. */
  waveform: Waveform;
  /** What follows from it. */
  summary: WaveformSummary;
  /** Number of receivers in use. */
  receivers: number;
  /** Number of transmitters in use. */
  transmitters: number;
  /** Numbers of the receivers on the chip, from 0. */
  receiverNumbers: number[];
  /** Numbers of the transmitters on the chip, from 0, in order of transmission. */
  transmitterNumbers: number[];
  /** Preset that fits the platform and channels, if there is one. */
  array: string | null;
  /** Platform named in a comment, such as `xWR16xx`. */
  platform: string | null;
  /** Version of the board's software named in a comment, such as `02.00`. */
  sdkVersion: string | null;
  /** Bits of a sample. */
  sampleBits: number;
  /** Order of I and Q that samples are read with. */
  iqOrder: 'iq' | 'qi';
  /** Where samples stand in the bytes. */
  layout: Layout;
  /** Sub-frames of a frame; 1 for frames without. */
  subFrames: number;
  /** The one that waveform and transmitters are of, from 0. */
  subFrame: number;
  /** Bytes of one frame of raw samples, with all of its sub-frames. */
  frameBytes: number;
  /** Frames to record; null until stopped. */
  frames: number | null;
  /** Lines that were not understood, and other remarks. */
  warnings: Warning[];
}

/** The range bins around the strongest of a frame. */
export interface RegionOfInterest {
  /** The strongest range bin. */
  rangeBin: number;
  /** Bins x elements x chirps, with the power of raw samples: no window. */
  region: ComplexArray;
  /** Covariance of the region, elements x elements. */
  covariance: ComplexArray;
  /** The strongest bin alone, elements x chirps. */
  snapshots: ComplexArray;
  /** What the 3D-CNN takes of it: magnitude, real and imaginary part of each number of the region. */
  channels: Float32Array;
  /** What networks on the covariance take of it (the paper's equation 8). */
  features: Float32Array;
}

/** What is known of a capture before any processing. */
export interface CaptureInfo {
  /** Its configuration. */
  config: RadarConfig;
  /** Whole frames. */
  frames: number;
  /** Bytes after the last whole frame. */
  trailingBytes: number;
  /** Virtual array of the configured channels; null for a platform that is not known. */
  array: ArrayGeometry | null;
  /**
   * Power above the noise at positive beat frequencies over that at negative ones, as samples are read; null for real
   * samples, and for chirps that are too short or silent.
   */
  beatAsymmetryDb: number | null;
  /** Whether the samples tell that I and Q are the other way round than they are read; null where they tell nothing. */
  iqSwapped: boolean | null;
  /** What is odd about its size, its lanes, and the order of I and Q. */
  warnings: Warning[];
}

/** The files of a cascade as one capture. */
export interface CascadeCapture {
  /** Bytes that a capture is made of, with the same configuration. */
  bytes: Uint8Array;
  /** What was left out, and what of the indices does not fit. */
  warnings: Warning[];
}

/** The files of one recording. */
export interface RecordingParts {
  /** Indices of the files in order of time; of a cascade, in order of name. */
  order: number[];
  /** Whether they are the files of a cascade, which `joinCascade` joins. */
  cascade: boolean;
  /** Names of files that are missing between them. */
  missing: string[];
}

/** A target in one frame. */
export interface Detection {
  /** Frame, from 0; the first one where frames were combined. */
  frame: number;
  /** Range, interpolated between bins and corrected for the range rate. */
  rangeM: number;
  /** Range rate, positive when receding, interpolated between bins, in its fold. */
  rateMps: number;
  /** Azimuth, positive to the left. */
  azimuthDeg: number;
  /** Elevation, positive upwards; 0 where the array does not see it. */
  elevationDeg: number;
  /** Place forward of the sensor. */
  xM: number;
  /** Place to its left. */
  yM: number;
  /** Place above it; 0 where the array sees no elevation. */
  zM: number;
  /** Power of one raw sample at one element over full scale (1.0), interpolated between bins. */
  powerDb: number;
  /** Its power in its cell over the noise around the cell. */
  snrDb: number;
  /** Range bin. */
  rangeBin: number;
  /** Doppler bin. */
  dopplerBin: number;
  /**
   * Times twice the waveform's largest rate that the rate is beyond that of its bin: 0 where no other was tried, or
   * none is certain enough.
   */
  dopplerFold: number;
  /**
   * Probability of the likeliest fold among those tried; below 0.99 the rate keeps that of its bin. Absent where no
   * other was tried.
   */
  foldProbability?: number;
}

/** What became of cells and samples. */
export interface FrameCounts {
  /** Cells above their threshold. */
  cellsOverThreshold: number;
  /** Of these, cells grouped under a stronger neighbour. */
  grouped: number;
  /** Of these, echoes of stronger targets in other bands of Doppler division. */
  otherBands: number;
  /** Cells whose fold of the range rate is not certain; they keep that of their bin. */
  undecidedFolds: number;
  /**
   * Cells nearer than 4 range resolutions, where antennas couple, or beyond 0.9 of the unambiguous range, where
   * filters attenuate; none where the region names a range.
   */
  outsideUsableRange: number;
  /** Cells and detections outside the region. */
  outsideRegion: number;
  /** Cells and detections beyond the most to report. */
  beyondLimit: number;
  /** Cells in which the method found no angle. */
  withoutAngle: number;
  /** Samples at an end of the converter's range. */
  clippedSamples: number;
}

/** Result of one frame, or of several combined. */
export interface FrameResult {
  /** Frame, from 0; the first one where frames were combined. */
  frame: number;
  /** Frames that went in. */
  frames: number;
  /** Whether an array's calibration was applied. */
  calibrated: boolean;
  /** Range of each range bin. */
  rangeM: Float64Array;
  /** Range rate of each Doppler bin, ascending. */
  rateMps: Float64Array;
  /**
   * Largest range rate of either sign that detections tell from others: that of the Doppler bins, or more where folds
   * are told.
   */
  unambiguousRateMps: number;
  /** Power over range: mean over channels, sum over Doppler. */
  rangeProfileDb: Float64Array;
  /** Power over range and Doppler (Doppler fastest): mean over channels. */
  rangeDopplerDb: Float32Array;
  /** Range bins, then Doppler bins. */
  shape: [range: number, doppler: number];
  /** Detections, strongest first. */
  detections: Detection[];
  /** What became of cells and samples. */
  counts: FrameCounts;
  /** Remarks of the estimator, each kind once, and of the chain. */
  warnings: Warning[];
}

/** Detected cells of a frame, or of several combined, with what estimators take. */
export interface FrameCells {
  /** Range of each cell, interpolated between bins and corrected for the range rate. */
  rangeM: Float64Array;
  /** Range rate of each, positive when receding, interpolated between bins. */
  rateMps: Float64Array;
  /** Times twice the waveform's largest rate that each is beyond that of its bin. */
  dopplerFold: Int8Array;
  /** Power of each: one raw sample at one element over full scale (1.0). */
  powerDb: Float64Array;
  /** Over the noise around the cell. */
  snrDb: Float64Array;
  /** Range bin of each. */
  rangeBin: Uint32Array;
  /** Doppler bin of each. */
  dopplerBin: Uint32Array;
  /** Cells x elements (x frames where there are several), the transmitters' Doppler phase taken off. */
  snapshots: ComplexArray;
  /** What became of cells and samples. */
  counts: FrameCounts;
}

/**
 * What became of a cell.
 *
 * - `below-threshold`: Its power is not above its threshold.
 * - `grouped`: It is over its threshold beside a stronger one, whose peak it belongs to.
 * - `other-band`: It is the echo of a stronger target in another Doppler band, in Doppler division.
 * - `outside-range`: Its range is outside the limits.
 * - `outside-rate`: Its range rate is outside the limits.
 * - `beyond-limit`: More cells than are kept are stronger.
 * - `without-angle`: The method found no angle in it.
 * - `outside-direction`: No direction found in it is within the limits.
 * - `kept`: It is a detection.
 */
export type CellVerdict =
  | 'below-threshold'
  | 'grouped'
  | 'other-band'
  | 'outside-range'
  | 'outside-rate'
  | 'beyond-limit'
  | 'without-angle'
  | 'outside-direction'
  | 'kept';

/** What a cell was held against, and what became of it. */
export interface CellExplanation {
  /** Range bin. */
  rangeBin: number;
  /** Doppler bin. */
  dopplerBin: number;
  /** What became of it. */
  verdict: CellVerdict;
  /** The same in a sentence, with figures. */
  message: string;
  /** Its power: mean over channels, as in the map. */
  powerDb: number;
  /** Noise power estimated from its training cells. */
  noiseDb: number;
  /** Its threshold. */
  thresholdDb: number;
  /** Training cells around it. */
  trainingCells: number;
  /** Of these, cells left out of the noise as targets of their own. */
  excisedCells: number;
  /** Range bin of the peak that it belongs to: its own, or a stronger neighbour's. */
  peakRangeBin: number;
  /** Doppler bin of that peak. */
  peakDopplerBin: number;
  /** Thresholds along range at its Doppler bin. */
  profileThresholdDb: Float64Array;
}

/** A target in a region. */
export interface RegionTarget {
  /** Range of the bin in which it is strongest, interpolated and corrected for the range rate. */
  rangeM: number;
  /** Azimuth, positive to the left. */
  azimuthDeg: number;
  /** Power of one raw sample at one element over full scale (1.0), of all bins of the region. */
  powerDb: number;
  /** Probability of its direction, where a network gave it. */
  confidence?: number;
  /** Standard deviation of the range (Cramer-Rao bound), from joint estimation where the data determine it. */
  rangeDeviationM?: number;
  /** Standard deviation of the azimuth (Cramer-Rao bound), from joint estimation where the data determine it. */
  azimuthDeviationDeg?: number;
}

/** A region of the range spectrum with what was found in it. */
export interface TargetRegion {
  /** Its middle: the strongest range bin. */
  rangeBin: number;
  /** Range of its strongest peak, interpolated between bins and corrected for the range rate. */
  rangeM: number;
  /** Range rate of its strongest bin, positive when receding, from the phase between loops; taken off the region. */
  rateMps: number;
  /** Power of its strongest peak: one raw sample at one element over full scale (1.0). */
  powerDb: number;
  /** Over the noise around the peak. */
  snrDb: number;
  /** Peaks over range that belong to it. */
  peaks: number;
  /**
   * Direction of its echoes together, from the phase between neighbouring elements; of an array that is not evenly
   * spaced, by the conventional beamformer.
   */
  coarseAzimuthDeg: number;
  /** Whether it was turned so that this direction is boresight. */
  rotated: boolean;
  /** Targets counted. */
  sources: number;
  /** Probability of 0, 1 and 2 targets, each by itself; empty for joint estimation. */
  probability: Float64Array;
  /** Targets, strongest first. */
  targets: RegionTarget[];
}

/** What became of cells, peaks and targets. */
export interface RegionCounts {
  /** Range bins above their threshold. */
  cellsOverThreshold: number;
  /** Of these, bins grouped under a stronger neighbour. */
  grouped: number;
  /** Peaks and targets outside the limits. */
  outsideRegion: number;
  /** Peaks inside the region of a stronger one. */
  joined: number;
  /** Regions beyond the most to report. */
  beyondLimit: number;
  /** Regions in which no target was counted. */
  withoutTarget: number;
  /** Targets beyond 90 deg, which a turned region can give. */
  beyondHorizon: number;
  /** Samples at an end of the converter's range. */
  clippedSamples: number;
}

/** Regions of one frame. */
export interface RegionFrame {
  /** Frame, from 0. */
  frame: number;
  /** Range of each range bin. */
  rangeM: Float64Array;
  /** Power over range: mean over elements and chirps, of what detection saw. */
  rangeProfileDb: Float64Array;
  /** Regions, strongest peak first. */
  regions: TargetRegion[];
  /** What became of cells, peaks and targets. */
  counts: RegionCounts;
  /** Remarks of the estimators, each kind once. */
  warnings: Warning[];
}

/** What is known of one channel. */
export interface ChannelCalibration {
  /** Its gain over that of the plan (-100 to 100 dB). */
  gainDb: number;
  /** Its phase over that of the plan (-3600 to 3600 deg). */
  phaseDeg: number;
  /** Standard deviation of the gain; absent where it is not known. */
  gainStdDb?: number;
  /** Standard deviation of the phase; absent where it is not known. */
  phaseStdDeg?: number;
  /** Displacement, half wavelengths: x forward, y left, z up; none where absent (-1000 to 1000). */
  displacement?: [number, number, number];
  /** Standard deviation of each coordinate of it, half wavelengths. */
  displacementStd?: [number, number, number];
}

/**
 * How a calibration was found.
 *
 * - `given`: It was given by hand.
 * - `reflector`: From targets at known directions, such as corner reflectors.
 * - `self-calibration`: From strong cells with one target each at an unknown direction.
 * - `steering-table`: From a table of measured steering vectors.
 * - `board-configuration`: From the coefficients in a board's configuration.
 */
export type ArrayCalibrationMethod =
  | 'given'
  | 'reflector'
  | 'self-calibration'
  | 'steering-table'
  | 'board-configuration';

/**
 * What data may not determine.
 *
 * - `common-gain`: A gain common to all channels; it counts as power of the targets.
 * - `common-phase`: A phase common to all channels; it counts as phase of the targets.
 * - `direction`: A phase that rises linearly over the array: it turns all directions alike.
 * - `displacement`: Displacements that a target's phase or the phases of the channels make up for.
 * - `coupling`: Coupling between channels.
 * - `range-bias`: What ranges are too long by.
 */
export type NotIdentifiable = 'common-gain' | 'common-phase' | 'direction' | 'displacement' | 'coupling' | 'range-bias';

/**
 * Errors of an array's channels, and how well they are known. The response to a plane wave is `C diag(g exp(j phi))
 * a(p + d)`: gain `g`, phase `phi` and displacement `d` of each channel, and coupling `C`. [`Array::calibrated`] takes
 * them off snapshots.
 */
export interface ArrayCalibration {
  /** Transmitters as planned, half wavelengths: x forward, y left, z up. */
  tx: [number, number, number][];
  /** Receivers as planned, half wavelengths. */
  rx: [number, number, number][];
  /** One a pair of transmitter and receiver, all receivers of a transmitter after each other. */
  channels: ChannelCalibration[];
  /** Mutual coupling, channels x channels of [re, im]; none where absent. */
  coupling?: [number, number][][];
  /** What measured ranges are too long by (-1000 to 1000 m). */
  rangeBiasM: number;
  /** Standard deviation of that; absent where it was not measured. */
  rangeBiasStdM?: number;
  /** How it was found. */
  method: ArrayCalibrationMethod;
  /** What these data do not determine; there it stays with the plan. */
  notIdentifiable: NotIdentifiable[];
  /** Cells it was made from. */
  cells: number;
  /** Cells that were left out, since they do not hold one plane wave. */
  cellsLeftOut: number;
  /** Frames it was made from. */
  frames: number;
  /**
   * Power that is left of a single target's response once it is fitted, over that of the response. Estimators that are
   * given it as their mismatch do not take the rest for targets (-300 to 300 dB).
   */
  residualDb?: number;
  /** Root mean square of what is left of the phase in each channel and cell. */
  residualPhaseDeg?: number;
  /** Root mean square of what is left of the gain. */
  residualGainDb?: number;
}

/**
 * What became of a cell.
 *
 * - `used`: It was used.
 * - `weak`: Its target is too weak.
 * - `several-targets`: Its snapshots do not lie on one line: several targets with phases of their own.
 * - `does-not-fit`: One plane wave does not fit it under the errors that all cells share.
 */
export type CellUse = 'used' | 'weak' | 'several-targets' | 'does-not-fit';

/** A cell that was looked at. */
export interface CalibrationCell {
  /** Its range. */
  rangeM: number;
  /** Its range rate, positive when receding. */
  rateMps: number;
  /** Range bin. */
  rangeBin: number;
  /** Doppler bin. */
  dopplerBin: number;
  /** Power of its target in all snapshots over the noise of one. */
  snrDb: number;
  /** Azimuth, counter-clockwise from boresight (positive to the left) (-90 to 90 deg). */
  azimuthDeg: number;
  /** Elevation, positive upwards (-90 to 90 deg). */
  elevationDeg: number;
  /** Power left once one plane wave is fitted, over that of the cell. */
  residualDb: number;
  /** Whether it was used. */
  state: CellUse;
}

/** How far cells are from one plane wave each. */
export interface CheckFigures {
  /** Root mean square of the phase that is left. */
  residualPhaseDeg: number;
  /** Root mean square of the gain that is left. */
  residualGainDb: number;
  /** Power that is left over that of the cells. */
  residualDb: number;
  /** Highest sidelobe of the conventional beam over its peak, in the cell where it is highest. */
  sidelobeDb: number;
}

/** One cell. */
export interface CheckedCell {
  /** Its range. */
  rangeM: number;
  /** Range bin. */
  rangeBin: number;
  /** Doppler bin. */
  dopplerBin: number;
  /** Azimuth as the plan has it. */
  azimuthBeforeDeg: number;
  /** Azimuth once calibrated. */
  azimuthDeg: number;
  /** Elevation once calibrated; 0 where the array does not see it. */
  elevationDeg: number;
  /** As the plan has it. */
  before: CheckFigures;
  /** Once calibrated. */
  after: CheckFigures;
}

/** Cells of data not used, as the plan has them and once calibrated. */
export interface CalibrationCheck {
  /** Frames it was made from. */
  frames: number;
  /** Over all cells, as the plan has them. */
  before: CheckFigures;
  /** Once calibrated. */
  after: CheckFigures;
  /** The cells. */
  cells: CheckedCell[];
}

/** A calibration, and what it was made of. */
export interface ArrayCalibrationResult {
  /** The calibration. */
  calibration: ArrayCalibration;
  /** The cells, in the order they were given in. */
  cells: CalibrationCell[];
  /** How it does on data that it was not made from; absent where there are none. */
  check?: CalibrationCheck;
  /** Each cell under a calibration from the others; absent for fewer than three. */
  leftOut?: CheckFigures;
  /** What a reader should know. */
  warnings: Warning[];
}

/**
 * What of the estimates goes into an image.
 *
 * - `targets`: The sources found in each cell.
 * - `spectra`: The spectrum of each cell.
 */
export type ImageFrom = 'targets' | 'spectra';

/** How an image is made unless something else is asked for. */
export interface ImageDefaults {
  cfar: CfarOptions;
  peakGrouping: boolean;
  maxDetections: number;
  /** The method. */
  method: Method;
  /** What the chain makes of the method's own, so that a cell gives sources only. */
  dynamicRangeDb: number;
  /** The same. */
  loading: number;
  /** Spectra where the method has them. */
  from: ImageFrom;
  /** The waveform's range bins, and azimuths over the field of view. */
  grid: MapGrid;
}

/** What fell, in whole or in part, beside the grid. */
export interface OutsideGrid {
  /** Targets, or points of spectra. */
  count: number;
  /** Their power that is not in the image. */
  power: number;
}

/** Power over range and azimuth: what the cells' targets or spectra add up to. */
export interface RangeAzimuthMap {
  /** Ranges, ascending. */
  rangeM: Float64Array;
  /** Azimuths, ascending, evenly spaced in their sine. */
  azimuthDeg: Float64Array;
  /** Linear, azimuths fastest. */
  power: Float32Array;
  /** Ranges, then azimuths. */
  shape: [ranges: number, azimuths: number];
  /** What fell off the grid. */
  outside: OutsideGrid;
}

/** Maps of one or several radars on the ground around the car. */
export interface BirdsEyeView {
  /** Middles of the cells ahead. */
  xM: Float64Array;
  /** Middles of the cells to the left. */
  yM: Float64Array;
  /** Linear, y fastest: the maximum over the radars that see the cell, 0 where none does. */
  power: Float32Array;
  /** 1 where a radar sees the cell. */
  seen: Uint8Array;
  /** Index of the radar whose power it is; -1 where none sees it. */
  radar: Int8Array;
  /** Cells ahead, then cells to the left. */
  shape: [x: number, y: number];
  /** Width of a cell. */
  cellM: number;
  /** Of each radar. */
  mountings: Mounting[];
}

/** How much of a view is not where targets are. */
export interface SidelobeMeasure {
  /** Energy (the sum of powers) outside the gates over all energy; minus infinity if there is none outside. */
  outsideDb: number;
  /** Strongest cell outside the gates over the strongest of all. */
  peakOutsideDb: number;
  /** Share of the cells outside the gates that are lit: less than 40 dB below the strongest of all. */
  litOutside: number;
  /** Share of the targets in view with a lit cell in their gate. */
  litTargets: number;
  /** Targets in view. */
  targets: number;
  /** Share of the cells seen that lie in gates. */
  gated: number;
}

/** A method of mounting angles. */
export interface CalibrationMethodInfo {
  /** Its name. */
  name: CalibrationMethod;
  /** Name for people. */
  title: string;
  /** Where it was published. */
  reference: string;
}

/**
 * What became of a frame.
 *
 * - `used`: It went into the angle.
 * - `standing`: The car stood; it went into the bias of the yaw rate.
 * - `slow`: The radar moved more slowly than the gate.
 * - `turning`: The car turned faster than the gate.
 * - `sparse`: Too few detections or inliers for a motion, or too few frames yet for one that is smoothed over several.
 * - `off-speed`: What most detections agree on is not the car's own measured speed.
 * - `without-motion`: No yaw rate (or, for the full-velocity method, no speed) at this time.
 */
export type FrameVerdict = 'used' | 'standing' | 'slow' | 'turning' | 'sparse' | 'off-speed' | 'without-motion';

/** The radar's own motion, from one frame. */
export interface RadarMotion {
  /** Velocity ahead and to the left in the radar's frame. */
  velocityMps: [x: number, y: number];
  /** Its covariance `[[xx, xy], [xy, yy]]`, m^2/s^2. */
  covariance: [[xx: number, xy: number], [xy: number, yy: number]];
  /** Detections taken as static. */
  inliers: number;
  /** Detections given that a sensor can have measured. */
  detections: number;
}

/** What an estimator made of one frame. */
export interface FrameOutcome {
  /**
   * Time of what is told, the weights of detections aside: the frame's, or where motion is smoothed over several
   * frames that of an earlier one.
   */
  timeS: number;
  /** What became of it. */
  verdict: FrameVerdict;
  /** The radar's motion, if one could be found. */
  motion?: RadarMotion;
  /** The mounting angle this frame alone gives, if it gives one. */
  angleDeg?: number;
  /** Its standard deviation. */
  angleSigmaDeg?: number;
  /** Weight of the frame in the estimate, 1/rad^2; 0 if unused. */
  weight: number;
  /** For each detection the weight, 0 to 1, with which it was taken as static. */
  weights: Float32Array;
}

/** How many frames became what; every frame given is counted once. */
export interface CalibrationCounts {
  /** Frames given. */
  given: number;
  /** In the angle. */
  used: number;
  /** The car stood. */
  standing: number;
  /** Slower than the gate. */
  slow: number;
  /** Turning faster than the gate. */
  turning: number;
  /** Too few detections or inliers. */
  sparse: number;
  /** What agrees is not the car's own measured speed. */
  offSpeed: number;
  /** Without a yaw rate (or speed) at their time. */
  withoutMotion: number;
}

/**
 * Whether a radar is where it should be.
 *
 * - `aligned`: The angle lies within the alarm's limit of the nominal one, and three standard deviations more still
 * do.
 * - `misaligned`: The angle lies beyond the alarm's limit by more than three standard deviations.
 * - `undecided`: The drive does not tell yet.
 */
export type Alignment = 'aligned' | 'misaligned' | 'undecided';

/** A mounting angle and what it rests on. Standard deviations are infinite where the drive says nothing. */
export interface CalibrationResult {
  /** Mounting angle (yaw of boresight in the car's frame), within half a turn. */
  angleDeg: number;
  /** Its standard deviation. */
  sigmaDeg: number;
  /** Scale factor of the yaw rate (measured over true). */
  scale: number;
  /** Its standard deviation; 0 where it was not estimated. */
  scaleSigma: number;
  /** Bias of the yaw rate. */
  biasDegps: number;
  /** Its standard deviation; infinite where nothing is known of it. */
  biasSigmaDegps: number;
  /**
   * Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees; 0 where it was not
   * estimated.
   */
  slipGradientDeg: number;
  /** Its standard deviation; 0 where it was not estimated. */
  slipGradientSigmaDeg: number;
  /** How long before its time stamp a scan was measured; 0 where it was not estimated. */
  delayS: number;
  /** Its standard deviation; 0 where it was not estimated. */
  delaySigmaS: number;
  /** Scale factor of the car's measured speed (measured over the radar's); 1 where it was not estimated. */
  speedScale: number;
  /** Its standard deviation; 0 where it was not estimated. */
  speedScaleSigma: number;
  /** When the angle last changed by a knock, on the clock of the frames then. */
  changedS?: number;
  /** Static detections over all, of the frames used; 0 without any. */
  inlierShare: number;
  /** What became of the frames. */
  frames: CalibrationCounts;
  /** Time of the last accepted frame, on the clock of the frames; absent before the first frame of a session. */
  lastFrameS?: number;
  /** Whether the last five frames or more were rejected, so that the estimate says nothing of the present. */
  stale: boolean;
  /** Frames rejected for their time; they are not among those given. */
  rejectedFrames: number;
  /** Detections left out because no sensor measures their azimuth or range rate. */
  rejectedDetections: number;
  /** Sessions started because times jumped back. */
  clockResets: number;
  /**
   * The angle has settled: its standard deviation is below the limit of the options and it moved by no more than that
   * lately.
   */
  converged: boolean;
  /** Whether the angle differs from the nominal one beyond limit and chance; none without a nominal angle. */
  misaligned: boolean | null;
  /** Whether the radar is where it should be; none without a nominal angle. */
  alignment: Alignment | null;
  /** What to know of it. */
  warnings: Warning[];
}

/**
 * A way to drive for a minute.
 *
 * - `straight`: Straight on at 14 m/s.
 * - `speeds`: Straight on between 5 and 20 m/s.
 * - `stop`: Ten seconds of standstill, then straight on at 14 m/s.
 * - `turns`: Two turns to the left and two to the right, by 90 deg at 7 m/s.
 * - `bends`: Bends of alternating side at 14 m/s, by 6 deg/s.
 */
export type Manoeuvre = 'straight' | 'speeds' | 'stop' | 'turns' | 'bends';

/** What a minute of a manoeuvre would bring. */
export interface Forecast {
  /** How to drive. */
  manoeuvre: Manoeuvre;
  /** The same in words. */
  instruction: string;
  /** Standard deviation of the angle after a minute. */
  sigmaDeg: number;
  /**
   * Minutes of it until the angle is settled and, where there is a nominal one, the verdict stands; none where twenty
   * are too few.
   */
  minutes: number | null;
}

/** What driving on would bring. The angle is taken to stay as it is. */
export interface CalibrationOutlook {
  /** Standard deviation of the angle now. */
  sigmaDeg: number;
  /** Standard deviation with which it is settled and the verdict stands. */
  neededDeg: number;
  /** Standard deviation below which no drive brings it, at the share of static detections so far. */
  leastDeg: number;
  /** Manoeuvres, the one first that brings most. */
  forecasts: Forecast[];
  /** What to do, in a sentence. */
  advice: string;
}

/** Poses of the rear axle at times. */
export interface Trajectory {
  /** Time of each. */
  timeS: Float64Array;
  /** East, or x of the log's global frame. */
  xM: Float64Array;
  /** North, or y of the log's global frame. */
  yM: Float64Array;
  /** Heading, counter-clockwise from x. */
  yawDeg: Float64Array;
}

/** What became of the logs; every one is counted once. */
export interface FleetLogCounts {
  /** Logs of the plan, or without a plan those with a record. */
  planned: number;
  /** Calibrated. */
  done: number;
  /** Failed. */
  failed: number;
  /** Planned and without a record. */
  missing: number;
  /** Logs with a record that are not in the plan, left out. */
  foreign: number;
}

/** Logs that failed for one reason. */
export interface FleetFailureCount {
  /** Code of the error. */
  code: string;
  /** How many. */
  count: number;
  /** The message of the first, by path. */
  message: string;
  /** Its path. */
  path: string;
}

/** Unknowns of a car beside the angles, by the joint estimate; none of those that belong elsewhere. */
export interface FleetCarValues {
  /** Scale factor of the yaw rate (measured over true). */
  scale: number | null;
  /** Its standard deviation. */
  scaleSigma: number | null;
  /** Bias of the yaw rate. */
  biasDegps: number | null;
  /** Its standard deviation. */
  biasSigmaDegps: number | null;
  /** Slip angle of the rear axle over lateral acceleration, rad/(m/s^2), outside Rust in degrees. */
  slipGradientDeg: number | null;
  /** Its standard deviation. */
  slipGradientSigmaDeg: number | null;
  /** How long before its time stamp a scan was measured. */
  delayS: number | null;
  /** Its standard deviation. */
  delaySigmaS: number | null;
}

/** A drive of a vehicle. */
export interface FleetDrive {
  /** Its name. */
  name: string;
  /** Where the log was. */
  path: string;
  /** When it began, s since 1970, where that is known. */
  timeS: number | null;
  /** Its place in time: days since the vehicle's first drive, or drives. */
  at: number;
  /** From its first scan to its last. */
  durationS: number;
  /** What this drive has of its own, by the joint estimate; what drives share is with the vehicle. */
  own: FleetCarValues;
}

/**
 * Where an angle comes from.
 *
 * - `history`: The drives' angles over time.
 * - `joint`: The joint estimate of all drives of the vehicle.
 */
export type FleetAngleSource = 'history' | 'joint';

/** The angle by one drive. */
export interface FleetDriveAngle {
  /** Which drive of the vehicle, from 0. */
  drive: number;
  /** The angle. */
  angleDeg: number;
  /** Its standard deviation; infinite where the drive says nothing. */
  sigmaDeg: number;
  /** The angle that the history has at this drive. */
  fittedDeg: number;
  /** Whether it had settled. */
  converged: boolean;
  /** Whether it is further from the history than chance has it. */
  outlying: boolean;
  /** Codes of its warnings. */
  warnings: string[];
}

/** A change of the angle from one drive to the next. */
export interface FleetKnock {
  /** The first drive after it, from 0. */
  drive: number;
  /** Place in time of the drive before, days or drives. */
  after: number;
  /** Place in time of that drive. */
  before: number;
  /** By how much the angle changed. */
  stepDeg: number;
  /** Its standard deviation. */
  sigmaDeg: number;
}

/** A steady change of the angle. */
export interface FleetDrift {
  /** Change a day, or a drive where drives have no times. */
  rateDeg: number;
  /** Its standard deviation. */
  sigmaDeg: number;
}

/** A radar of a vehicle over its drives. */
export interface FleetVehicleRadar {
  /** Its number. */
  sensor: number;
  /** The angle that it should be mounted at, as the last drive that says so does. */
  nominalDeg: number | null;
  /** The angle now: that at the last drive, after the last knock. */
  angleDeg: number;
  /** Its standard deviation; infinite where no drive tells. */
  sigmaDeg: number;
  /** Where the angle comes from. */
  source: FleetAngleSource;
  /** Whether it is where it should be; none without a nominal angle. */
  alignment: Alignment | null;
  /** Each drive's own angle. */
  drives: FleetDriveAngle[];
  /** When the angle changed at once. */
  knocks: FleetKnock[];
  /** How the angle drifts; none where it does not by more than chance. */
  drift: FleetDrift | null;
  /** Factor on the drives' stated deviations that their scatter speaks for. */
  scatter: number;
  /** How far this vehicle is from the others, in deviations, where it is further than chance has it; none otherwise. */
  outlying: number | null;
}

/** A vehicle. */
export interface FleetVehicle {
  /** Its name. */
  name: string;
  /** Its drives, in their order. */
  drives: FleetDrive[];
  /** Whether drives are placed by their times, in days; otherwise by their order, one drive apart. */
  timed: boolean;
  /** Its radars, by number. */
  radars: FleetVehicleRadar[];
  /** What its drives share beside the angles; none where no drive could tell. */
  shared: FleetCarValues | null;
}

/** A radar of the fleet's vehicles. */
export interface FleetRadar {
  /** Its number. */
  sensor: number;
  /** Vehicles whose angle off nominal (or where none states a nominal one, angle) is known. */
  vehicles: number;
  /** Centre of the vehicles' angles off nominal. */
  centreDeg: number;
  /** Their spread, beyond what their deviations have. */
  spreadDeg: number;
  /** Deviations from which a vehicle is called outlying. */
  threshold: number;
  /** Names of the vehicles beyond it. */
  outlying: string[];
}

/** A fleet's drives, put together. */
export interface Fleet {
  /** What became of the logs. */
  logs: FleetLogCounts;
  /** Why logs failed, the most frequent first. */
  failures: FleetFailureCount[];
  /** The vehicles, by name. */
  vehicles: FleetVehicle[];
  /** Radars by their number, and how the vehicles' lie about each other. */
  radars: FleetRadar[];
}

/**
 * What a network is: what its card says, and without one what the names and shapes of its inputs and outputs tell.
 * AAETR and the learned pursuit have the same; without a card such a network counts as AAETR.
 *
 * - `aaetr`: A set of targets from one snapshot, by a transformer.
 * - `learned-pursuit`: A set of targets from one snapshot, by a pursuit whose steps are learned.
 * - `counting`: The number of targets, 0 to 2, from a covariance.
 * - `dnn`: Whole degrees from a covariance.
 * - `cnn3d`: Whole degrees from a region of the range spectrum.
 * - `unrolled-iaa`: The spectrum of one snapshot, by iterations of IAA unrolled.
 * - `covariance-cnn`: Probabilities of sources over a grid, from a covariance.
 * - `deep-music`: MUSIC's spectrum, from a covariance.
 */
export type NetworkKind =
  | 'aaetr'
  | 'learned-pursuit'
  | 'counting'
  | 'dnn'
  | 'cnn3d'
  | 'unrolled-iaa'
  | 'covariance-cnn'
  | 'deep-music';

/** An input or output, of 32-bit floating-point numbers. */
export interface NetworkPort {
  /** Its name. */
  name: string;
  /** Its shape: lengths, or names where any length goes. */
  axes: (number | string)[];
}

/** What a network is. */
export interface NetworkDescription {
  /** An estimator, or one that counts sources. */
  kind: NetworkKind;
  /** The method it is estimated with; null for a counting network. */
  method: Method | null;
  /** Its name on its card, or that of its kind. */
  name: string;
  /** What goes in. */
  inputs: NetworkPort[];
  /** What comes out. */
  outputs: NetworkPort[];
}

/** How probable each number of sources is. */
export interface SourceProbabilities {
  /** The most probable number. */
  sources: number;
  /** Probability of 0, 1 and 2 sources, each by itself. */
  probability: Float64Array;
}

/**
 * Why a row of a drive log was left out.
 *
 * - `not-finite`: A detection with a NaN or an infinity where a number is needed.
 * - `invalid-marker`: A detection whose range rate marks it as invalid.
 * - `status`: A detection that its radar's status calls none.
 * - `duplicate`: A second detection of the same track in one scan.
 * - `motion-not-finite`: A motion sample with a NaN or an infinity where a number is needed.
 * - `motion-duplicate`: A second motion sample of the same time, or a pose so near to another that their difference is
 * noise.
 * - `motion-alone`: A pose with no other near it in time, so that it tells no motion.
 * - `invalid-state`: A detection that its radar calls invalid (`invalid_state` of nuScenes).
 * - `ambiguous-doppler`: A detection whose range rate its radar calls ambiguous (`ambig_state` of nuScenes).
 * - `dynamic-property`: A detection on a thing that has stopped, or of an unknown kind (`dyn_prop` of nuScenes).
 * - `earlier-scan`: A detection of an earlier scan, which another frame has as its own.
 */
export type DropReason =
  | 'not-finite'
  | 'invalid-marker'
  | 'status'
  | 'duplicate'
  | 'motion-not-finite'
  | 'motion-duplicate'
  | 'motion-alone'
  | 'invalid-state'
  | 'ambiguous-doppler'
  | 'dynamic-property'
  | 'earlier-scan';

/** A scenario that can be simulated. */
export interface DriveScenarioInfo {
  /** Its name. */
  name: DriveScenario;
  /** Name for people. */
  title: string;
}

/** A radar of a drive: its place from the rear axle and nominal direction, null where the log does not say. */
export interface DriveSensor {
  /** Its number in the log, 0 to 255. */
  id: number;
  /** Ahead of the rear axle. */
  xM: number | null;
  /** Left of the centre line. */
  yM: number | null;
  /** Nominal direction of boresight, counter-clockwise from the car's x. */
  yawDeg: number | null;
}

/** Radar scans in order of time; the detections of scan `i` are those from the `i`-th offset to before the next. */
export interface DriveScans {
  /** Time of each, on the clock of the log. */
  timeS: Float64Array;
  /** Numbers of the radars. */
  sensor: Uint8Array;
  /** One more than there are scans. */
  offsets: Uint32Array;
}

/** Detections in the frames of their radars. */
export interface DriveDetections {
  /** Azimuth, positive to the left. */
  azimuthDeg: Float64Array;
  /** Range rate, positive when receding, not compensated for the car's motion. */
  rangeRateMps: Float32Array;
  /** Range; NaN where there is none. */
  rangeM: Float32Array;
  /** Radar cross-section; NaN where there is none. */
  rcsDbsm: Float32Array;
  /** Classes in the numbers of RadarScenes (11 is static), where the log has them. */
  label: Uint8Array | null;
}

/** Poses of the rear axle; NaN where one is not known. */
export interface DrivePoses {
  /** East, or x of the log's global frame. */
  xM: Float64Array;
  /** North, or y of the log's global frame. */
  yM: Float64Array;
  /** Heading, counter-clockwise from x. */
  yawDeg: Float64Array;
}

/** The car's motion as measured. */
export interface DriveMotion {
  /** Time of each sample, on the clock of the log. */
  timeS: Float64Array;
  /** Yaw rate. */
  yawRateDegps: Float64Array;
  /** Speed of the rear axle, negative in reverse; NaN where there is none. */
  speedMps: Float64Array;
  /** Where the rear axle is, where the log says so. */
  pose: DrivePoses | null;
}

/**
 * Where the mountings of a log are from.
 *
 * - `sensors-json`: `sensors.json` of the recording.
 * - `format`: The format's own car, as no file states them.
 * - `calibrated-sensor`: `calibrated_sensor.json` of the data set.
 * - `tf-static`: Fixed transforms of the recording (`/tf_static`).
 */
export type MountingSource = 'sensors-json' | 'format' | 'calibrated-sensor' | 'tf-static';

/** What the files of a drive held. */
export interface DriveCounts {
  /** Detections in the files. */
  detections: number;
  /** Motion samples in the files. */
  motion: number;
  /** Detections kept although their range, cross-section, compensated rate or place is no number. */
  incompleteDetections: number;
  /** Motion samples kept although their speed or pose is no number. */
  incompleteMotion: number;
  /** Rows left out, by reason. */
  dropped: Partial<Record<DropReason, number>>;
}

/**
 * What a topic of a recording is used for.
 *
 * - `radar`: The detections of a radar.
 * - `tracks`: The tracks of a radar: filtered, and fewer.
 * - `motion`: The car's motion.
 * - `mountings`: Where radars sit.
 * - `unused`: Nothing.
 */
export type TopicUse = 'radar' | 'tracks' | 'motion' | 'mountings' | 'unused';

/**
 * Which clock tells the times of a topic.
 *
 * - `stamp`: The stamp in the header of each message.
 * - `log-time`: When each message was recorded.
 */
export type TopicClock = 'stamp' | 'log-time';

/** A topic of a recording. */
export interface DriveTopic {
  /** Its name. */
  name: string;
  /** The type of its messages. */
  messageType: string;
  /** Messages on it. */
  messages: number;
  /** Messages of it that could not be decoded. */
  unreadable: number;
  /** What it is used for. */
  usedAs: TopicUse;
  /** Number of the radar, of a topic with one. */
  sensor: number | null;
  /** The clock of its times, of a topic that is used. */
  clock: TopicClock | null;
  /** What is read of it, or why it is not used. */
  note: string;
}

/** A drive as read or simulated. */
export interface Drive {
  /** The format it was read from, or `simulated`. */
  format: DriveFormat | 'simulated';
  /** The radars, by ascending number. */
  sensors: DriveSensor[];
  /** Radar scans in order of time. */
  scans: DriveScans;
  /** An entry for each detection, those of a scan together. */
  detections: DriveDetections;
  /** An entry for each sample of the car's motion, in order of time. */
  motion: DriveMotion;
  /** Where the radars' places are from, where the log has any. */
  mountings: MountingSource | null;
  /** What the files held. */
  counts: DriveCounts;
  /** Topics of a recording and what each is used for; none in other formats. */
  topics: DriveTopic[];
  /** When the drive begins by the clock of the recording, since 1970, where its times were shifted. */
  startS: number | null;
  /** What else to know. */
  warnings: Warning[];
}

/** A radar where it truly sits and looks. */
export interface TrueSensor {
  /** Its number in the drive. */
  id: number;
  /** Ahead of the rear axle. */
  xM: number;
  /** Left of the centre line. */
  yM: number;
  /** Direction of boresight, counter-clockwise from the car's x. */
  yawDeg: number;
  /** Root mean square of its azimuth bias within 55 deg. */
  azimuthBiasRmsDeg: number;
}

/** Errors of a yaw-rate sensor. */
export interface YawRateErrors {
  /** Measured over true yaw rate. */
  scale: number;
  /** Yaw rate measured at standstill. */
  biasDegps: number;
  /** Standard deviation of a sample's white noise. */
  sigmaDegps: number;
}

/** How a car moves and measures, beside its yaw rate. */
export interface CarErrors {
  /** Slip angle of the rear axle over lateral acceleration, outwards, rad/(m/s^2); outside Rust in degrees. */
  slipGradientDeg: number;
  /** Direction of the rear axle's way straight ahead, to the left of the car's x. */
  crabDeg: number;
  /** By how much range rates lag their time stamp. */
  delayS: number;
  /** Measured over true speed. */
  speedScale: number;
  /** Standard deviation of a sample of speed. */
  speedSigmaMps: number;
  /** Lag of the measured speed. */
  speedLagS: number;
  /** Lag of the measured yaw rate. */
  yawRateLagS: number;
}

/** The car's true motion. */
export interface TrueMotion {
  /** Yaw rate. */
  yawRateDegps: Float64Array;
  /** Speed of the rear axle, negative in reverse. */
  speedMps: Float64Array;
}

/** What really happened in a simulated drive. */
export interface DriveTruth {
  /** The radars where they truly sit and look. */
  sensors: TrueSensor[];
  /** Errors of the yaw-rate sensor. */
  yawRate: YawRateErrors;
  /** How the car slips, and what its radars and its speed are late or off by. */
  car: CarErrors;
  /** The car's motion at the times of the drive's. */
  motion: TrueMotion;
  /** For each detection, 1 where it comes from a moving road user. */
  moving: Uint8Array;
  /** For each detection, the number of the road user it comes from, or 0. */
  track: Uint32Array;
}

/** A simulated drive with the truth behind it; its poses are the true ones. */
export interface SimulatedDrive {
  /** The format it was read from, or `simulated`. */
  format: DriveFormat | 'simulated';
  /** The radars, by ascending number. */
  sensors: DriveSensor[];
  /** Radar scans in order of time. */
  scans: DriveScans;
  /** An entry for each detection, those of a scan together. */
  detections: DriveDetections;
  /** An entry for each sample of the car's motion, in order of time. */
  motion: DriveMotion;
  /** Where the radars' places are from, where the log has any. */
  mountings: MountingSource | null;
  /** What the files held. */
  counts: DriveCounts;
  /** Topics of a recording and what each is used for; none in other formats. */
  topics: DriveTopic[];
  /** When the drive begins by the clock of the recording, since 1970, where its times were shifted. */
  startS: number | null;
  /** What else to know. */
  warnings: Warning[];
  /** What really happened. */
  truth: DriveTruth;
}

/** An array of a file: `.npy`, MATLAB's or HDF5. */
export interface NpyArray {
  /** Complex numbers are interleaved [re, im]. */
  kind: 'real' | 'complex';
  /** The numbers in C order, in their precision; integers as doubles. */
  data: Float32Array | Float64Array;
  /** Lengths of the axes. */
  shape: number[];
}

/** An array of real or complex numbers in a file. */
export interface ArrayEntry {
  /** Its name, with those of its groups before it and `/` between. */
  dataset: string;
  /** What its numbers are. */
  kind: 'real' | 'complex';
  /** Lengths of its axes, in MATLAB's order in files of MATLAB. */
  shape: number[];
}

/** An object the board detected. */
export interface BoardObject {
  /** Distance. */
  rangeM: number;
  /**
   * Range rate, positive when receding; none where the packet holds only a Doppler bin and no configuration tells its
   * width.
   */
  rateMps: number | null;
  /** Azimuth, positive to the left. */
  azimuthDeg: number;
  /** Elevation, positive upwards. */
  elevationDeg: number;
  /** Position forward. */
  xM: number;
  /** Position to the left. */
  yM: number;
  /** Position upwards. */
  zM: number;
  /** Range bin (SDK 1 and 2). */
  rangeBin?: number;
  /** Doppler bin, signed (SDK 1 and 2). */
  dopplerBin?: number;
  /** Peak value as sent (SDK 1 and 2). */
  peak?: number;
  /** Ratio to the noise (side information of SDK 3). */
  snrDb?: number;
}

/** How long the board took, as it says. */
export interface BoardStats {
  /** Processing between frames. */
  processingS: number;
  /** Time to send the packet. */
  transmitS: number;
  /** Margin left between frames. */
  frameMarginS: number;
  /** Margin left between chirps. */
  chirpMarginS: number;
  /** Load while chirps are sent, percent. */
  activeLoadPercent: number;
  /** Load between frames, percent. */
  idleLoadPercent: number;
}

/** One packet: what the board made of one frame. */
export interface BoardFrame {
  /** Number the board gave the frame. */
  frameNumber: number;
  /** SDK version: major, minor, bug fix, build. */
  sdkVersion: string;
  /** Platform, such as `xWR16xx`. */
  platform: string;
  /** Objects. */
  objects: BoardObject[];
  /** Range profile at zero Doppler over the board's own unit, as sent. */
  rangeProfileDb?: Float64Array;
  /** Noise profile, likewise. */
  noiseProfileDb?: Float64Array;
  /** Range x virtual antenna at zero Doppler, as sent, receiver fastest: real and imaginary parts in turn. */
  azimuthHeatMap?: Float32Array;
  /**
   * Range x Doppler map over the board's own unit, as sent: Doppler fastest, from zero up to the highest and on from
   * the lowest.
   */
  rangeDopplerDb?: Float64Array;
  /** Timing. */
  stats?: BoardStats;
  /**
   * Whether the whole packet was there; false for one that the end of the input cut, of which the leading whole parts
   * are given.
   */
  complete: boolean;
}

/** What was lost of a board's output. */
export interface BoardLogCounts {
  /** Bytes that belong to no packet. */
  skippedBytes: number;
  /** Packets that were cut or damaged. */
  damagedPackets: number;
  /** Remarks on both. */
  warnings: Warning[];
}

/** All packets of a recording. */
export interface BoardLog {
  /** Packets, in order. */
  frames: BoardFrame[];
  /** Bytes that belong to no packet. */
  skippedBytes: number;
  /** Packets that were cut or damaged. */
  damagedPackets: number;
  /** Remarks on both. */
  warnings: Warning[];
}
