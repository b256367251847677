// The functions of the package as promises.
import type * as arrayCalibration from '../lib/array-calibration/array-calibration.js';
import type * as capture from '../lib/capture/capture.js';
import type * as region from '../lib/capture/region.js';
import type * as drive from '../lib/drive/drive.js';
import type * as trajectory from '../lib/drive/trajectory.js';
import type * as estimate from '../lib/estimate/estimate.js';
import type * as theory from '../lib/estimate/theory.js';
import type * as board from '../lib/formats/board.js';
import type * as config from '../lib/formats/config.js';
import type * as csv from '../lib/formats/csv.js';
import type * as hdf5 from '../lib/formats/hdf5.js';
import type * as npy from '../lib/formats/npy.js';
import type * as studio from '../lib/formats/studio.js';
import type * as image from '../lib/image/image.js';
import type * as calibrate from '../lib/mounting/calibrate.js';
import type * as array from '../lib/radar/array.js';
import type * as waveform from '../lib/radar/waveform.js';
import type * as version from '../lib/runtime/version.js';
import type * as simulate from '../lib/simulate/simulate.js';
import type * as street from '../lib/simulate/street.js';
import type { BytesInput, ConfigInput } from '../lib/types.js';
import type { JobOptions } from './job.js';

// biome-ignore lint/suspicious/noExplicitAny: functions of any arguments
type AnyFunction = (...args: any) => unknown;

/** A function of the package on a pool: the options of the job come behind its arguments, and a promise of its result. */
export type Promised<F> = F extends AnyFunction
  ? (...args: [...arguments: Parameters<F>, job?: JobOptions]) => Promise<ReturnType<F>>
  : never;

/** The same of each member, with the documentation of each. */
export type AllPromised<T> = { [K in keyof T]: Promised<T[K]> };

/** A method of a capture as a function of the capture's bytes and configuration. */
type OfCapture<F> = F extends AnyFunction
  ? (bytes: BytesInput, config: ConfigInput, ...args: Parameters<F>) => ReturnType<F>
  : never;

type OfCaptures<T> = { [K in keyof T]: OfCapture<T[K]> };
type CaptureFunctions = OfCaptures<
  Pick<capture.Capture, 'processFrame' | 'cellSnapshots' | 'explainCell' | 'cellSpectrum'>
> & {
  /** Detected cells of one frame of a capture. */
  captureCells: OfCapture<capture.Capture['frameCells']>;
};

/** Functions of the package by the modules that document them, which what api.ts exports again does not. */
type Functions = typeof array &
  typeof arrayCalibration &
  typeof board &
  typeof calibrate &
  typeof capture &
  typeof config &
  typeof csv &
  typeof drive &
  typeof estimate &
  typeof hdf5 &
  typeof image &
  typeof npy &
  typeof region &
  typeof simulate &
  typeof studio &
  typeof street &
  typeof theory &
  typeof trajectory &
  typeof version &
  typeof waveform &
  CaptureFunctions;
type Counts<T> = { readonly [K in keyof T]?: T[K] extends AnyFunction ? Required<Parameters<T[K]>>['length'] : never };

/** The functions that one worker runs as they are, with the number of their arguments: what comes next is the job's. */
export const argumentCounts = {
  version: 0,
  methods: 0,
  calibrationMethods: 0,
  mergeCalibrations: 1,
  arrayPresets: 0,
  array: 1,
  calibrateArray: 2,
  calibrateBySteeringTable: 2,
  configuredCalibration: 2,
  tiCompensation: 2,
  unsuited: 2,
  estimate: 2,
  countSources: 2,
  cramerRaoBound: 1,
  simulateCube: 1,
  processCube: 2,
  processFrame: 4,
  cellSnapshots: 4,
  explainCell: 4,
  cellSpectrum: 5,
  captureCells: 4,
  readDrive: 2,
  driveScenarios: 0,
  trajectory: 3,
  relativeTrajectoryError: 3,
  waveformPresets: 0,
  waveformPreset: 1,
  waveformSummary: 1,
  joinCascade: 2,
  recordingParts: 1,
  parseConfig: 1,
  studioConfig: 2,
  subFrameConfig: 2,
  parseBoardLog: 2,
  readArray: 2,
  listArrays: 1,
  readNpy: 1,
  writeNpy: 1,
  readDetectionsCsv: 1,
  writeDetectionsCsv: 1,
  readSnapshotsCsv: 1,
  writeSnapshotsCsv: 1,
  streetScene: 1,
  simulateStreet: 1,
  frameCells: 2,
  strongestRegion: 2,
  rangeAzimuthMap: 1,
  birdsEyeView: 1,
  sidelobeMeasure: 3,
  imagePlan: 1,
} as const satisfies Counts<Functions>;

/** They as promises. */
export type PromisedFunctions = AllPromised<Pick<Functions, keyof typeof argumentCounts>>;
