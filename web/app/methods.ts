/** The methods that pages list: those of the package, which is loaded before a page is shown. */
import type { EstimatorOptions, Method, MethodInfo, Unsuited } from 'boresight';
import { api } from './data.ts';
import { text } from './state/codec.ts';

export const methodNames = (): Method[] => api.methods().map(({ name }) => name);

/** Those that can work on one snapshot; what a radar's array lacks for them is said beside them. */
export const singleSnapshotMethods = (): MethodInfo[] => api.methods().filter(({ minSnapshots }) => minSnapshots <= 1);

/** Names of the networks that methods use, where it is not the best that fits. */
export const networkNames = text('', (names) => /^[\w.,-]{0,200}$/.test(names));

/** What ways to count sources are called. */
export const COUNTED = { auto: 'counted', mdl: 'counted, MDL', aic: 'counted, AIC' };

const WHY: Readonly<Record<Unsuited, string>> = {
  'one-place': 'needs elements at different places along y',
  'uniform-array': 'needs a uniform linear array',
  grid: 'needs elements on an evenly spaced grid',
  elevation: 'tells no elevation, and the array spans an area',
  'no-neighbours': 'needs elements on neighbouring places of its grid',
  'few-snapshots': 'needs more snapshots, averaging or smoothing',
  'many-snapshots': 'takes a single snapshot only',
};

/** Why a method cannot work on an array, or on so many snapshots of it, in words; null where it can. */
export function whyUnsuited(
  options: EstimatorOptions,
  snapshots: number,
  words: Partial<Record<Unsuited, string>> = {},
): string | null {
  const reason = api.unsuited(options, snapshots);
  return reason && (words[reason] ?? WHY[reason]);
}

/** Those that take long a cell, the longest last; what is not here is quick. */
const SLOW: readonly (Method | 'network')[] = [
  'nomp',
  'iaa',
  'network',
  'maximum-likelihood',
  'atomic-norm',
  'sparse-bayesian',
];

/** In the order in which they answer soonest: nobody waits for a quick method behind a slow one. */
export function quickestFirst(methods: readonly Method[]): Method[] {
  const networks = new Set(api.methods().flatMap(({ name, network }) => (network ? [name] : [])));
  const rank = (method: Method): number => SLOW.indexOf(networks.has(method) ? 'network' : method);
  return [...methods].sort((a, b) => rank(a) - rank(b));
}
