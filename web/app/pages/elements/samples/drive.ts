import { TRACKED_SPEED } from '../../mounting/state.ts';
import python from '../python/drive.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

export const drive: Sample = {
  tag: 'boresight-drive',
  title: 'A front radar in traffic',
  leaves: formOf('CalibrationOptions', ['xM', 'yM', 'nominalDeg']),
  recording: { of: 'drive', files: ['front_radar.csv.gz', 'pose_10hz.csv.gz'] },
  // The log states the radar's place and nominal angle; the limit is the element's own.
  settings: { method: 'least-squares' },
  usual: { minSpeedMps: TRACKED_SPEED },
  steps: () => [],
  properties: (options) => ({
    ...(Object.keys(options).length ? { options } : {}),
    files: from('files', ({ files }) => files),
  }),
  python,
};
