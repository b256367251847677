/** Files of the user's own, of whichever kind: captures, and calibrations of their arrays. */
import type { NamedFile } from '../../../ui/entries.ts';
import { closeCalibrations, isCalibration, openCalibrations } from '../array-calibration/in-effect.ts';
import { ownCalibrations } from '../array-calibration/own-calibrations.ts';
import { closeOwn, openFiles as openCapture, ownFiles as ownCapture } from './files.ts';

export const ownFiles = (): NamedFile[] => [
  ...ownCapture(),
  ...ownCalibrations.peek().map(({ name, file }) => ({ name, file })),
];

export function closeOwnFiles(): void {
  closeOwn();
  closeCalibrations();
}

/** As `openFiles` of a capture; `alone` leaves nothing open that is not among them. */
export async function openFiles(files: readonly File[], alone = false): Promise<void> {
  const marked = await Promise.all(files.map(async (file) => ({ file, calibration: await isCalibration(file) })));
  const of = (calibration: boolean): File[] =>
    marked.filter((one) => one.calibration === calibration).map(({ file }) => file);
  const [capture, calibrations] = [of(false), of(true)];
  if (alone) {
    closeCalibrations();
    if (!capture.length) closeOwn();
  }
  if (capture.length) await openCapture(capture, alone);
  await openCalibrations(calibrations);
}
