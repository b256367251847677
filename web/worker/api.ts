// The functions of the package as promises.
import { jointTaskOf, taskOf } from '../lib/drive-radars.js';
import { driveFrame, selected, viewOf } from '../lib/drive-view.js';
import { chainOf } from '../lib/image-options.js';
import type * as lib from '../lib/types.js';
import { joined, joinedBatches, stretchesOf } from './batch.js';
import { Crew, type JobOptions, type Piece, type Runtime } from './pool.js';
import type { OperationName, Operations } from './protocol.js';
import { split } from './split.js';
import { packed } from './transfer.js';

/** Options of {@link createPool}. */
export interface PoolOptions {
  /** Number of workers; by default one a processor core, at most 8. */
  workers?: number;
}

/** A pool of workers with the functions of the package. Workers start when there is work. */
export class Pool {
  readonly #crew: Crew;

  /** @internal */
  constructor(runtime: Runtime, { workers }: PoolOptions = {}) {
    this.#crew = new Crew(runtime, workers);
  }

  /** Most workers that run at a time. */
  get workers(): number {
    return this.#crew.size;
  }

  version(job?: JobOptions): Promise<string> {
    return this.#one('version', [], job);
  }

  methods(job?: JobOptions): Promise<lib.MethodInfo[]> {
    return this.#one('methods', [], job);
  }

  calibrationMethods(job?: JobOptions): Promise<lib.CalibrationMethodInfo[]> {
    return this.#one('calibrationMethods', [], job);
  }

  arrayPresets(job?: JobOptions): Promise<string[]> {
    return this.#one('arrayPresets', [], job);
  }

  array(input: lib.ArrayInput, job?: JobOptions): Promise<lib.ArrayGeometry> {
    return this.#one('array', [input], job);
  }

  /**
   * Loads a network from its ONNX file: once to see that it is one, then in each worker that comes to need it. Its id
   * is what `network` in options names it by, for the methods `aaetr`, `dnn` and `cnn3d`.
   */
  async loadNetwork(file: lib.NetworkFile, job?: JobOptions): Promise<lib.NetworkInfo> {
    const { value } = packed({ onnx: file.onnx, ...(file.card !== undefined && { card: file.card }) }, false);
    const id = this.#crew.addNetwork(value);
    try {
      return await this.#one('loadNetwork', [id], job, id);
    } catch (thrown) {
      this.#crew.removeNetwork(id);
      throw thrown;
    }
  }

  /** Forgets a network and gives its memory back; whether there was one. */
  unloadNetwork(id: string): boolean {
    return this.#crew.removeNetwork(id);
  }

  /** Counts sources with a counting network. */
  countWithNetwork(id: string, input: lib.EstimateInput, job?: JobOptions): Promise<lib.SourceProbabilities> {
    return this.#one('countWithNetwork', [id, input], job, id);
  }

  /** Runs the graph of a network as it is: named inputs to named outputs. */
  runNetwork(
    id: string,
    inputs: Readonly<Record<string, lib.Tensor>>,
    job?: JobOptions,
  ): Promise<Record<string, lib.Tensor>> {
    return this.#one('runNetwork', [id, inputs], job, id);
  }

  /** Estimates from the range bins around a peak, [65 bins, 8 elements, 4 chirps], with a network. */
  estimateRegion(
    region: lib.ComplexData,
    options: lib.EstimatorOptions & { network: string },
    job?: JobOptions,
  ): Promise<lib.Estimate> {
    return this.#one('estimateRegion', [region, options], job, options.network);
  }

  estimate(input: lib.EstimateInput, options: lib.EstimatorOptions, job?: JobOptions): Promise<lib.Estimate> {
    return this.#one('estimate', [input, options], job, options?.network);
  }

  countSources(input: lib.EstimateInput, options?: lib.CountOptions, job?: JobOptions): Promise<lib.CountResult> {
    return this.#one('countSources', [input, options], job);
  }

  cramerRaoBound(options: lib.BoundOptions, job?: JobOptions): Promise<lib.Bound> {
    return this.#one('cramerRaoBound', [options], job);
  }

