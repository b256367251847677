import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { Waveform, WaveformSummary } from '../types.js';

/** Resolutions and limits of a waveform. */
export function waveformSummary(waveform: Waveform): WaveformSummary {
  return call(() => glue.waveformSummary(waveform) as WaveformSummary);
}
