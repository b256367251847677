// The pool: the functions of the package as promises, those that are split over workers, and what the pool keeps.
import { driveFrame } from '../lib/drive/frame.js';
import { jointTaskOf, needsMore, type Radar, reportTaskOf, taskOf } from '../lib/drive/radars.js';
import { selected, viewOf } from '../lib/drive/view.js';
import { reading, wrong } from '../lib/runtime/errors.js';
import type * as lib from '../lib/types.js';
import { joined, joinedBatches, stretchesOf } from './batch.js';
import { type OnKept, PoolCapture } from './capture.js';
import { checkedJob, type JobOptions, passedOn, rejectTyped } from './job.js';
import type { PoolOptions } from './options.js';
import { Crew, type Piece, type Runtime } from './pool.js';
import { argumentCounts, type PromisedFunctions } from './promised.js';
import type { OperationName, Operations } from './protocol.js';
import { partsOf, piecesOf } from './recording.js';
import { split } from './split.js';
import { packed } from './transfer.js';

/** What runs a network where options name one. */
const withNetworks: readonly OperationName[] = [
  'estimate',
  'estimateRegion',
  'processCube',
  'processFrame',
  'combineFrames',
  'cellSpectrum',
];

export interface Pool extends PromisedFunctions {}

/** A pool of workers with the functions of the package. Workers start when there is work. */
// biome-ignore lint/suspicious/noUnsafeDeclarationMerging: see above
export class Pool {
  readonly #crew: Crew;

  static {
    for (const [name, count] of Object.entries(argumentCounts) as [keyof typeof argumentCounts, number][]) {
      const value = function (this: Pool, ...given: unknown[]): Promise<unknown> {
        const args = Array.from({ length: count }, (_, index) => given[index]);
        return this.#one(name, args as Parameters<Operations[typeof name]>, given[count] as JobOptions);
      };
      Object.defineProperty(Pool.prototype, name, { value, configurable: true, writable: true });
    }
    const inPlace = ['constructor', 'workers', 'unloadNetwork', 'terminate'];
    rejectTyped(
      Pool.prototype,
      Object.getOwnPropertyNames(Pool.prototype).filter((name) => !inPlace.includes(name)),
    );
  }

  /** @internal */
  constructor(runtime: Runtime, options?: PoolOptions) {
    this.#crew = new Crew(runtime, options);
  }

  /** Most workers that run at a time; 0 where the calling thread does the work. */
  get workers(): number {
    return this.#crew.workers;
  }

  /**
   * Loads a network from its ONNX file: once to see that it is one, then in each worker that comes to need it. Its id
   * is what `network` in options names it by, for the methods `aaetr`, `dnn` and `cnn3d`; that of a counting network for
   * any other method with `sources: 'network'`.
   */
  async loadNetwork(file: lib.NetworkFile, job?: JobOptions): Promise<lib.NetworkInfo> {
    const { value } = packed({ onnx: file.onnx, ...(file.card !== undefined && { card: file.card }) }, false);
    const id = this.#crew.addNetwork(value);
    try {
      return await this.#one('loadNetwork', [id], job, { network: id });
    } catch (thrown) {
      this.#crew.remove('network', id);
      throw thrown;
    }
  }

  /** Forgets a network and gives its memory back; whether there was one. */
  unloadNetwork(id: string): boolean {
    return this.#crew.remove('network', id);
  }

  /** Counts sources with a counting network. */
  countWithNetwork(id: string, input: lib.EstimateInput, job?: JobOptions): Promise<lib.SourceProbabilities> {
    return this.#one('countWithNetwork', [id, input], job, { network: id });
  }

  /** Runs the graph of a network as it is: named inputs to named outputs. */
  runNetwork(
    id: string,
    inputs: Readonly<Record<string, lib.Tensor>>,
    job?: JobOptions,
  ): Promise<Record<string, lib.Tensor>> {
    return this.#one('runNetwork', [id, inputs], job, { network: id });
  }

  /** Estimates from the range bins around a peak, [65 bins, 8 elements, 4 chirps], with a network. */
  estimateRegion(
    region: lib.ComplexData,
    options: lib.EstimatorOptions & { network: string },
    job?: JobOptions,
  ): Promise<lib.Estimate> {
    return this.#one('estimateRegion', [region, options], job);
  }

