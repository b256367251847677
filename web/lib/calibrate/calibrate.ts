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

/** The angle from several drives with one radar of one car, each as the snapshot of its calibration. */
export function mergeCalibrations(snapshots: readonly (Uint8Array | ArrayBuffer)[]): CalibrationResult {
  return drives.call(() => glue.mergeCalibrations(snapshots) as CalibrationResult);
}

/** Finds the angle a radar is mounted at from its frames while the car drives. */
export class Calibration extends Handle<glue.Calibration> {
  constructor(options: CalibrationOptions & MotionNetwork);
  /** What {@link Calibration.restore} calls. */
  constructor(snapshot: Uint8Array | ArrayBuffer, kept: MotionNetwork);
  constructor(options: (CalibrationOptions & MotionNetwork) | Uint8Array | ArrayBuffer, kept?: MotionNetwork) {
    super(drives, () => (kept ? glue.Calibration.restore(options, kept.network) : new glue.Calibration(options)));
  }

  /**
   * The calibration that a snapshot is of, with its options: it goes on to the last digit as the one that was kept. A network
   * is no part of it, and is given again.
   */
  static restore(snapshot: Uint8Array | ArrayBuffer, network?: Uint8Array | ArrayBuffer): Calibration {
    return new Calibration(snapshot, network === undefined ? {} : { network });
  }

  /** The calibration as some kilobytes, whatever the drive's length (recursive method). */
  snapshot(): Uint8Array {
    return this.use((raw) => raw.snapshot());
  }

  /** Takes the next frame and says what became of it. A frame that is refused leaves no trace. */
  addFrame(frame: CalibrationFrame): FrameOutcome {
    return this.use((raw) => raw.addFrame(frame) as FrameOutcome);
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
