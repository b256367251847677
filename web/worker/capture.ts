// A capture that the pool keeps.
import type { Capture } from '../lib/capture/capture.js';
import { failure } from '../lib/runtime/errors.js';
import type * as lib from '../lib/types.js';
import type { Pool } from './api.js';
import type { JobOptions } from './job.js';
import type { AllPromised } from './promised.js';
import type { OperationName, Operations } from './protocol.js';

type Functions = AllPromised<
  Pick<Capture, 'processFrame' | 'frameCells' | 'cellSnapshots' | 'explainCell' | 'cellSpectrum'>
>;

/** Runs an operation whose first argument is the kept capture. */
export type OnKept = <N extends OperationName>(
  name: N,
  args: Parameters<Operations[N]>,
  job: JobOptions,
) => Promise<ReturnType<Operations[N]>>;

/**
 * A capture on a pool, until `free()`: a worker gets its bytes once, not with each job, and of what concerns one frame
 * that frame alone. They must not change meanwhile.
 */
export class PoolCapture implements Functions {
  /** What is known before any processing. */
  readonly info: lib.CaptureInfo;
  readonly #pool: Pool;
  readonly #id: string;
  readonly #bytes: Uint8Array;
  readonly #config: lib.ConfigInput;
  readonly #run: OnKept;
  readonly #forget: () => void;

  /** @internal */
  constructor(
    pool: Pool,
    kept: { id: string; bytes: Uint8Array; config: lib.ConfigInput; info: lib.CaptureInfo },
    work: { run: OnKept; forget: () => void },
  ) {
    this.#pool = pool;
    this.#id = kept.id;
    this.#bytes = kept.bytes;
    this.#config = kept.config;
    this.info = kept.info;
    this.#run = work.run;
    this.#forget = work.forget;
  }

  /** Detections of one frame, from 0. */
  async processFrame(frame: number, options?: lib.ChainOptions, job?: JobOptions): Promise<lib.FrameResult> {
    const part = this.#frame(frame);
    if (!part) return this.#run('processFrame', [this.#kept, this.#config, frame, options], kept(job));
    const result = await this.#pool.processFrame(part, this.#config, 0, options, kept(job));
    for (const one of [result, ...result.detections]) one.frame = frame;
    return result;
  }

  /** Detections of every frame, each by itself, split over the workers; progress counts frames. */
  processFrames(options?: lib.ChainOptions, job?: JobOptions): Promise<lib.FrameResult[]> {
    return this.#pool.processFrames(this.#bytes, this.#config, options, kept(job));
  }

  /** Regions of every frame and their targets, split over the workers; progress counts frames. */
  regions(
    networks: lib.RegionNetworkIds,
    options?: lib.CaptureRegionOptions,
    job?: JobOptions,
  ): Promise<lib.RegionFrame[]> {
    return this.#pool.captureRegions(networks, this.#bytes, this.#config, options, kept(job));
  }

  /** Regions of one frame. */
  async frameRegions(
    networks: lib.RegionNetworkIds,
    frame: number,
    options?: lib.CaptureRegionOptions,
    job?: JobOptions,
  ): Promise<lib.RegionFrame> {
    const part = this.#frame(frame);
    if (!part)
      throw failure('out-of-range', { what: 'frame', expected: `0 to ${this.info.frames - 1}`, given: String(frame) });
    const [result] = await this.#pool.captureRegions(networks, part, this.#config, options, kept(job));
    return { ...(result as lib.RegionFrame), frame };
  }

  /** Detected cells of one frame, with what estimators take; angles are not estimated. */
  frameCells(frame: number, options?: lib.ChainOptions, job?: JobOptions): Promise<lib.FrameCells> {
    const part = this.#frame(frame);
    if (!part) return this.#run('captureCells', [this.#kept, this.#config, frame, options], kept(job));
    return this.#pool.captureCells(part, this.#config, 0, options, kept(job));
  }

  /** Detections of all frames, or of some, together. */
  combineFrames(options?: lib.CombineOptions, job?: JobOptions): Promise<lib.FrameResult> {
    return this.#run('combineFrames', [this.#kept, this.#config, options], kept(job));
  }

  /** Gain and phase of each channel of the array, from reflectors or from strong cells with one target. */
  calibrateArray(options?: lib.CaptureCalibrationOptions, job?: JobOptions): Promise<lib.ArrayCalibrationResult> {
    return this.#run('captureCalibration', [this.#kept, this.#config, options], kept(job));
  }

  /** Snapshots of a cell (elements x frames), compensated for the transmitters' turns. */
  cellSnapshots(cell: lib.Cell, options?: lib.ChainOptions, job?: JobOptions): Promise<lib.ComplexData> {
    const part = this.#frame(cell?.frame);
    return part
      ? this.#pool.cellSnapshots(part, this.#config, { ...cell, frame: 0 }, options, kept(job))
      : this.#run('cellSnapshots', [this.#kept, this.#config, cell, options], kept(job));
  }

  /** Why a cell is a detection or none: its power, noise and threshold, and what became of it. */
  explainCell(cell: lib.Cell, options?: lib.ChainOptions, job?: JobOptions): Promise<lib.CellExplanation> {
    const part = this.#frame(cell?.frame);
    return part
      ? this.#pool.explainCell(part, this.#config, { ...cell, frame: 0 }, options, kept(job))
      : this.#run('explainCell', [this.#kept, this.#config, cell, options], kept(job));
  }

  /** Angles and spectrum of a cell by any method. */
  cellSpectrum(
    cell: lib.Cell,
    angle?: lib.AngleOptions,
    options?: lib.ChainOptions,
    job?: JobOptions,
  ): Promise<lib.Estimate> {
    const part = this.#frame(cell?.frame);
    return part
      ? this.#pool.cellSpectrum(part, this.#config, { ...cell, frame: 0 }, angle, options, kept(job))
      : this.#run('cellSpectrum', [this.#kept, this.#config, cell, angle, options], kept(job));
  }

  /** Gives the memory in the workers back; jobs with it then reject with the code `unknown-capture`. */
  free(): void {
    this.#forget();
  }

  get #kept(): { capture: string } {
    return { capture: this.#id };
  }

  /** The bytes of a frame, where there is one of that number. */
  #frame(frame: number | undefined): Uint8Array | undefined {
    const { frameBytes } = this.info.config;
    if (frame === undefined || !Number.isInteger(frame) || frame < 0 || frame >= this.info.frames) return undefined;
    return this.#bytes.subarray(frame * frameBytes, (frame + 1) * frameBytes);
  }
}

/** What is kept is not given away. */
const kept = (job: JobOptions | undefined): JobOptions => ({ ...job, transfer: false });
