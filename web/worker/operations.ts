// What a worker can do: the plain functions of the package, and pieces of the batch helpers.

import type {
  AngleOptions,
  ArrayCalibrationResult,
  BatchEstimate,
  BatchInput,
  BatchOptions,
  BytesInput,
  CalibrateDriveOptions,
  CaptureCalibrationOptions,
  CaptureInfo,
  CaptureRegionOptions,
  Cell,
  CellExplanation,
  ChainOptions,
  CombineOptions,
  ComplexData,
  ConfigInput,
  CubeCalibrationOptions,
  CubeChainOptions,
  CubeRegionOptions,
  DriveCalibration,
  DriveData,
  Estimate,
  EstimateInput,
  EstimatorOptions,
  FrameCells,
  FrameResult,
  JointCalibrationOptions,
  NetworkInfo,
  RegionFrame,
  RegionNetworkIds,
  ReportAbout,
  SimulateDriveOptions,
  SimulatedDrive,
  SourceProbabilities,
  Tensor,
} from '../lib/api.js';
import * as api from '../lib/api.js';
import type { Network } from '../lib/neural/network.js';
import { core } from '../lib/runtime/instance.js';
import { bytesOf, type CaptureSource, withCapture } from './captures.js';
import { keyOf, networkWith } from './networks.js';
import { finishDrive, pushDrive } from './streams.js';

/** What an operation is called on. */
export interface Context {
  /** Tells the pool how far the piece is; whether to go on. */
  report(done: number, total: number): boolean;
}

/** Runs `work` with a handle and frees it. */
function freeing<H extends { free(): void }, T>(handle: H, work: (handle: H) => T): T {
  try {
    return work(handle);
  } finally {
    handle.free();
  }
}

/** The network that options of an estimator name, if they do. */
function networkOf(options: { network?: string } | undefined): string | undefined {
  return options?.network ?? undefined;
}

/** Options of a chain of which the cells are wanted, not their angles. */
function withoutNetwork<O extends ChainOptions | undefined>(options: O): O {
  if (networkOf(options?.angle) === undefined) return options;
  const { angle: _, ...rest } = options as ChainOptions;
  return rest as O;
}

function loadNetwork(id: string): NetworkInfo {
  const started = performance.now();
  const { kind, method, name, card, inputs, outputs } = networkWith(id);
  return { id, kind, method, name, card, inputs, outputs, readyMs: performance.now() - started };
}

function countWithNetwork(id: string, input: EstimateInput): SourceProbabilities {
  return networkWith(id).count(input);
}

function runNetwork(id: string, inputs: Readonly<Record<string, Tensor>>): Record<string, Tensor> {
  return networkWith(id).run(inputs);
}

function estimateRegion(region: ComplexData, options: EstimatorOptions & { network: string }): Estimate {
  return networkWith(options.network, options).estimateRegion(region);
}

function estimate(input: EstimateInput, options: EstimatorOptions): Estimate {
  const id = networkOf(options);
  return id === undefined ? api.estimate(input, options) : networkWith(id, options).estimate(input);
}

/** Estimates of many inputs with one estimator. */
function estimateMany(inputs: readonly EstimateInput[], options: EstimatorOptions): Estimate[] {
  const id = networkOf(options);
  if (id !== undefined) {
    const network = networkWith(id, options);
    return inputs.map((input) => network.estimate(input));
  }
  return freeing(new api.Estimator(options), (estimator) => inputs.map((input) => estimator.estimate(input)));
}

/** The estimator of the last batch: a job brings many pieces, and a frame is followed by the next. */
let kept: { key: string; estimator: api.Estimator } | undefined;

