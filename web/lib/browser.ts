// Entry for browsers and bundlers: the wasm is fetched from beside this file.
import { start, type WasmSource } from './instance.js';

export * from './api.js';

/** Loads the module once; see the README for where `source` is needed. */
export function init(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return start(() => source ?? new URL('../wasm/boresight_bg.wasm', import.meta.url));
}
