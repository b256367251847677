import { Calibration, driveFrame, scanMotion } from 'boresight';

const PLACE = { xM: 3.6, yM: 0.7 };
/** Where the radar should look. */
export const NOMINAL_DEG = 30;

/** A minute in town with a radar that looks so far off, in place of your bus. */
export const drive = (pool, offDeg, job) =>
  pool.simulateDrive(
    {
      scenario: 'city',
      durationS: 60,
      seed: 2,
      sensors: [{ id: 1, ...PLACE, yawDeg: NOMINAL_DEG + offDeg }],
    },
    job,
  );

/** The angle as frames come in, once a second of the drive. */
export function* angles(drive) {
  const motion = scanMotion(drive);
  const calibration = new Calibration({ method: 'recursive', ...PLACE, nominalDeg: NOMINAL_DEG });
  try {
    let told = 0;
    for (let scan = 0; scan < drive.scans.timeS.length; scan++) {
      const { timeS, azimuthDeg, rangeRateMps, yawRateDegps } = driveFrame(drive, scan, motion);
      calibration.addFrame({ timeS, azimuthDeg, rangeRateMps, yawRateDegps });
      if (timeS < told + 1) continue;
      told = timeS;
      yield { timeS, ...calibration.estimate() };
    }
  } finally {
    calibration.free();
  }
}
