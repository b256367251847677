import { methodNames } from '../../../methods.ts';
import python from '../python/spectrum.py?raw';
import { choiceLeaf, formOf, from, type Sample } from '../sample.ts';

const array = 'ula16';
const targets = [{ azimuthDeg: -12 }, { azimuthDeg: 20, powerDb: -3 }];

export const spectrum: Sample = {
  tag: 'boresight-spectrum',
  title: 'Two targets',
  leaves: [
    choiceLeaf('method', 'Method', 'How angles are estimated.', methodNames, 'capon'),
    ...formOf('SharedEstimatorOptions', ['sources', 'confidence']),
  ],
  usual: { method: 'capon' },
  steps: (options) => [
    { name: 'scene', call: 'simulateSnapshots', args: [{ array, targets, snapshots: 50, snrDb: 20, seed: 1 }] },
    {
      name: 'estimate',
      call: 'estimate',
      args: [
        {
          snapshots: {
            data: from('scene.data', ({ scene }) => scene.data),
            shape: from('scene.shape.slice(1)', ({ scene }) => scene.shape.slice(1)),
          },
        },
        { array, sources: targets.length, ...options },
      ],
    },
  ],
  properties: () => ({
    estimates: from('[estimate]', ({ estimate }) => [estimate]),
    truthDeg: targets.map(({ azimuthDeg }) => azimuthDeg),
  }),
  python,
};
