import python from '../python/mounting-angle.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

const SENSOR = 1;
const drive = { scenario: 'city', durationS: 60, seed: 1, misalignmentDeg: { [SENSOR]: 0.5 } };

export const mountingAngle: Sample = {
  tag: 'boresight-mounting-angle',
  title: 'An angle as the car drives',
  leaves: formOf('CalibrationOptions', ['xM', 'yM', 'nominalDeg']),
  settings: { 'nominal-deg': '-85' },
  steps: (options) => [
    { name: 'drive', call: 'simulateDrive', args: [drive] },
    {
      name: 'found',
      call: 'calibrateDrive',
      args: [from('drive', ({ drive }) => drive), { sensor: SENSOR, ...options }],
    },
  ],
  properties: () => ({ history: from('found.history', ({ found }) => found.history) }),
  python,
};
