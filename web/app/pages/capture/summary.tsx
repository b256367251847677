/** The numbers engineers look for first, from the configuration alone. */
import type { ArrayGeometry, CaptureInfo } from 'boresight';
import { engineering, fixed, significant } from '../../../plots/format.ts';
import { captureState } from './state.ts';

const SAMPLES = { complex: { iq: 'I before Q', qi: 'Q before I' }, real: { iq: 'real', qi: 'real' } };
const LAYOUTS = { 'two-lane': 'two lanes', 'four-lane': 'four lanes', cascade: 'a cascade of four chips' };
/** How transmitters share the chirps. */
const SHARING = {
  'time-division': 'in turn',
  'binary-phase': 'at once in binary phase',
  'doppler-division': 'at once in Doppler division',
} as const;

export function Summary({ info, geometry }: { info: CaptureInfo; geometry: ArrayGeometry | null }) {
  const { waveform, summary, platform, array } = info.config;
  const { array: chosen } = captureState.value;
  const facts: [string, string, string, string?][] = [
    [
      'Range resolution',
      `${significant(summary.rangeResolutionM * 100)}\u00a0cm`,
      'c / 2B, with B the bandwidth sampled',
      'rangeResolution',
    ],
    [
      'Maximum range',
      `${significant(summary.maxRangeM, 4)}\u00a0m`,
      waveform.sampling === 'real'
        ? 'Where the beat frequency reaches half the sample rate (real sampling)'
        : 'Where the beat frequency reaches the sample rate (complex sampling)',
      'maxRange',
    ],
    [
      'Rate resolution',
      `${significant(summary.rateResolutionMps)}\u00a0m/s`,
      'λ / 2T, with T the time of a frame’s chirps',
      'rateResolution',
    ],
    [
      'Rate limit',
      `±${significant(summary.maxRateMps)}\u00a0m/s`,
      'λ / 4T, with T the time between chirps of one transmitter',
      'maxRate',
    ],
    [
      'Angular resolution',
      `${fixed(geometry?.resolutionDeg ?? Number.NaN, 1)}°`,
      'First null of the beam at boresight: λ over the aperture with half a spacing at either end',
      'angularResolution',
    ],
    ['Bandwidth', engineering(summary.bandwidthHz, 'Hz'), 'Swept while samples are taken', 'bandwidth'],
    [
      'Centre frequency',
      engineering(summary.centreFrequencyHz, 'Hz', 4),
      `Wavelength ${significant(summary.wavelengthM * 1000)} mm`,
      'centre',
    ],
    [
      'Frame',
      `${waveform.loops} × ${waveform.multiplexing === 'doppler-division' ? 1 : waveform.transmitters} chirps, ${significant(waveform.frameIntervalS * 1000)}\u00a0ms`,
      `${significant(summary.frameTimeS * 1000)} ms of them transmitting`,
      'frame',
    ],
    [
      'Samples a chirp',
      `${waveform.samples} at ${engineering(waveform.sampleRateHz, 'S/s', 4)}`,
      `Slope ${significant(waveform.slopeHzPerS / 1e12, 4)} MHz/µs; ${SAMPLES[waveform.sampling ?? 'complex'][info.config.iqOrder]}, ${LAYOUTS[info.config.layout]}`,
      'samples',
    ],
    [
      'Array',
      geometry
        ? `${chosen === 'auto' ? (array ?? platform ?? 'configured') : chosen}, ${geometry.positions.length} virtual`
        : 'not known',
      `${info.config.transmitters} transmitters ${SHARING[waveform.multiplexing ?? 'time-division']}, ${info.config.receivers} receivers`,
      'array',
    ],
  ];
  return (
    <dl class="facts" data-facts="capture">
      {facts.map(([term, value, help, key]) => (
        <div key={term} title={help} data-fact={key}>
          <dt>{term}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
