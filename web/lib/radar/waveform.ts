import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { Waveform, WaveformSummary } from '../types.js';

/**
 * Resolutions and limits of a waveform.
 *
 * @example
 * ```js
 * import { init, waveformPreset, waveformSummary } from 'boresight';
 *
 * await init();
 * const { rangeResolutionM, maxRateMps } = waveformSummary(waveformPreset('awr1642'));
 * console.log(`${(100 * rangeResolutionM).toFixed(1)} cm, to ${maxRateMps.toFixed(1)} m/s`);
 * // → 5.1 cm, to 4.9 m/s
 * ```
 */
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
