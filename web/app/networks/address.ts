/** Where the module that runs networks is; `npm start` serves it elsewhere (web/networks-later.ts). */
export const networksModule = new URL('../../../dist/wasm/boresight_neural_bg.wasm', import.meta.url);
