/** Frames of simulated drives, as lines and as the package takes them. */
import { Calibration, driveFrame, initDrives, scanMotion, simulateDrive } from 'boresight';

const PLACE = { xM: 3.6, yM: 0.7 };

/** Options of the radar of {@link frames}. */
export const RADAR = { ...PLACE, nominalDeg: 30, alarmDeg: 1 };

/** Frames of a radar that looks so far off, with so many detections each where that is asked for. */
export async function frames({ seed = 1, durationS = 60, offDeg = 0.5, detections } = {}) {
  await initDrives();
  const drive = simulateDrive({
    scenario: 'city',
    profile: 'radarscenes',
    durationS,
    seed,
    sensors: [{ id: 1, ...PLACE, yawDeg: RADAR.nominalDeg + offDeg }],
  });
  const motion = scanMotion(drive);
  return Array.from(drive.scans.timeS, (_, scan) => {
    const { timeS, azimuthDeg, rangeRateMps, yawRateDegps, speedMps } = driveFrame(drive, scan, motion);
    const resized = (column) =>
      Float64Array.from({ length: detections ?? column.length }, (_, i) => column[i % column.length]);
    return {
      timeS,
      azimuthDeg: resized(azimuthDeg),
      rangeRateMps: resized(rangeRateMps),
      yawRateDegps,
      speedMps,
    };
  }).filter(({ azimuthDeg }) => azimuthDeg.every(Number.isFinite));
}

/** A frame as a line, of the radar of that name. */
export const line = (radar, { azimuthDeg, rangeRateMps, ...rest }) =>
  `${JSON.stringify({ radar, ...rest, azimuthDeg: [...azimuthDeg], rangeRateMps: [...rangeRateMps] })}\n`;

/** What the package's own calibration makes of frames, as JSON has it. */
export async function reference(all) {
  await initDrives();
  const calibration = new Calibration({ method: 'recursive', ...RADAR });
  for (const frame of all) calibration.addFrame(frame);
  const result = calibration.estimate();
  calibration.free();
  return JSON.parse(JSON.stringify(result));
}
