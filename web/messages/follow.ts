/** A calibration that follows scans and motion as they come, in bounded memory however long they do. */
import {
  BoresightError,
  Calibration,
  type CalibrationFrame,
  type CalibrationOptions,
  type CalibrationOutlook,
  type CalibrationResult,
  type FrameOutcome,
  scanMotion,
} from 'boresight';
import type { MotionSample } from './motion.ts';
import type { Scan } from './scan.ts';

/** Longest gap between samples of the motion that is bridged; how long a scan waits for the next one. */
const GAP_S = 0.25;
/** What is kept of the motion. */
const MOTION_S = 4;
const MOST_SAMPLES = 8192;
/** Scans that wait for motion. */
const MOST_WAITING = 256;
/** Times that run back by more are of another drive, or of the same once more. */
const BACK_S = 1;
/** Least time between two angles. */
const STEP_S = 1;

/** What a calibration is made with; only the recursive method forgets frames. */
export type FollowOptions = Omit<CalibrationOptions, 'method'>;

/** A scan with the motion at its time, and what became of it. */
export interface Followed {
  scan: Scan;
  frame: CalibrationFrame;
  outcome: FrameOutcome;
}

/** What is told as scans are taken. */
export interface Told {
  scan?(followed: Followed): void;
  /** About once a second of the drive. */
  angle?(timeS: number, result: CalibrationResult): void;
  /** Times ran back: all begins anew. */
  restarted?(): void;
}

/** What became of what came. */
export interface FollowCounts {
  scans: number;
  motion: number;
  /** Older than what was taken before, or without a time. */
  late: number;
  /** Refused by the calibration. */
  refused: number;
  /** Detections without finite numbers. */
  incomplete: number;
  restarts: number;
}

const NO_COUNTS: FollowCounts = { scans: 0, motion: 0, late: 0, refused: 0, incomplete: 0, restarts: 0 };

/** Needs `initDrives()`. */
export class Follower {
  readonly #options: FollowOptions;
  readonly #told: Told;
  #calibration: Calibration;
  readonly #counts = { ...NO_COUNTS };
  #problem: string | null = null;
  #waiting: Scan[] = [];
  #motion: MotionSample[] = [];
  #newestS = Number.NEGATIVE_INFINITY;
  #lastS = Number.NEGATIVE_INFINITY;
  #dueS = Number.NEGATIVE_INFINITY;

  constructor(options: FollowOptions, told: Told = {}) {
    this.#options = options;
    this.#told = told;
    this.#calibration = new Calibration({ ...options, method: 'recursive' });
  }

  get counts(): Readonly<FollowCounts> {
    return this.#counts;
  }

  /** Scans that wait for motion. */
  get waiting(): number {
    return this.#waiting.length;
  }

  /** What the calibration said of the last frame that it refused. */
  get problem(): string | null {
    return this.#problem;
  }

  estimate(): CalibrationResult {
    return this.#calibration.estimate();
  }

  /** What driving on would bring. */
  outlook(): CalibrationOutlook | null {
    return this.#calibration.outlook();
  }

  addMotion(sample: MotionSample): void {
    const lastS = this.#motion.at(-1)?.timeS ?? Number.NEGATIVE_INFINITY;
    if (!this.#inTime(sample.timeS, lastS)) return;
    this.#counts.motion += 1;
    this.#motion.push(sample);
    this.#forget(sample.timeS);
    this.#take();
  }

  addScan(scan: Scan): void {
    const lastS = this.#waiting.at(-1)?.timeS ?? this.#lastS;
    if (!this.#inTime(scan.timeS, lastS)) return;
    this.#counts.scans += 1;
    this.#counts.incomplete += scan.incomplete;
    this.#waiting.push(scan);
    this.#take();
  }

  /** Begins anew: another drive, or another part of it. */
  restart(): void {
    this.#calibration.free();
    this.#calibration = new Calibration({ ...this.#options, method: 'recursive' });
    [this.#waiting, this.#motion] = [[], []];
    this.#newestS = this.#lastS = this.#dueS = Number.NEGATIVE_INFINITY;
    this.#counts.restarts += 1;
    this.#told.restarted?.();
  }

  free(): void {
    this.#calibration.free();
  }

  /** Whether a time comes after those before; restarts where it is far behind them. */
  #inTime(timeS: number, lastS: number): boolean {
    if (timeS < this.#newestS - BACK_S - GAP_S) this.restart();
    else if (!Number.isFinite(timeS) || timeS < lastS) {
      this.#counts.late += 1;
      return false;
    }
    this.#newestS = Math.max(this.#newestS, timeS);
    return true;
  }

  /** Takes scans whose motion is known, or will not come. */
  #take(): void {
    const knownS = this.#motion.at(-1)?.timeS ?? Number.NEGATIVE_INFINITY;
    while (this.#waiting.length) {
      const scan = this.#waiting[0] as Scan;
      const ready = scan.timeS <= knownS || this.#newestS - scan.timeS > GAP_S || this.#waiting.length > MOST_WAITING;
      if (!ready) return;
      this.#waiting.shift();
      this.#lastS = scan.timeS;
      this.#add(scan);
    }
  }

  #add(scan: Scan): void {
    const { timeS, azimuthDeg, rangeRateMps, rangeM, rcsDbsm } = scan;
    const frame: CalibrationFrame = { timeS, azimuthDeg, rangeRateMps, rangeM, rcsDbsm, ...this.#motionAt(timeS) };
    let outcome: FrameOutcome;
    try {
      outcome = this.#calibration.addFrame(frame);
    } catch (error) {
      if (!(error instanceof BoresightError)) throw error;
      this.#counts.refused += 1;
      this.#problem = error.message;
      return;
    }
    this.#told.scan?.({ scan, frame, outcome });
    if (timeS < this.#dueS) return;
    this.#dueS = timeS + STEP_S;
    this.#told.angle?.(timeS, this.#calibration.estimate());
  }

  #motionAt(timeS: number): { yawRateDegps: number | null; speedMps: number | null } {
    const column = (name: keyof MotionSample): Float64Array => Float64Array.from(this.#motion, (one) => one[name]);
    const motion = { timeS: column('timeS'), yawRateDegps: column('yawRateDegps'), speedMps: column('speedMps') };
    const scans = { timeS: Float64Array.of(timeS), sensor: new Uint8Array(1), offsets: new Uint32Array(2) };
    const { yawRateDegps, speedMps } = scanMotion({ scans, motion }, { maxGapS: GAP_S });
    const known = (value: number | undefined): number | null =>
      value !== undefined && Number.isFinite(value) ? value : null;
    return { yawRateDegps: known(yawRateDegps[0]), speedMps: known(speedMps[0]) };
  }

  #forget(nowS: number): void {
    const oldestS = Math.min(this.#waiting[0]?.timeS ?? nowS, nowS) - MOTION_S;
    const kept = this.#motion.findIndex(({ timeS }) => timeS >= oldestS);
    const surplus = Math.max(kept, this.#motion.length - MOST_SAMPLES);
    // Not with each sample: a hundred of them a second may come.
    if (surplus > 64) this.#motion = this.#motion.slice(surplus);
  }
}
