// Entry of the networks for Node: the wasm is read from beside this file.
import type { WasmSource } from '../runtime/module.js';
import { registerNetworks } from '../runtime/networks-module.js';
import { readModule } from '../runtime/read-module.js';
import { neural } from './network.js';

export * from './api.js';

const compile = (): Promise<WebAssembly.Module> =>
  readModule(new URL('../../wasm/boresight_neural_bg.wasm', import.meta.url));
registerNetworks(compile);

/** Loads the module of networks once; docs/javascript.md says where `source` is needed. */
export function initNeural(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return neural.start(() => source ?? compile());
}
