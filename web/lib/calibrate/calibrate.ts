import * as core from '../../wasm/boresight.js';
import * as glue from '../../wasm/boresight_drives.js';
import { drives } from '../drive/drive.js';
import { Handle } from '../runtime/handle.js';
import { call } from '../runtime/instance.js';
import type {
  CalibrationFrame,
  CalibrationMethodInfo,
  CalibrationOptions,
  CalibrationResult,
  FrameOutcome,
} from '../types.js';

/** The methods that find a mounting angle. */
export function calibrationMethods(): CalibrationMethodInfo[] {
  return call(() => core.calibrationMethods() as CalibrationMethodInfo[]);
}

/** Finds the angle a radar is mounted at from its frames while the car drives. */
export class Calibration extends Handle<glue.Calibration> {
  constructor(options: CalibrationOptions) {
    super(drives, () => new glue.Calibration(options));
  }

  /** Takes the next frame and says what became of it. A frame that is refused leaves no trace. */
  addFrame(frame: CalibrationFrame): FrameOutcome {
    return this.use((raw) => raw.addFrame(frame) as FrameOutcome);
  }

  /** The angle as far as the frames so far tell. */
  estimate(): CalibrationResult {
    return this.use((raw) => raw.estimate() as CalibrationResult);
  }
}
