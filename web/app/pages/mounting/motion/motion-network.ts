/** The network that motions by DeepEgo and DeepEgo+ need: that of the package, or weights of one's own. */
import { signal } from '@preact/signals';
import type { CalibrationOptions } from 'boresight';
import shipped from '../../../../../models/motion/deepego-plus.bin?url';
import { byteSize } from '../../../../plots/format.ts';
import { FileProblem, type Problem } from '../../../data.ts';
import type { Way } from './ways.ts';

/** Weights of one's own, which are in no link. */
export const ownNetwork = signal<{ name: string; bytes: Uint8Array } | null>(null);
export const networkProblem = signal<(Problem & { file: string }) | null>(null);

const numbers = new WeakMap<object, number>();
let last = 0;

/** Tells files apart that have the same name and size. */
export function networkNumber(own: object): number {
  const number = numbers.get(own) ?? ++last;
  numbers.set(own, number);
  return number;
}

/** More than the weights of any such network. */
const LARGEST_BYTES = 16 * 1024 * 1024;

export type Motion = CalibrationOptions['motion'];

export const needsNetwork = (motion: Motion | 'auto'): boolean => motion === 'deepego' || motion === 'deepego-plus';

/** The motion of a way: the recursive ones find it themselves, and take from a network what stands. */
export const motionOf = (way: Way, motion: Motion): Motion =>
  motion === 'deepego-plus' && (way === 'recursive' || way === 'joint') ? 'deepego' : motion;

let pending: Promise<Uint8Array> | undefined;

/** The bytes of the network in use; what failed is tried again. */
export function network(): Promise<Uint8Array> {
  const own = ownNetwork.peek();
  if (own) return Promise.resolve(own.bytes);
  pending ??= fetchShipped().catch((error: unknown) => {
    pending = undefined;
    throw error;
  });
  return pending;
}

async function fetchShipped(): Promise<Uint8Array> {
  const response = await fetch(shipped);
  if (!response.ok) throw new FileProblem('not-loaded', 'deepego-plus.bin', `the server answered ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

/** Takes weights of one's own; whether they are such is told where they are used. */
export async function openNetwork(file: File): Promise<void> {
  if (file.size > LARGEST_BYTES) {
    const message = `${byteSize(file.size)}; at most ${byteSize(LARGEST_BYTES)} are expected`;
    networkProblem.value = { code: 'too-large', message, file: file.name };
    return;
  }
  networkProblem.value = null;
  ownNetwork.value = { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) };
}
