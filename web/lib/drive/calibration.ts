import * as glue from '../../wasm/boresight_drives.js';
import { failure } from '../runtime/errors.js';
import { Handle } from '../runtime/handle.js';
import { type Report, tell } from '../runtime/report.js';
import { version } from '../runtime/version.js';
import type {
  CalibrateDriveOptions,
  CalibratedFrames,
  CalibrationOutlook,
  CalibrationResult,
  DriveCalibration,
  DriveData,
  FrameVerdict,
  JointCalibrationOptions,
  ReportAbout,
} from '../types.js';
import { drives } from './drive.js';
import { jointTaskOf, needsMore, reportTaskOf, type Task, taskOf } from './radars.js';
import { checkOrder, doubles, extent, scansOf, type View, viewOf } from './view.js';

/** What can become of a frame, in the order of its numbers. */
export const frameVerdicts: readonly FrameVerdict[] = [
  'used',
  'standing',
  'slow',
  'turning',
  'sparse',
  'off-speed',
  'without-motion',
];

/** Most frames and detections handed over at a time. */
const FRAMES = 256;
const DETECTIONS = 65_535;
/** Numbers that come back for a frame. */
const ROW = 8;
/** What is told of a frame without motion. */
const NOTHING = [frameVerdicts.indexOf('sparse'), NaN, NaN, NaN, NaN, 0, 0];
/** Methods that weigh all frames at once are asked after a hundredth of the frames so far at most. */
const SHARE = 0.01;

/**
 * Finds the angle one radar of a drive is mounted at. Throws the code `cancelled` if `report` stops it.
 *
 * @example
 * ```js
 * import { calibrateDrive, initDrives, simulateDrive } from 'boresight';
 *
 * await initDrives();
 * // The radar looks half a degree further to the left than its log says.
 * const drive = simulateDrive({ scenario: 'city', durationS: 120, seed: 1, misalignmentDeg: { 1: 0.5 } });
 * const { mounting, result } = calibrateDrive(drive, { sensor: 1, alarmDeg: 0.2 });
 * console.log((result.angleDeg - mounting.nominalDeg).toFixed(1), result.alignment); // → 0.5 misaligned
 * ```
 */
export function calibrateDrive(drive: DriveData, options?: CalibrateDriveOptions, report?: Report): DriveCalibration {
  const view = viewOf(drive);
  return run(view, taskOf(view, options), report, (_, found) => found())[0] as DriveCalibration;
}

/**
 * Finds the angles of several radars of a drive together: one yaw-rate sensor, one scale and one bias.
 *
 * @example
 * ```js
 * import { initDrives, jointCalibration, simulateDrive } from 'boresight';
 *
 * await initDrives();
 * const drive = simulateDrive({ scenario: 'city', durationS: 60, seed: 1 });
 * for (const { sensor, result } of jointCalibration(drive)) console.log(sensor, result.angleDeg.toFixed(0));
 * // → 1 -85
 * // → 2 -25
 * // → 3 25
 * // → 4 85
 * ```
 */
export function jointCalibration(
  drive: DriveData,
  options?: JointCalibrationOptions,
  report?: Report,
): DriveCalibration[] {
  const view = viewOf(drive);
  return run(view, jointTaskOf(view, options), report, (_, found) => found());
}

/**
 * Calibrates like {@link calibrateDrive}, or like {@link jointCalibration} where the options name `sensors`, and writes a report: a
 * page of HTML, to print or to keep, with verdict, plots, conditions and the files it comes from. Throws the code `cancelled` if
 * `report` stops it.
 *
 * @example
 * ```js
 * import { calibrationReport, init, initDrives, simulateDrive } from 'boresight';
 *
 * await Promise.all([init(), initDrives()]);
 * const drive = simulateDrive({ scenario: 'city', durationS: 60, seed: 1 });
 * const html = calibrationReport(drive, {}, { sensors: [1, 2, 3, 4] });
 * console.log(html.slice(0, 15)); // → <!DOCTYPE html>
 * ```
 */
export function calibrationReport(
  drive: DriveData,
  about?: ReportAbout,
  options?: CalibrateDriveOptions | JointCalibrationOptions,
  report?: Report,
): string {
  const view = viewOf(drive);
  const task = reportTaskOf(view, options);
  const sensors = task.radars.map(({ sensor }) => sensor);
  return run(view, task, report, (calibrator) => calibrator.report(sensors, about));
}

class DriveCalibrator extends Handle<glue.DriveCalibrator> {
  constructor({ radars, joint, maxGapS, weights, recorded }: Task, { motion }: View) {
    const options = radars.map((radar) => radar.options);
    const [timeS, yawRateDegps] = [motion.timeS, doubles(motion.yawRateDegps)];
    const speedMps = doubles(motion.speedMps ?? new Float64Array());
    super(
      drives,
      () =>
        new glue.DriveCalibrator(
          joint ? options : options[0],
          weights,
          recorded,
          timeS,
          yawRateDegps,
          speedMps,
          maxGapS,
        ),
    );
  }

