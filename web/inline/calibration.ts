// Drives and mounting angles alone, opened out of the script that holds them: what the extension for viewers is made with.
import { drives } from '../lib/drive/drive.js';
import { module } from './modules.js';

export { scanMotion } from '../lib/drive/frame.js';
export { Calibration } from '../lib/mounting/calibrate.js';
export { BoresightError } from '../lib/runtime/errors.js';

/** Makes drives and mounting angles ready, from the module inside. */
export function initDrives(): Promise<void> {
  return drives.start(() => module('drives'));
}
