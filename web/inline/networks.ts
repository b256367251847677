// Networks in one file: their module is inside.

import { neural } from '../lib/neural/network.js';
import type { WasmSource } from '../lib/runtime/module.js';
import { module } from './modules.js';

export * from '../lib/neural/api.js';

/** The module inside this file, compiled: what a pool of `boresight/inline` takes as `modules.networks`. */
export const networksModule = (): Promise<WebAssembly.Module> => module('networks');

/** Makes networks ready, by default from the module inside this file. */
export function initNeural(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return neural.start(() => source ?? networksModule());
}
