import python from '../python/point-cloud.py?raw';
import { formOf, from, type Sample } from '../sample.ts';

/** A scan of the drive, and its sensor's place. */
const SCAN = 40;

export const pointCloud: Sample = {
  tag: 'boresight-point-cloud',
  title: 'A scan',
  leaves: formOf('SimulateDriveOptions', ['car']),
  usual: { durationS: 10, seed: 1 },
  steps: (options) => [
    { name: 'drive', call: 'simulateDrive', args: [options] },
    { name: 'motion', call: 'scanMotion', args: [from('drive', ({ drive }) => drive)] },
    {
      name: 'scan',
      call: 'driveFrame',
      args: [from('drive', ({ drive }) => drive), SCAN, from('motion', ({ motion }) => motion)],
    },
  ],
  properties: () => ({
    points: from('scan', ({ scan }) => scan),
    mounting: from('drive.sensors.find(({ id }) => id === scan.sensor)', ({ drive, scan }) =>
      drive.sensors.find(({ id }: { id: number }) => id === scan.sensor),
    ),
  }),
  python,
};
