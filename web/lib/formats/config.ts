import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { RadarConfig, TextInput } from '../types.js';

/** Reads the configuration (`.cfg`) of a Texas Instruments mmWave board. */
export function parseConfig(text: TextInput): RadarConfig {
  return call(() => glue.parseConfig(text) as RadarConfig);
}
