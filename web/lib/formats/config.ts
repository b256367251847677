import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { ConfigInput, RadarConfig, TextInput } from '../types.js';

/** Reads the configuration of a Texas Instruments mmWave board: the text of its `.cfg` file. */
export function parseConfig(config: ConfigInput): RadarConfig {
  return call(() => glue.parseConfig(config) as RadarConfig);
}

/**
 * The configuration with one of the sub-frames of its advanced frame chosen, from 0, for whatever takes a
 * configuration: a comment at its end says which.
 *
 * @throws BoresightError if there is no such sub-frame.
 */
export function subFrameConfig(text: TextInput, subFrame: number): string {
  return call(() => glue.subFrameConfig(text, subFrame));
}