  /** Scenes are split over the workers; progress counts scenes. */
  async simulateSnapshots(options: lib.SnapshotOptions, job?: JobOptions): Promise<lib.SnapshotResult> {
    const { scenes = 1, firstScene = 0 } = options;
    if (!Number.isInteger(scenes) || scenes < 2) return this.#one('simulateSnapshots', [options], job);
    const pieces = split(scenes, this.workers).map(
      ({ first, count }): Piece<'simulateSnapshots'> => ({
        name: 'simulateSnapshots',
        args: [{ ...options, scenes: count, firstScene: firstScene + first }],
        units: count,
      }),
    );
    return joinedScenes(await this.#crew.run(pieces, job));
  }

  simulateCube(options: lib.CubeOptions, job?: JobOptions): Promise<lib.CubeResult> {
    return this.#one('simulateCube', [options], job);
  }

  processCube(cube: lib.ComplexData, options: lib.CubeChainOptions, job?: JobOptions): Promise<lib.FrameResult[]> {
    return this.#one('processCube', [cube, options], job, options?.angle?.network);
  }

  /** What is known of a capture before any processing. */
  captureInfo(bytes: lib.BytesInput, config: lib.TextInput, job?: JobOptions): Promise<lib.CaptureInfo> {
    return this.#one('captureInfo', [bytes, config], job);
  }

  /** Detections of one frame. */
  processFrame(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    frame: number,
    options?: lib.ChainOptions,
    job?: JobOptions,
  ): Promise<lib.FrameResult> {
    return this.#one('processFrame', [bytes, config, frame, options], job, options?.angle?.network);
  }

  /** Detections of every frame, each by itself, split over the workers; progress counts frames. */
  async processFrames(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    options?: lib.ChainOptions,
    job: JobOptions = {},
  ): Promise<lib.FrameResult[]> {
    const { signal } = job;
    const { frameBytes } = await this.parseConfig(config, signal ? { signal } : {});
    const all = bytes instanceof ArrayBuffer ? new Uint8Array(bytes) : bytes;
    // Without a whole frame one worker gets the bytes, for its error.
    const frames = Math.max(1, Math.floor(all.byteLength / frameBytes));
    const pieces = split(frames, this.workers).map(
      ({ first, count }): Piece<'processStretch'> => ({
        name: 'processStretch',
        args: [all.subarray(first * frameBytes, (first + count) * frameBytes), config, first, options],
        units: count,
        network: options?.angle?.network,
      }),
    );
    return (await this.#crew.run(pieces, { ...job, transfer: false })).flat();
  }

  /** Detections of all frames, or of some, together. */
  combineFrames(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    options?: lib.CombineOptions,
    job?: JobOptions,
  ): Promise<lib.FrameResult> {
    return this.#one('combineFrames', [bytes, config, options], job, options?.angle?.network);
  }

  /** Snapshots of a cell (elements x frames). */
  cellSnapshots(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    cell: lib.Cell,
    options?: lib.ChainOptions,
    job?: JobOptions,
  ): Promise<lib.ComplexData> {
    return this.#one('cellSnapshots', [bytes, config, cell, options], job);
  }

  /** Angles and spectrum of a cell by any method. */
  cellSpectrum(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    cell: lib.Cell,
    angle?: lib.AngleOptions,
    options?: lib.ChainOptions,
    job?: JobOptions,
  ): Promise<lib.Estimate> {
    return this.#one('cellSpectrum', [bytes, config, cell, angle, options], job, angle?.network);
  }

  /** A drive from its files; progress is told at the end alone. */
  readDrive(files: readonly lib.DriveFile[], options?: lib.ReadDriveOptions, job?: JobOptions): Promise<lib.Drive> {
    return this.#one('readDrive', [files, options], job);
  }

  /** Progress counts scans. */
  simulateDrive(options?: lib.SimulateDriveOptions, job?: JobOptions): Promise<lib.SimulatedDrive> {
    return this.#one('simulateDrive', [options], job);
  }

  driveScenarios(job?: JobOptions): Promise<lib.DriveScenarioInfo[]> {
    return this.#one('driveScenarios', [], job);
  }

  /** A frame as views of the drive's arrays, made here: it costs less than asking a worker. */
  async driveFrame(drive: lib.DriveData, scan: number, gap?: lib.MotionGap): Promise<lib.DriveFrame> {
    return driveFrame(drive, scan, gap);
  }

  /** The angle of one radar of a drive, of which only that radar's scans are sent; progress counts frames. */
  async calibrateDrive(
    drive: lib.DriveData,
    options?: lib.CalibrateDriveOptions,
    job: JobOptions = {},
  ): Promise<lib.DriveCalibration> {
    job.signal?.throwIfAborted();
    const { radars } = taskOf(viewOf(drive), options);
    const part = selected(
      drive,
      radars.map(({ sensor }) => sensor),
    );
    const result = await this.#one('calibrateDrive', [part.drive, options], { ...job, transfer: true });
    return numbered(result, part.scans);
  }

  /** The angles of several radars together; progress counts frames. */
  async jointCalibration(
    drive: lib.DriveData,
    options?: lib.JointCalibrationOptions,
    job: JobOptions = {},
  ): Promise<lib.DriveCalibration[]> {
    job.signal?.throwIfAborted();
    const { radars } = jointTaskOf(viewOf(drive), options);
    const part = selected(
      drive,
      radars.map(({ sensor }) => sensor),
    );
    const results = await this.#one('jointCalibration', [part.drive, options], { ...job, transfer: true });
    return results.map((result) => numbered(result, part.scans));
  }

  trajectory(
    frames: lib.CalibratedFrames,
    mounting: { angleDeg: number; xM: number; yM?: number },
    options?: lib.TrajectoryOptions,
    job?: JobOptions,
  ): Promise<lib.Trajectory | null> {
    return this.#one('trajectory', [frames, mounting, options], job);
  }

  relativeTrajectoryError(
    estimated: lib.Trajectory,
    truth: lib.Trajectory,
    segmentM?: number,
    job?: JobOptions,
  ): Promise<number | null> {
    return this.#one('relativeTrajectoryError', [estimated, truth, segmentM], job);
  }

  waveformSummary(waveform: lib.Waveform, job?: JobOptions): Promise<lib.WaveformSummary> {
    return this.#one('waveformSummary', [waveform], job);
  }

  parseConfig(text: lib.TextInput, job?: JobOptions): Promise<lib.RadarConfig> {
    return this.#one('parseConfig', [text], job);
  }

  parseBoardLog(bytes: lib.BytesInput, config?: lib.TextInput, job?: JobOptions): Promise<lib.BoardLog> {
    return this.#one('parseBoardLog', [bytes, config], job);
  }

  readNpy(bytes: lib.BytesInput, job?: JobOptions): Promise<lib.NpyArray> {
    return this.#one('readNpy', [bytes], job);
  }

  writeNpy(array: lib.NpyArray, job?: JobOptions): Promise<Uint8Array> {
    return this.#one('writeNpy', [array], job);
  }

  readDetectionsCsv(table: lib.TextInput, job?: JobOptions): Promise<lib.Detection[]> {
    return this.#one('readDetectionsCsv', [table], job);
  }

  writeDetectionsCsv(detections: readonly lib.Detection[], job?: JobOptions): Promise<string> {
    return this.#one('writeDetectionsCsv', [detections], job);
  }

  readSnapshotsCsv(table: lib.TextInput, job?: JobOptions): Promise<lib.ComplexData> {
    return this.#one('readSnapshotsCsv', [table], job);
  }

  writeSnapshotsCsv(snapshots: lib.ComplexData, job?: JobOptions): Promise<string> {
    return this.#one('writeSnapshotsCsv', [snapshots], job);
  }

  /** Estimates of many inputs, split over the workers; progress counts inputs. */
  async estimateMany(
    inputs: readonly lib.EstimateInput[],
    options: lib.EstimatorOptions,
    job?: JobOptions,
  ): Promise<lib.Estimate[]> {
    const pieces = split(inputs.length, this.workers).map(
      ({ first, count }): Piece<'estimateMany'> => ({
        name: 'estimateMany',
        args: [inputs.slice(first, first + count), options],
        units: count,
        network: options?.network,
      }),
    );
    return (await this.#crew.run(pieces, job)).flat();
  }

  /** Estimates of a batch of cells, split over the workers; progress counts cells. */
  async estimateBatch(
    input: lib.BatchInput,
    options: lib.EstimatorOptions & lib.BatchOptions,
    job?: JobOptions,
  ): Promise<lib.BatchEstimate> {
    const pieces = stretchesOf(input, this.workers).map(
      ({ input, cells }): Piece<'estimateBatch'> => ({
        name: 'estimateBatch',
        args: [input, options],
        units: cells,
        network: options?.network,
      }),
    );
    const [first, ...rest] = await this.#crew.run(pieces, job);
    return joinedBatches([first as lib.BatchEstimate, ...rest]);
  }

  streetScene(options?: lib.StreetOptions, job?: JobOptions): Promise<lib.StreetScene> {
    return this.#one('streetScene', [options], job);
  }

  simulateStreet(options: lib.SimulateStreetOptions, job?: JobOptions): Promise<lib.SimulatedStreet> {
    return this.#one('simulateStreet', [options], job);
  }

  frameCells(cube: lib.ComplexData, options: lib.CubeChainOptions, job?: JobOptions): Promise<lib.FrameCells> {
    return this.#one('frameCells', [cube, options], job);
  }

  /** Detected cells of one frame of a capture. */
  captureCells(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    frame: number,
    options?: lib.ChainOptions,
    job?: JobOptions,
  ): Promise<lib.FrameCells> {
    return this.#one('captureCells', [bytes, config, frame, options], job);
  }

  rangeAzimuthMap(input: lib.RangeAzimuthMapInput, job?: JobOptions): Promise<lib.RangeAzimuthMap> {
    return this.#one('rangeAzimuthMap', [input], job);
  }

  birdsEyeView(input: lib.BirdsEyeViewInput, job?: JobOptions): Promise<lib.BirdsEyeView> {
    return this.#one('birdsEyeView', [input], job);
  }

  sidelobeMeasure(
    view: lib.BirdsEyeView,
    targets: readonly { xM: number; yM: number }[],
    gate: lib.Gate,
    job?: JobOptions,
  ): Promise<lib.SidelobeMeasure> {
    return this.#one('sidelobeMeasure', [view, targets, gate], job);
  }

  imagePlan(options: lib.ImageFrameOptions, job?: JobOptions): Promise<lib.ImagePlan> {
    return this.#one('imagePlan', [options], job);
  }

  /**
   * From a cube of one frame to its map. One worker finds the cells (with `transfer` the cube moves there instead of
   * being copied), all estimate their angles; progress counts cells.
   */
  async imageFrame(
    cube: lib.ComplexData,
    options: lib.ImageFrameOptions,
    job: JobOptions = {},
  ): Promise<lib.ImageFrame> {
    const { onProgress: _, ...quiet } = job;
    const cells = await this.frameCells(cube, chainOf(options), quiet);
    return this.imageCells(cells, options, { ...job, transfer: false });
  }

  /** From the cells of a frame to its map; the same cells serve every method. Progress counts cells. */
  async imageCells(
    cells: lib.FrameCells,
    options: lib.ImageFrameOptions,
    job: JobOptions = {},
  ): Promise<lib.ImageFrame> {
    const { onProgress: _, ...quiet } = job;
    const { estimator, from, grid } = await this.imagePlan(options, quiet);
    const spectra = from === 'spectra';
    const estimates = await this.estimateBatch({ snapshots: cells.snapshots }, { ...estimator, spectra }, job);
    const map = await this.rangeAzimuthMap({ cells, estimates, from, grid }, quiet);
    return { map, cells, estimates };
  }

  /** Ends the workers; jobs under way reject with the code `terminated`. */
  terminate(): void {
    this.#crew.terminate();
  }

  async #one<N extends OperationName>(
    name: N,
    args: Parameters<Operations[N]>,
    job?: JobOptions,
    network?: string,
  ): Promise<ReturnType<Operations[N]>> {
    const [result] = await this.#crew.run([{ name, args, units: 1, network }], job);
    return result as ReturnType<Operations[N]>;
  }
}

/** A calibration of a part of a drive, its scans by their numbers in the whole. */
function numbered(result: lib.DriveCalibration, scans: Uint32Array): lib.DriveCalibration {
  const scan = result.frames.scan.map((index) => scans[index] ?? 0);
  return { ...result, frames: { ...result.frames, scan } };
}

/** The scenes of several results, one after another. */
function joinedScenes(results: lib.SnapshotResult[]): lib.SnapshotResult {
  const [, elements, snapshots] = results[0]?.shape ?? [0, 0, 0];
  const truth = results.flatMap((result) => result.truth);
  const data = joined(results.map((result) => result.data));
  return { data, shape: [truth.length, elements, snapshots], truth };
}
