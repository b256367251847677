/** A board's maps on axes with units, where its configuration tells them. */
import type { BoardFrame, RadarConfig } from 'boresight';
import { AZIMUTH } from '../../../plots/axes.ts';
import type { AxisOptions } from '../../../plots/types.ts';
import { api } from '../../data.ts';

export interface Axis {
  values: Float64Array;
  label: string;
  /** In readouts, and in files. */
  name: string;
  column: string;
}

export interface GroundMap {
  x: Axis;
  y: Axis;
  xAxis: AxisOptions;
  /** Level of column i and row j at `i * y.values.length + j`, dB. */
  values: Float64Array;
  remarks: readonly string[];
}

const GRID_POINTS = 128;

const steps = (count: number, step: number, first = 0): Float64Array =>
  Float64Array.from({ length: count }, (_, i) => (i + first) * step);

/** Ranges of bins. The board's transform has more points than samples where those are no power of two. */
export function rangeAxis(bins: number, config: RadarConfig | null): Axis {
  if (!config) return { values: steps(bins, 1), label: 'Range bin', name: 'bin', column: 'range_bin' };
  const step = (config.summary.rangeResolutionM * config.waveform.samples) / bins;
  return { values: steps(bins, step), label: 'Range (m)', name: 'range', column: 'range_m' };
}

/** Range x Doppler: what a board sends from zero on is put in order of range rates. */
export function dopplerMap(frame: BoardFrame, config: RadarConfig | null): GroundMap | null {
  const { rangeDopplerDb: sent, rangeProfileDb: profile } = frame;
  const ranges = profile?.length ?? (config ? 2 ** Math.ceil(Math.log2(config.waveform.samples)) : 0);
  if (!sent?.length || !ranges || sent.length % ranges) return null;
  const rates = sent.length / ranges;
  const values = new Float64Array(sent.length);
  const half = rates >> 1;
  for (let i = 0; i < ranges; i++)
    for (let j = 0; j < rates; j++) values[i * rates + ((j + half) % rates)] = sent[i * rates + j] as number;
  const step = config ? (config.summary.rateResolutionMps * config.waveform.loops) / rates : 1;
  const y = config
    ? { label: 'Range rate (m/s), + receding', name: 'rate', column: 'rate_mps' }
    : { label: 'Doppler bin', name: 'Doppler', column: 'doppler_bin' };
  const x = rangeAxis(ranges, config);
  return {
    x,
    y: { values: steps(rates, step, -half), ...y },
    xAxis: { label: x.label },
    values,
    remarks: ['Levels as the board sends them, over its own unit.'],
  };
}

/** Range x azimuth at zero Doppler: beams of the antennas' signals, which the board sends, over azimuth. */
export function azimuthMap(frame: BoardFrame, config: RadarConfig | null): GroundMap | null {
  const { azimuthHeatMap: sent, rangeProfileDb: profile } = frame;
  const ranges = profile?.length ?? (config ? 2 ** Math.ceil(Math.log2(config.waveform.samples)) : 0);
  if (!sent?.length || !ranges || sent.length % (2 * ranges)) return null;
  const elements = sent.length / (2 * ranges);
  const channels = config ? config.transmitters * config.receivers : 0;
  const array = config?.array && channels === elements ? config.array : `ula${elements}`;
  const data = Float64Array.from(sent);
  const estimator = new api.Estimator({ method: 'bartlett', array, gridPoints: GRID_POINTS });
  try {
    const { spectra } = estimator.estimateBatch(
      { snapshots: { data, shape: [ranges, elements, 1] } },
      { spectra: true },
    );
    if (!spectra) return null;
    const { azimuthDeg, power } = spectra;
    const values = new Float64Array(power.length);
    for (let i = 0; i < ranges; i++)
      for (let j = 0; j < azimuthDeg.length; j++)
        values[j * ranges + i] = 10 * Math.log10(Math.max(power[i * azimuthDeg.length + j] as number, 1e-12));
    return {
      x: { values: azimuthDeg, label: AZIMUTH.label, name: 'azimuth', column: 'azimuth_deg' },
      y: rangeAxis(ranges, config),
      xAxis: AZIMUTH,
      values,
      remarks: [
        `At zero Doppler, by the FFT beamformer over ${elements} antennas${array.startsWith('ula') ? ' half a wavelength apart' : ''}; levels over the board’s own unit.`,
      ],
    };
  } finally {
    estimator.free();
  }
}
