/** Where the module that runs networks is. */
export const networksModule = new URL('../../../dist/wasm/boresight_neural_bg.wasm', import.meta.url);
