// The package and its pool in one file: the modules of the core and of drives and the worker's script are inside.
import { drives } from '../lib/drive/drive.js';
import { core } from '../lib/runtime/instance.js';
import type { WasmSource } from '../lib/runtime/module.js';
import { Pool } from '../worker/api.js';
import { browserRuntime } from '../worker/browser-runtime.js';
import type { PoolOptions } from '../worker/options.js';
import { part } from './archive.js';
import { module } from './modules.js';

export * from '../lib/api.js';
export * from '../worker/exports.js';

/** Makes Boresight ready, by default from the module inside this file. */
export function init(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return core.start(() => source ?? module('core'));
}

/**
 * Makes drives and mounting angles ready, by default from the module inside this file: what {@link readDrive},
 * {@link simulateDrive}, {@link Calibration}, {@link calibrateDrive} and {@link jointCalibration} need.
 */
export function initDrives(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return drives.start(() => source ?? module('drives'));
}

/** The address of the worker's script; one for all workers, as long as the page is there. */
let script = '';

const runtime = browserRuntime({
  packaged: () => ({ core: () => module('core'), drives: () => module('drives') }),
  async prepare() {
    script ||= URL.createObjectURL(new Blob([await part('worker')], { type: 'text/javascript' }));
  },
  start: () => new Worker(script),
});

/** Makes a pool of workers, whose script is inside this file. */
export function createPool(options?: PoolOptions): Pool {
  return new Pool(runtime, options);
}
