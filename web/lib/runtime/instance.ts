import instantiate, * as glue from '../../wasm/boresight.js';
import { Instance } from './module.js';

/** The module that a page loads at once. */
export const core = new Instance(glue, instantiate, { file: 'boresight_bg.wasm', init: 'init()' });

/** Runs a function of the core bindings. */
export function call<T>(work: () => T): T {
  return core.call(work);
}

/** Makes Boresight ready from a compiled module or its bytes, without waiting. */
export function initSync(module: WebAssembly.Module | BufferSource): void {
  core.startSync(module);
}
