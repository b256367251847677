import python from '../python/doppler-azimuth.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

const SENSOR = 2;
/** A frame while the car drives. */
const FRAME = 100;

export const dopplerAzimuth: Sample = {
  tag: 'boresight-doppler-azimuth',
  title: 'What stands, and what moves',
  leaves: formOf('CalibrationOptions', ['xM', 'yM', 'nominalDeg']),
  settings: { sector: '80' },
  steps: (options) => [
    { name: 'drive', call: 'simulateDrive', args: [{ scenario: 'country-road', durationS: 20, seed: 1 }] },
    {
      name: 'found',
      call: 'calibrateDrive',
      args: [from('drive', ({ drive }) => drive), { sensor: SENSOR, weights: true, ...options }],
    },
    { name: 'motion', call: 'scanMotion', args: [from('drive', ({ drive }) => drive)] },
    {
      name: 'scan',
      call: 'driveFrame',
      args: [
        from('drive', ({ drive }) => drive),
        from(`found.frames.scan[${FRAME}]`, ({ found }) => found.frames.scan[FRAME]),
        from('motion', ({ motion }) => motion),
      ],
    },
  ],
  properties: () => ({
    frame: {
      azimuthDeg: from('scan.azimuthDeg', ({ scan }) => scan.azimuthDeg),
      rangeRateMps: from('scan.rangeRateMps', ({ scan }) => scan.rangeRateMps),
      weights: from(
        `found.frames.weights.values.subarray(...found.frames.weights.offsets.subarray(${FRAME}, ${FRAME + 2}))`,
        ({ found }) => {
          const { offsets, values } = found.frames.weights;
          return values.subarray(...offsets.subarray(FRAME, FRAME + 2));
        },
      ),
      motion: {
        vxMps: from(`found.frames.vxMps[${FRAME}]`, ({ found }) => found.frames.vxMps[FRAME]),
        vyMps: from(`found.frames.vyMps[${FRAME}]`, ({ found }) => found.frames.vyMps[FRAME]),
      },
    },
  }),
  python,
};
