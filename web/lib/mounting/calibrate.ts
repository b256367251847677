import * as core from '../../wasm/boresight.js';
import * as glue from '../../wasm/boresight_drives.js';
import { drives } from '../drive/drive.js';
import { Handle } from '../runtime/handle.js';
import { call } from '../runtime/instance.js';
import type {
  CalibrationFrame,
  CalibrationMethodInfo,
  CalibrationOptions,
  CalibrationOutlook,
  CalibrationResult,
  FrameOutcome,
  MotionNetwork,
} from '../types.js';

/** The methods that find a mounting angle. */
export function calibrationMethods(): CalibrationMethodInfo[] {
  return call(() => core.calibrationMethods() as CalibrationMethodInfo[]);
}

/**
 * The angle from several drives with one radar of one car, each as the snapshot of its calibration.
 *
 * @example
 * ```js
 * import { Calibration, driveFrame, initDrives, mergeCalibrations, scanMotion, simulateDrive } from 'boresight';
 *
 * await initDrives();
 * const place = { xM: 3.6, yM: 0.7 };
 * const sensors = [{ id: 1, ...place, yawDeg: 30.5 }];
 * const snapshots = [1, 2].map((seed) => {
 *   const drive = simulateDrive({ durationS: 60, seed, sensors });
 *   const motion = scanMotion(drive);
 *   const calibration = new Calibration({ method: 'recursive', ...place, nominalDeg: 30 });
 *   for (let scan = 0; scan < drive.scans.timeS.length; scan++) {
 *     calibration.addFrame(driveFrame(drive, scan, motion));
 *   }
 *   const bytes = calibration.snapshot();
 *   calibration.free();
 *   return bytes;
 * });
 * console.log(mergeCalibrations(snapshots).angleDeg.toFixed(1)); // → 30.5
 * ```
 */
export function mergeCalibrations(snapshots: readonly (Uint8Array | ArrayBuffer)[]): CalibrationResult {
  return drives.call(() => glue.mergeCalibrations(snapshots) as CalibrationResult);
}

/**
 * Finds the angle a radar is mounted at from its frames while the car drives.
 *
 * @example
 * ```js
 * import { Calibration, driveFrame, initDrives, scanMotion, simulateDrive } from 'boresight';
 *
 * await initDrives();
 * const place = { xM: 3.6, yM: 0.7 };
 * const drive = simulateDrive({ durationS: 60, seed: 1, sensors: [{ id: 1, ...place, yawDeg: 30.5 }] });
 * const motion = scanMotion(drive);
 * const calibration = new Calibration({ method: 'recursive', ...place, nominalDeg: 30 });
 * for (let scan = 0; scan < drive.scans.timeS.length; scan++) {
 *   calibration.addFrame(driveFrame(drive, scan, motion));
 * }
 * const { angleDeg, sigmaDeg } = calibration.estimate();
 * calibration.free();
 * console.log(`${angleDeg.toFixed(1)} +- ${sigmaDeg.toFixed(2)} deg`); // → 30.5 +- 0.06 deg
 * ```
 */
export class Calibration extends Handle<glue.Calibration> {
  constructor(options: CalibrationOptions & MotionNetwork);
  /** What {@link Calibration.restore} calls. */
  constructor(snapshot: Uint8Array | ArrayBuffer, kept: MotionNetwork);
  constructor(options: (CalibrationOptions & MotionNetwork) | Uint8Array | ArrayBuffer, kept?: MotionNetwork) {
    super(drives, () => (kept ? glue.Calibration.restore(options, kept.network) : new glue.Calibration(options)));
  }

  /**
   * The calibration that a snapshot is of, with its options: it continues to the last digit as the one that was kept. A network
   * is no part of it, and is given again. Snapshots of all earlier versions from version 3 on are read; later ones are `unsupported-snapshot`.
   */
  static restore(snapshot: Uint8Array | ArrayBuffer, network?: Uint8Array | ArrayBuffer): Calibration {
    return new Calibration(snapshot, network === undefined ? {} : { network });
  }

  /** The calibration as some kilobytes, whatever the drive's length (recursive method). */
  snapshot(): Uint8Array {
    return this.use((raw) => raw.snapshot());
  }

  /**
   * Adds the next frame and returns what became of it. A frame that is rejected changes no estimate; for its time it counts in `rejectedFrames`.
   * Ten consecutive frames whose times ascend more than ten seconds before the last accepted one start a new session, as {@link restart} does.
   */
  addFrame(frame: CalibrationFrame): FrameOutcome {
    return this.use((raw) => raw.addFrame(frame) as FrameOutcome);
  }

  /**
   * Starts a session on a clock that need not continue the one before, as after a restart of the radar. Keeps what was learnt of the mounting angle and
   * the car; drops the delay of time stamps and all that compares frames by time.
   */
  restart(): void {
    this.use((raw) => raw.restart());
  }

  /** What driving on would bring (recursive method; null for the others). */
  outlook(): CalibrationOutlook | null {
    return this.use((raw) => raw.outlook() as CalibrationOutlook | null);
  }

  /** The angle as far as the frames so far tell. */
  estimate(): CalibrationResult {
    return this.use((raw) => raw.estimate() as CalibrationResult);
  }
}