  add(...args: Parameters<glue.DriveCalibrator['addFrames']>): Float64Array {
    return this.use((raw) => raw.addFrames(...args));
  }

  weights(): Float32Array {
    return this.use((raw) => raw.weights());
  }

  angles(): Float64Array {
    return this.use((raw) => raw.angles());
  }

  estimate(): CalibrationResult[] {
    return this.use((raw) => raw.estimate() as CalibrationResult[]);
  }

  outlook(): CalibrationOutlook | null {
    return this.use((raw) => raw.outlook() as CalibrationOutlook | null);
  }

  report(sensors: readonly number[], about: ReportAbout | undefined): string {
    return this.use((raw) => raw.report(Uint8Array.from(sensors), version(), about));
  }
}

/** Frames as they are handed over, all arrays used up to a length. */
class Chunk {
  readonly radar = new Uint8Array(FRAMES);
  readonly timeS = new Float64Array(FRAMES);
  readonly ends = new Uint32Array(FRAMES);
  readonly azimuthDeg = new Float64Array(DETECTIONS);
  readonly rangeRateMps = new Float32Array(DETECTIONS);
  /** Of range and cross-section, where a network looks at them and the drive has them. */
  readonly more: [Float32Array, Float32Array];
  frames = 0;
  detections = 0;

  constructor({ rangeM, rcsDbsm }: View, network: boolean) {
    const column = (given: unknown): Float32Array => new Float32Array(network && given ? DETECTIONS : 0);
    this.more = [column(rangeM), column(rcsDbsm)];
  }

  clear(): void {
    this.frames = 0;
    this.detections = 0;
  }

  /** Takes a scan unless there is no room. */
  take(view: View, scan: number, radar: number): boolean {
    const [start, end] = extent(view, scan);
    const [frame, first] = [this.frames, this.detections];
    if (frame === FRAMES || first + end - start > DETECTIONS) return false;
    this.radar[frame] = radar;
    this.timeS[frame] = view.timeS[scan] ?? NaN;
    this.azimuthDeg.set(view.azimuthDeg.subarray(start, end), first);
    this.rangeRateMps.set(view.rangeRateMps.subarray(start, end), first);
    for (const [place, values] of [view.rangeM, view.rcsDbsm].entries()) {
      const column = this.more[place];
      if (column?.length && values) column.set(values.subarray(start, end), first);
    }
    this.frames = frame + 1;
    this.detections = first + end - start;
    this.ends[frame] = this.detections;
    finite('drive.detections.azimuthDeg', this.azimuthDeg, first, this.detections, start);
    finite('drive.detections.rangeRateMps', this.rangeRateMps, first, this.detections, start);
    return true;
  }
}

/** Refuses numbers that single precision does not hold; `index` is that of the first in the drive. */
function finite(what: string, values: Float32Array | Float64Array, start: number, end: number, index: number): void {
  for (let i = start; i < end; i++) {
    if (Number.isFinite(Math.fround(values[i] ?? NaN))) continue;
    throw failure('not-finite', {
      what,
      expected: 'finite numbers',
      given: `${values[i]} at index ${index + i - start}`,
    });
  }
}

