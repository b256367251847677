import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { ConfigInput, RadarConfig } from '../types.js';

/** Reads the configuration (`.cfg`) of a Texas Instruments mmWave board. */
export function parseConfig(config: ConfigInput): RadarConfig {
  return call(() => glue.parseConfig(config) as RadarConfig);
}
