// What every runtime's entry of the networks offers beside its own initNeural().

export { BoresightError, type ErrorDetails } from '../runtime/errors.js';
export type { WasmSource } from '../runtime/module.js';
export type { Report } from '../runtime/report.js';
export type * from '../types.js';
export { captureRegions, cubeRegions, initNeuralSync, Network } from './network.js';
