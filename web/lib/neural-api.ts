// What every runtime's entry of the networks offers beside its own initNeural().

export { BoresightError, type ErrorDetails } from './errors.js';
export type { WasmSource } from './module.js';
export { initNeuralSync, Network } from './neural.js';
export type { Report } from './report.js';
export type * from './types.js';
