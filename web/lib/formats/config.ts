import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { RadarConfig, TextInput, Waveform, WaveformSummary } from '../types.js';

/** Reads the configuration (`.cfg`) of a Texas Instruments mmWave board. */
export function parseConfig(text: TextInput): RadarConfig {
  return call(() => glue.parseConfig(text) as RadarConfig);
}

/** Resolutions and limits of a waveform. */
export function waveformSummary(waveform: Waveform): WaveformSummary {
  return call(() => glue.waveformSummary(waveform) as WaveformSummary);
}
