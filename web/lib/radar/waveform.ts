import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { Waveform, WaveformSummary } from '../types.js';

/** Resolutions and limits of a waveform. */
export function waveformSummary(waveform: Waveform): WaveformSummary {
  return call(() => glue.waveformSummary(waveform) as WaveformSummary);
}

/** Names of the waveforms known by name: of boards and of the papers. */
export function waveformPresets(): string[] {
  return call(() => glue.waveformPresets());
}

/** The waveform of a name. */
export function waveformPreset(name: string): Waveform {
  return call(() => glue.waveformPreset(name) as Waveform);
}
