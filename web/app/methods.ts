/** The methods that pages list: those of the package, which is loaded before a page is shown. */
import type { Method, MethodInfo } from 'boresight';
import { api } from './data.ts';
import { text } from './state/codec.ts';

export const methodNames = (): Method[] => api.methods().map(({ name }) => name);

/** Those that can work on one snapshot; what a radar's array lacks for them is said beside them. */
export const singleSnapshotMethods = (): MethodInfo[] => api.methods().filter(({ minSnapshots }) => minSnapshots <= 1);

/** Names of the networks that methods use, where it is not the best that fits. */
export const networkNames = text('', (names) => /^[\w.,-]{0,200}$/.test(names));
