// What a worker can do: the plain functions of the package, and pieces of the batch helpers.
import * as api from '../lib/api.js';
import type {
  AngleOptions, BatchEstimate, BatchInput, BatchOptions, BytesInput, CalibrateDriveOptions, CaptureInfo, Cell,
  ChainOptions, CombineOptions, ComplexData, DriveCalibration, DriveData, Estimate, EstimateInput, EstimatorOptions,
  FrameCells, FrameResult, JointCalibrationOptions, SimulateDriveOptions, SimulatedDrive, TextInput,
} from '../lib/api.js';
import { core } from '../lib/instance.js';

/** What an operation is called on. */
export interface Context {
  /** Tells the pool how far the piece is. */
  report(done: number, total: number): void;
}

/** Runs `work` with a handle and frees it. */
function freeing<H extends { free(): void }, T>(handle: H, work: (handle: H) => T): T {
  try {
    return work(handle);
  } finally {
    handle.free();
  }
}

/** Estimates of many inputs with one estimator. */
function estimateMany(inputs: readonly EstimateInput[], options: EstimatorOptions): Estimate[] {
  return freeing(new api.Estimator(options), (estimator) => inputs.map((input) => estimator.estimate(input)));
}

/** The estimator of the last batch: a job brings many pieces, and a frame is followed by the next. */
let kept: { key: string; estimator: api.Estimator } | undefined;

function estimateBatch(input: BatchInput, options: EstimatorOptions & BatchOptions): BatchEstimate {
  const { spectra, ...own } = { ...options };
  // An instance that is gone took its estimators along.
  const key = `${core.number} ${JSON.stringify(own, (_, value: unknown) => (typeof value === 'bigint' ? `${value}n` : value))}`;
  if (kept?.key !== key) {
    kept?.estimator.free();
    kept = undefined;
    kept = { key, estimator: new api.Estimator(own) };
  }
  return kept.estimator.estimateBatch(input, { ...(spectra !== undefined && { spectra }) });
}

function captureInfo(bytes: BytesInput, config: TextInput): CaptureInfo {
  return freeing(new api.Capture(bytes, config), ({ info }) => info);
}

function processFrame(bytes: BytesInput, config: TextInput, frame: number, options?: ChainOptions): FrameResult {
  return freeing(new api.Capture(bytes, config), (capture) => capture.processFrame(frame, options));
}

/** Every frame of a stretch of a capture that begins with frame `first`. */
function processStretch(bytes: BytesInput, config: TextInput, first: number, options?: ChainOptions): FrameResult[] {
  return freeing(new api.Capture(bytes, config), (capture) =>
    Array.from({ length: capture.info.frames }, (_, index) => {
      const result = capture.processFrame(index, options);
      for (const part of [result, ...result.detections]) part.frame += first;
      return result;
    }));
}

function combineFrames(this: Context, bytes: BytesInput, config: TextInput, options?: CombineOptions): FrameResult {
  return freeing(new api.Capture(bytes, config), (capture) =>
    capture.combineFrames(options, (done, total) => this.report(done, total)));
}

function cellSnapshots(bytes: BytesInput, config: TextInput, cell: Cell, options?: ChainOptions): ComplexData {
  return freeing(new api.Capture(bytes, config), (capture) => capture.cellSnapshots(cell, options));
}

function captureCells(bytes: BytesInput, config: TextInput, frame: number, options?: ChainOptions): FrameCells {
  return freeing(new api.Capture(bytes, config), (capture) => capture.frameCells(frame, options));
}

function cellSpectrum(
  bytes: BytesInput,
  config: TextInput,
  cell: Cell,
  angle?: AngleOptions,
  options?: ChainOptions,
): Estimate {
  return freeing(new api.Capture(bytes, config), (capture) => capture.cellSpectrum(cell, angle, options));
}

function simulateDrive(this: Context, options?: SimulateDriveOptions): SimulatedDrive {
  return api.simulateDrive(options, (done, total) => this.report(done, total));
}

function calibrateDrive(this: Context, drive: DriveData, options?: CalibrateDriveOptions): DriveCalibration {
  return api.calibrateDrive(drive, options, (done, total) => this.report(done, total));
}

function jointCalibration(this: Context, drive: DriveData, options?: JointCalibrationOptions): DriveCalibration[] {
  return api.jointCalibration(drive, options, (done, total) => this.report(done, total));
}

export const operations = {
  version: api.version,
  methods: api.methods,
  arrayPresets: api.arrayPresets,
  array: api.array,
  estimate: api.estimate,
  estimateMany,
  estimateBatch,
  countSources: api.countSources,
  cramerRaoBound: api.cramerRaoBound,
  simulateSnapshots: api.simulateSnapshots,
  simulateCube: api.simulateCube,
  processCube: api.processCube,
  calibrationMethods: api.calibrationMethods,
  readDrive: api.readDrive,
  simulateDrive,
  driveScenarios: api.driveScenarios,
  calibrateDrive,
  jointCalibration,
  trajectory: api.trajectory,
  relativeTrajectoryError: api.relativeTrajectoryError,
  waveformSummary: api.waveformSummary,
  parseConfig: api.parseConfig,
  captureInfo,
  processFrame,
  processStretch,
  combineFrames,
  cellSnapshots,
  cellSpectrum,
  captureCells,
  streetScene: api.streetScene,
  simulateStreet: api.simulateStreet,
  frameCells: api.frameCells,
  imagePlan: api.imagePlan,
  rangeAzimuthMap: api.rangeAzimuthMap,
  birdsEyeView: api.birdsEyeView,
  sidelobeMeasure: api.sidelobeMeasure,
  parseBoardLog: api.parseBoardLog,
  readNpy: api.readNpy,
  writeNpy: api.writeNpy,
  readDetectionsCsv: api.readDetectionsCsv,
  writeDetectionsCsv: api.writeDetectionsCsv,
  readSnapshotsCsv: api.readSnapshotsCsv,
  writeSnapshotsCsv: api.writeSnapshotsCsv,
};
