import python from '../python/birds-eye.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

export const birdsEye: Sample = {
  tag: 'boresight-birds-eye',
  title: 'A street by one radar',
  leaves: formOf('StreetOptions'),
  usual: { seed: 1 },
  steps: (options) => [
    { name: 'street', call: 'simulateStreet', args: [{ radar: 'front-left', ...options }] },
    {
      name: 'image',
      call: 'imageFrame',
      args: [
        from('street.cube', ({ street }) => street.cube),
        {
          array: from('street.radar.array', ({ street }) => street.radar.array),
          waveform: from('street.radar.waveform', ({ street }) => street.radar.waveform),
          angle: { method: 'bartlett' },
        },
      ],
    },
    {
      name: 'view',
      call: 'birdsEyeView',
      args: [
        {
          radars: [
            {
              map: from('image.map', ({ image }) => image.map),
              mounting: from('street.radar.mounting', ({ street }) => street.radar.mounting),
            },
          ],
          grid: { xM: [-5, 60], yM: [-25, 35], cellM: 0.25 },
        },
      ],
    },
  ],
  properties: () => ({ view: from('view', ({ view }) => view) }),
  python,
};
