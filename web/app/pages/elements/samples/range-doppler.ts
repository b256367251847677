import python from '../python/range-doppler.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

const targets = [
  { rangeM: 70, rateMps: -6, azimuthDeg: -4 },
  { rangeM: 110, rateMps: 3, azimuthDeg: 10 },
];
const array = 'ula8';
const waveform = from('waveform', ({ waveform }) => waveform);

export const rangeDoppler: Sample = {
  tag: 'boresight-range-doppler',
  title: 'Two targets that move',
  leaves: formOf('DetectionOptions'),
  steps: (options) => [
    { name: 'waveform', call: 'waveformPreset', args: ['3dcnn-simulated'] },
    { name: 'cube', call: 'simulateCube', args: [{ waveform, array, targets, snrDb: 10, seed: 2 }] },
    {
      name: 'frames',
      call: 'processCube',
      args: [from('cube', ({ cube }) => cube), { waveform, array, ...options }],
    },
  ],
  properties: () => ({ frame: from('frames[0]', ({ frames }) => frames[0]) }),
  python,
};
