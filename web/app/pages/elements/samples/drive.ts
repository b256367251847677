import python from '../python/drive.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

export const drive: Sample = {
  tag: 'boresight-drive',
  title: 'A front radar in traffic',
  leaves: formOf('CalibrationOptions', ['xM', 'yM', 'nominalDeg']),
  recording: { of: 'drive', files: ['front_radar.csv.gz', 'pose_10hz.csv.gz'] },
  settings: { method: 'least-squares', 'x-m': '3', 'nominal-deg': '0', 'tolerance-deg': '3' },
  steps: () => [],
  properties: (options) => ({
    ...(Object.keys(options).length ? { options } : {}),
    files: from('files', ({ files }) => files),
  }),
  python,
};
