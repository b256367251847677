// Entry of the networks for workerd and other edge runtimes that import wasm as a compiled module.
import module from '../../wasm/boresight_neural_bg.wasm';
import type { WasmSource } from '../runtime/module.js';
import { registerNetworks } from '../runtime/networks-module.js';
import { neural } from './network.js';

export * from './api.js';

registerNetworks(async () => module);

/** Loads the module of networks once; docs/javascript.md says where `source` is needed. */
export function initNeural(source?: WasmSource | Promise<WasmSource>): Promise<void> {
  return neural.start(() => source ?? module);
}