function estimateBatch(input: BatchInput, options: EstimatorOptions & BatchOptions): BatchEstimate {
  const { spectra, ...own } = { ...options };
  const kind = { ...(spectra !== undefined && { spectra }) };
  const id = networkOf(own);
  if (id !== undefined) return networkWith(id, own).estimateBatch(input, kind);
  // An instance that is gone took its estimators along.
  const key = `${core.number} ${keyOf(own)}`;
  if (kept?.key !== key) {
    kept?.estimator.free();
    kept = undefined;
    kept = { key, estimator: new api.Estimator(own) };
  }
  return kept.estimator.estimateBatch(input, kind);
}

function captureInfo(source: CaptureSource, config: ConfigInput): CaptureInfo {
  return withCapture(source, config, ({ info }) => info);
}

function processCube(cube: ComplexData, options: CubeChainOptions): FrameResult[] {
  const id = networkOf(options?.angle);
  return id === undefined ? api.processCube(cube, options) : networkWith(id).processCube(cube, options);
}

function frameCells(cube: ComplexData, options: CubeChainOptions): FrameCells {
  return api.frameCells(cube, withoutNetwork(options));
}

function processFrame(source: CaptureSource, config: ConfigInput, frame: number, options?: ChainOptions): FrameResult {
  const id = networkOf(options?.angle);
  if (id === undefined) return withCapture(source, config, (capture) => capture.processFrame(frame, options));
  return networkWith(id).processFrames(bytesOf(source), config, options, frame)[0] as FrameResult;
}

function cubeRegions(networks: RegionNetworkIds, cube: ComplexData, options: CubeRegionOptions): RegionFrame[] {
  const { counting, ...angles } = networksOf(networks);
  return counting.cubeRegions(angles, cube, options);
}

/** Regions of every frame of a stretch of a capture that begins with frame `first`. */
function regionStretch(
  networks: RegionNetworkIds,
  bytes: BytesInput,
  config: ConfigInput,
  first: number,
  options?: CaptureRegionOptions,
): RegionFrame[] {
  const { counting, ...angles } = networksOf(networks);
  const results = counting.captureRegions(angles, bytes, config, options);
  for (const result of results) result.frame += first;
  return results;
}

/** The networks of regions. */
function networksOf(ids: RegionNetworkIds): { counting: Network; one: Network; two: Network } {
  return { counting: networkWith(ids?.counting), one: networkWith(ids?.one), two: networkWith(ids?.two) };
}

/** Every frame of a stretch of a capture that begins with frame `first`. */
function processStretch(bytes: BytesInput, config: ConfigInput, first: number, options?: ChainOptions): FrameResult[] {
  const id = networkOf(options?.angle);
  const results =
    id !== undefined
      ? networkWith(id).processFrames(bytes, config, options)
      : withCapture(bytes, config, (capture) =>
          Array.from({ length: capture.info.frames }, (_, index) => capture.processFrame(index, options)),
        );
  for (const result of results) for (const part of [result, ...result.detections]) part.frame += first;
  return results;
}

function combineFrames(
  this: Context,
  source: CaptureSource,
  config: ConfigInput,
  options?: CombineOptions,
): FrameResult {
  const report = (done: number, total: number): boolean => this.report(done, total);
  const id = networkOf(options?.angle);
  if (id !== undefined) return networkWith(id).combineFrames(bytesOf(source), config, options, report);
  return withCapture(source, config, (capture) => capture.combineFrames(options, report));
}

function captureCalibration(
  this: Context,
  source: CaptureSource,
  config: ConfigInput,
  options?: CaptureCalibrationOptions,
): ArrayCalibrationResult {
  const report = (done: number, total: number): boolean => this.report(done, total);
  return withCapture(source, config, (capture) => capture.calibrateArray(options, report));
}

function calibrateCubeArray(this: Context, cube: ComplexData, options: CubeCalibrationOptions): ArrayCalibrationResult {
  return api.calibrateCubeArray(cube, options, (done, total) => this.report(done, total));
}

function cellSnapshots(source: CaptureSource, config: ConfigInput, cell: Cell, options?: ChainOptions): ComplexData {
  return withCapture(source, config, (capture) => capture.cellSnapshots(cell, withoutNetwork(options)));
}