/** Feeds all frames; `end` makes of the calibrator, or of what was found, what is wanted. */
function run<T>(
  view: View,
  task: Task,
  report: Report | undefined,
  end: (calibrator: DriveCalibrator, found: () => DriveCalibration[]) => T,
): T {
  checkOrder(view);
  const { radars, historyS } = task;
  const scans = scansOf(
    view,
    radars.map(({ sensor }) => sensor),
  );
  const places = new Uint8Array(256);
  radars.forEach(({ sensor }, place) => (places[sensor] = place));
  const placeOf = (scan: number): number => places[view.sensor[scan] ?? 0] ?? 0;
  const all = radars.some(({ options }) => options.method !== 'recursive');
  const calibrator = new DriveCalibrator(task, view);
  try {
    const tables = radars.map(({ sensor }) => new Table(view, scansOf(view, [sensor]), task.weights));
    const histories = radars.map(() => ({ angleDeg: [] as number[], sigmaDeg: [] as number[] }));
    const historyTimes: number[] = [];
    const startS = view.timeS[scans[0] ?? 0] ?? 0;
    const step = Math.max(64, scans.length / 200);
    const chunk = new Chunk(view, needsMore(radars));
    let [dueS, asked, told, next] = [startS + historyS, 0, 0, 0];
    while (next < scans.length) {
      const first = next;
      chunk.clear();
      while (next < scans.length && (view.timeS[scans[next] ?? 0] ?? NaN) <= dueS) {
        if (!chunk.take(view, scans[next] ?? 0, placeOf(scans[next] ?? 0))) break;
        next += 1;
      }
      const { frames, detections } = chunk;
      if (frames > 0) {
        const rows = calibrator.add(
          chunk.radar.subarray(0, frames),
          chunk.timeS.subarray(0, frames),
          chunk.ends.subarray(0, frames),
          chunk.azimuthDeg.subarray(0, detections),
          chunk.rangeRateMps.subarray(0, detections),
          chunk.more[0].subarray(0, detections),
          chunk.more[1].subarray(0, detections),
        );
        const weights = task.weights ? calibrator.weights() : undefined;
        for (let frame = 0; frame < frames; frame++) {
          const values = weights?.subarray(frame ? chunk.ends[frame - 1] : 0, chunk.ends[frame]);
          tables[chunk.radar[frame] ?? 0]?.add(rows.subarray(frame * ROW, (frame + 1) * ROW), values);
        }
      }
      const nextS = view.timeS[scans[next] ?? 0] ?? NaN;
      if (frames === 0 && !(nextS > dueS)) {
        throw failure('wrong-type', {
          what: 'drive.scans',
          expected: 'arrays that stay',
          given: 'arrays given away meanwhile',
        });
      }
      const finished = next === scans.length;
      if (finished || nextS > dueS) {
        if (next > asked && (finished || !all || next - asked >= SHARE * next)) {
          asked = next;
          historyTimes.push(view.timeS[scans[next - 1] ?? 0] ?? NaN);
          const angles = calibrator.angles();
          histories.forEach(({ angleDeg, sigmaDeg }, place) => {
            angleDeg.push(angles[2 * place] ?? NaN);
            sigmaDeg.push(angles[2 * place + 1] ?? NaN);
          });
        }
        const grid = startS + historyS * (Math.floor((nextS - startS) / historyS) + 1);
        dueS = Math.max(grid, nextS);
      }
      if (finished || (next > first && next - told >= step)) {
        told = next;
        tell(report, next, scans.length);
      }
    }
    const timeS = Float64Array.from(historyTimes);
    return end(calibrator, () => {
      const outlook = calibrator.outlook();
      return calibrator.estimate().map((result, place): DriveCalibration => {
        const { sensor, options } = radars[place] as Task['radars'][number];
        const { angleDeg, sigmaDeg } = histories[place] as (typeof histories)[number];
        const { method, xM, yM = 0, nominalDeg = null } = options;
        return {
          sensor,
          method,
          mounting: { xM, yM, nominalDeg },
          result,
          outlook,
          history: { timeS, angleDeg: Float64Array.from(angleDeg), sigmaDeg: Float64Array.from(sigmaDeg) },
          frames: (tables[place] as Table).frames,
        };
      });
    });
  } finally {
    calibrator[Symbol.dispose]();
  }
}

/** What became of a radar's frames, filled one by one. */
class Table {
  readonly frames: CalibratedFrames;
  #next = 0;

  constructor(view: View, scan: Uint32Array, weights: boolean) {
    const single = (): Float32Array => new Float32Array(scan.length);
    this.frames = {
      scan,
      timeS: Float64Array.from(scan, (scan) => view.timeS[scan] ?? NaN),
      verdict: new Uint8Array(scan.length),
      vxMps: single(),
      vyMps: single(),
      angleDeg: single(),
      angleSigmaDeg: single(),
      weight: single(),
      inliers: new Uint16Array(scan.length),
    };
    if (!weights) return;
    const offsets = new Uint32Array(scan.length + 1);
    scan.forEach((scan, index) => {
      const [start, end] = extent(view, scan);
      offsets[index + 1] = (offsets[index] ?? 0) + end - start;
    });
    this.frames.weights = { offsets, values: new Float32Array(offsets[scan.length] ?? 0) };
  }

  add(row: Float64Array, weights: Float32Array | undefined): void {
    const { frames } = this;
    const index = this.#next++;
    const [timeS = NaN, ...told] = row;
    let at = index;
    while (at > 0 && (frames.timeS[at] ?? NaN) > timeS) at -= 1;
    // Of a frame nothing is told before its time comes.
    if (at < index) this.#write(index, NOTHING);
    this.#write(at, told);
    if (weights) frames.weights?.values.set(weights, frames.weights.offsets[index]);
  }

  #write(index: number, told: readonly number[]): void {
    const { frames } = this;
    const columns = [
      frames.verdict,
      frames.vxMps,
      frames.vyMps,
      frames.angleDeg,
      frames.angleSigmaDeg,
      frames.weight,
      frames.inliers,
    ];
    columns.forEach((column, place) => (column[index] = told[place] ?? NaN));
  }
}
