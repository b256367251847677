import instantiate, * as glue from '../../wasm/boresight_drives.js';
import { Instance } from '../runtime/module.js';
import type { Report } from '../runtime/report.js';
import type {
  Drive,
  DriveFile,
  DriveScenarioInfo,
  ReadDriveOptions,
  SimulateDriveOptions,
  SimulatedDrive,
} from '../types.js';

/** The module of this file's functions, loaded by initDrives(). */
export const drives = new Instance(glue, instantiate, { file: 'boresight_drives_bg.wasm', init: 'initDrives()' });

/** Makes the module of drives and mounting angles ready from a compiled module or its bytes, without waiting. */
export function initDrivesSync(module: WebAssembly.Module | BufferSource): void {
  drives.startSync(module);
}

/** Reads a drive from its files, in any order; each is recognised by its contents, tables may be packed with gzip. */
export function readDrive(files: readonly DriveFile[], options?: ReadDriveOptions): Drive {
  return drives.call(() => glue.readDrive(files, options) as Drive);
}

/**
 * Simulates a drive; the same bits on every platform. Throws the code `cancelled` if `report` stops it.
 *
 * @example
 * ```js
 * import { initDrives, simulateDrive } from 'boresight';
 *
 * await initDrives();
 * const { scans, sensors } = simulateDrive({ scenario: 'city', durationS: 10, seed: 1 });
 * console.log(sensors.map(({ id }) => id), scans.timeS.length); // → [ 1, 2, 3, 4 ] 534
 * ```
 */
export function simulateDrive(options?: SimulateDriveOptions, report?: Report): SimulatedDrive {
  return drives.call(() => glue.simulateDrive(options, report) as SimulatedDrive);
}

/** The scenarios that can be simulated. */
export function driveScenarios(): DriveScenarioInfo[] {
  return drives.call(() => glue.driveScenarios() as DriveScenarioInfo[]);
}