  /**
   * Regions of each frame of a cube, found along range, their targets counted by one network and told apart by one of
   * two others (Figure 4 of Sang et al. 2021).
   */
  cubeRegions(
    networks: lib.RegionNetworkIds,
    cube: lib.ComplexData,
    options: lib.CubeRegionOptions,
    job?: JobOptions,
  ): Promise<lib.RegionFrame[]> {
    return this.#one('cubeRegions', [networks, cube, options], job, { network: idsOf(networks) });
  }

  /** The same of every frame of a capture, split over the workers; progress counts frames. */
  async captureRegions(
    networks: lib.RegionNetworkIds,
    bytes: lib.BytesInput,
    given: lib.ConfigInput,
    options?: lib.CaptureRegionOptions,
    job: JobOptions = {},
  ): Promise<lib.RegionFrame[]> {
    const network = idsOf(networks);
    const config = await this.#settled(bytes, given, job);
    const pieces = (await this.#stretches(bytes, config, job)).map(
      ({ part, first, count }): Piece<'regionStretch'> => ({
        name: 'regionStretch',
        args: [networks, part, config, first, options],
        units: count,
        network,
      }),
    );
    return (await this.#crew.run(pieces, { ...job, transfer: false })).flat();
  }

  /** Scenes are split over the workers; progress counts scenes. */
  async simulateSnapshots(options: lib.SnapshotOptions, job?: JobOptions): Promise<lib.SnapshotResult> {
    const { scenes = 1, firstScene = 0 } = options;
    if (!Number.isInteger(scenes) || scenes < 2) return this.#one('simulateSnapshots', [options], job);
    const pieces = split(scenes, this.#crew.pieces).map(
      ({ first, count }): Piece<'simulateSnapshots'> => ({
        name: 'simulateSnapshots',
        args: [{ ...options, scenes: count, firstScene: firstScene + first }],
        units: count,
      }),
    );
    return joinedScenes(await this.#crew.run(pieces, job));
  }

  /**
   * Keeps a capture, so that jobs on it need not bring its bytes. They are not copied here: they must stay as they are
   * until the capture is freed.
   */
  async loadCapture(bytes: lib.BytesInput, config: lib.ConfigInput, job?: JobOptions): Promise<PoolCapture> {
    const own = bytes instanceof ArrayBuffer ? new Uint8Array(bytes) : bytes;
    if (!(own instanceof Uint8Array)) throw wrong('capture', 'a Uint8Array or an ArrayBuffer', own);
    const id = this.#crew.addCapture({ bytes: own });
    const forget = (): void => void this.#crew.remove('capture', id);
    try {
      const run: OnKept = (name, args, options) => this.#one(name, args, options, { capture: id });
      const info = await run('captureInfo', [{ capture: id }, config], { ...job, transfer: false });
      return new PoolCapture(this, { id, bytes: own, config: settled(config, info), info }, { run, forget });
    } catch (thrown) {
      forget();
      throw thrown;
    }
  }

  /** What is known of a capture before any processing. */
  captureInfo(bytes: lib.BytesInput, config: lib.ConfigInput, job?: JobOptions): Promise<lib.CaptureInfo> {
    return this.#one('captureInfo', [bytes, config], job);
  }

  /** Detections of every frame, each by itself, split over the workers; progress counts frames. */
  async processFrames(
    bytes: lib.BytesInput,
    given: lib.ConfigInput,
    options?: lib.ChainOptions,
    job: JobOptions = {},
  ): Promise<lib.FrameResult[]> {
    const config = await this.#settled(bytes, given, job);
    const pieces = (await this.#stretches(bytes, config, job)).map(
      ({ part, first, count }): Piece<'processStretch'> => ({
        name: 'processStretch',
        args: [part, config, first, options],
        units: count,
        network: options?.angle?.network,
      }),
    );
    return (await this.#crew.run(pieces, { ...job, transfer: false })).flat();
  }

  /** Detections of all frames, or of some, together. */
  combineFrames(
    bytes: lib.BytesInput,
    config: lib.ConfigInput,
    options?: lib.CombineOptions,
    job?: JobOptions,
  ): Promise<lib.FrameResult> {
    return this.#one('combineFrames', [bytes, config, options], job);
  }

  /** What calibrates the array of a cube; progress counts frames read. */
  calibrateCubeArray(
    cube: lib.ComplexData,
    options: lib.CubeCalibrationOptions,
    job?: JobOptions,
  ): Promise<lib.ArrayCalibrationResult> {
    return this.#one('calibrateCubeArray', [cube, options], job);
  }

  /** What calibrates the array of a capture: its own strong cells, or reflectors. */
  captureCalibration(
    bytes: lib.BytesInput,
    config: lib.TextInput,
    options?: lib.CaptureCalibrationOptions,
    job?: JobOptions,
  ): Promise<lib.ArrayCalibrationResult> {
    return this.#one('captureCalibration', [bytes, config, options], job);
  }

  /**
   * Reads a drive from an MCAP file (a ROS 2 bag), or from the parts of one in their order, of which no more than a piece
   * is held at a time: a `File` or other `Blob`, or anything that gives bytes, such as a stream. Progress counts bytes;
   * their total is 0 where it is not known.
   */
  async readDriveStream(
    recording: lib.Recording | readonly lib.Recording[],
    options?: lib.ReadDriveOptions,
    job: JobOptions = {},
  ): Promise<lib.Drive> {
    const { onProgress, ...quiet } = checkedJob(job);
    const parts = partsOf(recording);
    const stream = this.#crew.addStream({ options });
    let pieces = 0;
    try {
      for await (const { bytes, own, last, done, total } of piecesOf(parts)) {
        const args = [stream, pieces, bytes, last] as const;
        await this.#one('pushDrive', [...args], { ...quiet, transfer: own || (quiet.transfer ?? false) }, { stream });
        pieces += 1;
        report(onProgress, done, total);
      }
      return await this.#one('finishDrive', [stream, pieces], quiet, { stream });
    } finally {
      this.#crew.remove('stream', stream);
    }
  }

  /** Progress counts scans. */
  simulateDrive(options?: lib.SimulateDriveOptions, job?: JobOptions): Promise<lib.SimulatedDrive> {
    return this.#one('simulateDrive', [options], job);
  }

  /** A frame as views of the drive's arrays, made here: it costs less than asking a worker. */
  async driveFrame(drive: lib.DriveData, scan: number, motion: lib.ScanMotion): Promise<lib.DriveFrame> {
    return driveFrame(drive, scan, motion);
  }

  /** The car's motion at each scan, for which the detections are not sent. */
  async scanMotion(
    drive: Pick<lib.DriveData, 'scans' | 'motion'>,
    gap?: lib.MotionGap,
    job?: JobOptions,
  ): Promise<lib.ScanMotion> {
    checkedJob(job).signal?.throwIfAborted();
    const { scans, motion } = drive;
    return this.#one('scanMotion', [{ scans, motion }, gap], job);
  }

  /** The angle of one radar of a drive, of which only that radar's scans are sent; progress counts frames. */
  async calibrateDrive(
    drive: lib.DriveData,
    options?: lib.CalibrateDriveOptions,
    job: JobOptions = {},
  ): Promise<lib.DriveCalibration> {
    checkedJob(job).signal?.throwIfAborted();
    const { radars } = taskOf(viewOf(drive), options);
    const part = partOf(drive, radars);
    const result = await this.#one('calibrateDrive', [part.drive, copied(options)], { ...job, transfer: true });
    return numbered(result, part.scans);
  }

  /** The angles of several radars together; progress counts frames. */
  async jointCalibration(
    drive: lib.DriveData,
    options?: lib.JointCalibrationOptions,
    job: JobOptions = {},
  ): Promise<lib.DriveCalibration[]> {
    checkedJob(job).signal?.throwIfAborted();
    const { radars } = jointTaskOf(viewOf(drive), options);
    const part = partOf(drive, radars);
    const results = await this.#one('jointCalibration', [part.drive, copied(options)], { ...job, transfer: true });
    return results.map((result) => numbered(result, part.scans));
  }

  /** A report of a calibration, as the package's function gives it; progress counts frames. */
  async calibrationReport(
    drive: lib.DriveData,
    about?: lib.ReportAbout,
    options?: lib.CalibrateDriveOptions | lib.JointCalibrationOptions,
    job: JobOptions = {},
  ): Promise<string> {
    checkedJob(job).signal?.throwIfAborted();
    const { radars } = reportTaskOf(viewOf(drive), options);
    const part = partOf(drive, radars);
    return this.#one('calibrationReport', [part.drive, about, copied(options)], { ...job, transfer: true });
  }

  /** Estimates of many inputs, split over the workers; progress counts inputs. */
  async estimateMany(
    inputs: readonly lib.EstimateInput[],
    options: lib.EstimatorOptions,
    job?: JobOptions,
  ): Promise<lib.Estimate[]> {
    const pieces = split(inputs.length, this.#crew.pieces).map(
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
    const pieces = stretchesOf(input, this.#crew.pieces).map(
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

  /**
   * From a cube of one frame to its map. One worker finds the cells (with `transfer` the cube moves there instead of
   * being copied), all estimate their angles; progress counts cells.
   */
  async imageFrame(
    cube: lib.ComplexData,
    options: lib.ImageFrameOptions,
    job: JobOptions = {},
  ): Promise<lib.ImageFrame> {
    const { onProgress: _, ...quiet } = checkedJob(job);
    const { chain } = await this.imagePlan(options, quiet);
    const cells = await this.frameCells(cube, chain, quiet);
    return this.imageCells(cells, options, { ...job, transfer: false });
  }

  /** From the cells of a frame to its map; the same cells serve every method. Progress counts cells. */
  async imageCells(
    cells: lib.FrameCells,
    options: lib.ImageFrameOptions,
    job: JobOptions = {},
  ): Promise<lib.ImageFrame> {
    const { onProgress: _, ...quiet } = checkedJob(job);
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

  /** What a part of a capture is read by: what the whole of it tells. */
  async #settled(bytes: lib.BytesInput, config: lib.ConfigInput, job: JobOptions): Promise<lib.ConfigInput> {
    if (!asksData(config)) return config;
    const { signal } = checkedJob(job);
    return settled(config, await this.captureInfo(bytes, config, { transfer: false, ...(signal && { signal }) }));
  }

  /** The frames of a capture in stretches, one a worker. */
  async #stretches(
    bytes: lib.BytesInput,
    config: lib.ConfigInput,
    job: JobOptions,
  ): Promise<{ part: Uint8Array; first: number; count: number }[]> {
    const { signal } = checkedJob(job);
    const { frameBytes } = await this.parseConfig(config, signal ? { signal } : {});
    const all = bytes instanceof ArrayBuffer ? new Uint8Array(bytes) : bytes;
    // Without a whole frame one worker gets the bytes, for its error.
    const frames = Math.max(1, Math.floor(all.byteLength / frameBytes));
    return split(frames, this.#crew.pieces).map(({ first, count }) => ({
      part: all.subarray(first * frameBytes, (first + count) * frameBytes),
      first,
      count,
    }));
  }

  async #one<N extends OperationName>(
    name: N,
    args: Parameters<Operations[N]>,
    job?: JobOptions,
    kept?: { network?: string | readonly string[]; capture?: string; stream?: string },
  ): Promise<ReturnType<Operations[N]>> {
    const network = withNetworks.includes(name) ? networkIn(args) : undefined;
    const [result] = await this.#crew.run([{ name, args, units: 1, network, ...kept }], job);
    return result as ReturnType<Operations[N]>;
  }
}

/** Whether the order of I and Q is to be found in the samples. */
const asksData = (config: lib.ConfigInput): config is lib.ReadingConfig =>
  typeof config === 'object' && config !== null && 'iqOrder' in config && config.iqOrder === 'auto';

/** A configuration with the order of I and Q that was found. */
function settled(config: lib.ConfigInput, info: lib.CaptureInfo): lib.ConfigInput {
  return asksData(config) ? { ...config, iqOrder: info.config.iqOrder } : config;
}

/** Says how far a job is. */
function report(onProgress: JobOptions['onProgress'], done: number, total: number): void {
  try {
    onProgress?.(done, total);
  } catch (thrown) {
    throw passedOn(thrown);
  }
}

/** The network that options among the arguments name: those of an estimator, or of the angles of a chain. */
function networkIn(args: readonly unknown[]): string | undefined {
  for (const arg of args as ({ network?: string; angle?: { network?: string } } | null | undefined)[]) {
    const network = arg?.network ?? arg?.angle?.network;
    if (network !== undefined) return network;
  }
  return undefined;
}

/** The networks of regions, each once. */
function idsOf(networks: lib.RegionNetworkIds): string[] {
  const { counting, one, two } = networks ?? {};
  return [...new Set([counting, one, two])].filter((id): id is string => id !== undefined);
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

/** What a worker needs of a drive for some radars. */
const partOf = (drive: lib.DriveData, radars: readonly Radar[]): ReturnType<typeof selected> =>
  selected(
    drive,
    radars.map(({ sensor }) => sensor),
    needsMore(radars),
  );

/** Options whose typed arrays can be given away: the caller keeps theirs. */
const copied = <T>(options: T): T => reading('options', () => packed(options, false).value);
