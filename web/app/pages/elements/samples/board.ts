import python from '../python/board.py?raw';
import { from, type Sample } from '../sample.ts';

export const board: Sample = {
  tag: 'boresight-board',
  title: 'A recorded board',
  leaves: [],
  settings: { boresight: '', rate: '0' },
  recording: { of: 'board', files: ['xwr16xx_crw_demo_visualizer_2018_1015v2.dat', 'profile.cfg'] },
  steps: () => [],
  properties: () => ({ files: from('files', ({ files }) => files) }),
  python,
};
