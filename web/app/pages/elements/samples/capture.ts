import python from '../python/capture.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

export const capture: Sample = {
  tag: 'boresight-capture',
  title: 'A recording of a TI board',
  leaves: formOf('DetectionOptions'),
  recording: { of: 'capture', files: ['xwr16xx_crw_dca_module_2018_1015v2.bin', 'profile.cfg'] },
  steps: () => [],
  properties: (options) => ({
    ...(Object.keys(options).length ? { options } : {}),
    files: from('files', ({ files }) => files),
  }),
  python,
};
