// Entry for workerd and other edge runtimes that import wasm as a compiled module.
import module from '../wasm/boresight_bg.wasm';
import { start, type WasmSource } from './instance.js';

export * from './api.js';

/** Loads the module once; see the README for where `source` is needed. */
export function init(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return start(() => source ?? module);
}
