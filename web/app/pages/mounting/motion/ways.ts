/** The ways to an angle: the package's methods for one radar, and the joint one for all. */
import type { CalibrationMethod } from 'boresight';
import { api } from '../../../data.ts';
import { optionsOf } from '../../../options.ts';

export type Way = CalibrationMethod | 'joint';

const { fallback, values } = optionsOf('CalibrationOptions').field('method');

export const WAYS: readonly Way[] = [fallback, ...values().filter((name) => name !== fallback), 'joint'];

let known: ReadonlyMap<Way, { title: string; reference: string }> | undefined;

/** What a way is called, and where it comes from. */
export function about(way: Way): { title: string; reference: string } {
  known ??= new Map([
    ...api.calibrationMethods().map(({ name, title, reference }) => [name, { title, reference }] as const),
    [
      'joint',
      {
        title: 'Recursive, all radars together',
        reference: 'Boresight. One scale and bias of the yaw rate for all radars of the drive',
      },
    ],
  ]);
  return known.get(way) ?? { title: way, reference: '' };
}
