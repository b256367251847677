// Entry for browsers and bundlers: the wasm is fetched from beside this file.
import { drives } from './drive/drive.js';
import { fetchModule } from './runtime/fetch-module.js';
import { core } from './runtime/instance.js';
import type { WasmSource } from './runtime/module.js';

export * from './api.js';

/** Loads the module once; docs/javascript.md says where `source` is needed. */
export function init(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return core.start(() => source ?? fetchModule(new URL('../wasm/boresight_bg.wasm', import.meta.url)));
}

/**
 * Loads the module of drives and mounting angles: what {@link readDrive}, {@link simulateDrive},
 * {@link Calibration}, {@link calibrateDrive} and {@link jointCalibration} need.
 */
export function initDrives(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return drives.start(() => source ?? fetchModule(new URL('../wasm/boresight_drives_bg.wasm', import.meta.url)));
}
