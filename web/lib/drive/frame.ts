// Scans of a drive as frames, one by one.
import * as glue from '../../wasm/boresight_drives.js';
import { failure } from '../runtime/errors.js';
import { describe } from '../runtime/given.js';
import type { DriveData, DriveFrame, MotionGap, ScanMotion } from '../types.js';
import { drives } from './drive.js';
import { ascending, doubles, extent, floats, gapOf, motionOf, Reader, viewOf } from './view.js';

/**
 * The car's motion at the time of each scan of a drive, by linear interpolation: what {@link driveFrame} puts beside the
 * scan.
 */
export function scanMotion(drive: Pick<DriveData, 'scans' | 'motion'>, gap?: MotionGap): ScanMotion {
  const root = new Reader(drive, 'drive');
  const scans = root.part('scans').array('timeS', [Float64Array]);
  const { timeS, yawRateDegps, speedMps } = motionOf(root.part('motion'));
  ascending('drive.motion.timeS', timeS);
  const maxGapS = gapOf(gap);
  const at = (values: typeof yawRateDegps): Float64Array =>
    drives.call(() => glue.interpolate(timeS, doubles(values), scans, maxGapS));
  return { yawRateDegps: at(yawRateDegps), speedMps: at(speedMps ?? new Float64Array()) };
}

/**
 * A scan of a drive with the car's motion at its time, ready for `Calibration.addFrame`; arrays are views of the
 * drive's.
 */
export function driveFrame(drive: DriveData, scan: number, motion: ScanMotion): DriveFrame {
  const view = viewOf(drive);
  if (!(Number.isInteger(scan) && scan >= 0 && scan < view.timeS.length)) {
    throw failure('out-of-range', {
      what: 'scan',
      expected: `a whole number below ${view.timeS.length}`,
      given: describe(scan),
    });
  }
  const [start, end] = extent(view, scan);
  const reader = new Reader(motion, 'motion');
  const at = (name: keyof ScanMotion): number | null => {
    const value = reader.array(name, floats, view.timeS.length)[scan] ?? NaN;
    return Number.isFinite(value) ? value : null;
  };
  const { rangeM, rcsDbsm, label } = view;
  return {
    timeS: view.timeS[scan] ?? NaN,
    sensor: view.sensor[scan] ?? 0,
    azimuthDeg: view.azimuthDeg.subarray(start, end),
    rangeRateMps: view.rangeRateMps.subarray(start, end),
    ...(rangeM && { rangeM: rangeM.subarray(start, end) }),
    ...(rcsDbsm && { rcsDbsm: rcsDbsm.subarray(start, end) }),
    ...(label && { label: label.subarray(start, end) }),
    yawRateDegps: at('yawRateDegps'),
    speedMps: at('speedMps'),
  };
}