function explainCell(source: CaptureSource, config: ConfigInput, cell: Cell, options?: ChainOptions): CellExplanation {
  return withCapture(source, config, (capture) => capture.explainCell(cell, withoutNetwork(options)));
}

function captureCells(source: CaptureSource, config: ConfigInput, frame: number, options?: ChainOptions): FrameCells {
  return withCapture(source, config, (capture) => capture.frameCells(frame, withoutNetwork(options)));
}

function cellSpectrum(
  source: CaptureSource,
  config: ConfigInput,
  cell: Cell,
  angle?: AngleOptions,
  options?: ChainOptions,
): Estimate {
  const id = networkOf(angle);
  return withCapture(source, config, (capture) => {
    if (id === undefined) return capture.cellSpectrum(cell, angle, withoutNetwork(options));
    const snapshots = capture.cellSnapshots(cell, withoutNetwork(options));
    // Without an array the snapshots could not be had.
    const array = options?.array ?? { positions: capture.info.array?.positions ?? [] };
    return networkWith(id, { ...angle, array }).estimate({ snapshots });
  });
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

function calibrationReport(
  this: Context,
  drive: DriveData,
  about?: ReportAbout,
  options?: CalibrateDriveOptions | JointCalibrationOptions,
): string {
  return api.calibrationReport(drive, about, options, (done, total) => this.report(done, total));
}

export const operations = {
  version: api.version,
  methods: api.methods,
  arrayPresets: api.arrayPresets,
  array: api.array,
  unsuited: api.unsuited,
  loadNetwork,
  countWithNetwork,
  runNetwork,
  estimateRegion,
  estimate,
  estimateMany,
  estimateBatch,
  countSources: api.countSources,
  cramerRaoBound: api.cramerRaoBound,
  simulateSnapshots: api.simulateSnapshots,
  simulateCube: api.simulateCube,
  processCube,
  calibrationMethods: api.calibrationMethods,
  mergeCalibrations: api.mergeCalibrations,
  readDrive: api.readDrive,
  pushDrive,
  finishDrive,
  simulateDrive,
  driveScenarios: api.driveScenarios,
  scanMotion: api.scanMotion,
  calibrateDrive,
  jointCalibration,
  calibrationReport,
  trajectory: api.trajectory,
  relativeTrajectoryError: api.relativeTrajectoryError,
  waveformPresets: api.waveformPresets,
  waveformPreset: api.waveformPreset,
  waveformSummary: api.waveformSummary,
  parseConfig: api.parseConfig,
  studioConfig: api.studioConfig,
  joinCascade: api.joinCascade,
  recordingParts: api.recordingParts,
  subFrameConfig: api.subFrameConfig,
  captureInfo,
  processFrame,
  processStretch,
  cubeRegions,
  regionStretch,
  combineFrames,
  captureCalibration,
  calibrateArray: api.calibrateArray,
  calibrateCubeArray,
  calibrateBySteeringTable: api.calibrateBySteeringTable,
  configuredCalibration: api.configuredCalibration,
  tiCompensation: api.tiCompensation,
  cellSnapshots,
  cellSpectrum,
  explainCell,
  captureCells,
  streetScene: api.streetScene,
  simulateStreet: api.simulateStreet,
  frameCells,
  strongestRegion: api.strongestRegion,
  imagePlan: api.imagePlan,
  rangeAzimuthMap: api.rangeAzimuthMap,
  birdsEyeView: api.birdsEyeView,
  sidelobeMeasure: api.sidelobeMeasure,
  parseBoardLog: api.parseBoardLog,
  readArray: api.readArray,
  listArrays: api.listArrays,
  readNpy: api.readNpy,
  writeNpy: api.writeNpy,
  readDetectionsCsv: api.readDetectionsCsv,
  writeDetectionsCsv: api.writeDetectionsCsv,
  readSnapshotsCsv: api.readSnapshotsCsv,
  writeSnapshotsCsv: api.writeSnapshotsCsv,
};
