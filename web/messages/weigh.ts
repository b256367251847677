/** Which detections of a scan stand, and how the radar moves: scan by scan, by RANSAC. */
import { BoresightError, Calibration, type FrameOutcome } from 'boresight';
import type { Scan } from './scan.ts';

/** The method keeps each frame, and only what it says of the newest is wanted: it begins anew after so many. */
const MOST_FRAMES = 512;

/** Needs `initDrives()`. */
export class Weigher {
  #calibration: Calibration | null = null;
  #frames = 0;

  /** What becomes of a scan; null where it is refused. */
  weigh({ timeS, azimuthDeg, rangeRateMps, rangeM, rcsDbsm }: Scan): FrameOutcome | null {
    // Where the car has no speed to be compared with, its yaw rate does not matter to the fit.
    const frame = { timeS, azimuthDeg, rangeRateMps, rangeM, rcsDbsm, yawRateDegps: 0 };
    for (const again of [false, true]) {
      if (again || this.#frames === MOST_FRAMES) this.free();
      this.#calibration ??= new Calibration({ method: 'weighted-mean', motion: 'ransac', xM: 0 });
      this.#frames += 1;
      try {
        return this.#calibration.addFrame(frame);
      } catch (error) {
        if (!(error instanceof BoresightError)) throw error;
        // Times run back where data are wound.
        if (error.code !== 'time-backwards') return null;
      }
    }
    return null;
  }

  free(): void {
    this.#calibration?.free();
    [this.#calibration, this.#frames] = [null, 0];
  }
}
