import { driveFrame, scanMotion } from 'boresight';

/** Ten seconds in town before one radar, in place of your log. */
export const drive = (pool) =>
  pool.simulateDrive({
    scenario: 'city',
    durationS: 10,
    seed: 5,
    sensors: [{ id: 1, xM: 3.6, yM: 0.7, yawDeg: 30 }],
  });

/** The scans of a drive, each on demand. */
export function scansOf(drive) {
  const motion = scanMotion(drive);
  return { count: drive.scans.timeS.length, at: (scan) => driveFrame(drive, scan, motion) };
}
