// Entry of the networks for browsers and bundlers: the wasm is fetched from beside this file.
import type { WasmSource } from './module.js';
import { neural } from './neural.js';

export * from './neural-api.js';

/** Loads the module of networks once; docs/javascript.md says where `source` is needed. */
export function initNeural(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return neural.start(() => source ?? new URL('../wasm/boresight_neural_bg.wasm', import.meta.url));
}
