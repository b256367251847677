import type { Limits } from '../types.js';
import { core } from './instance.js';
import { Instance } from './module.js';

/**
 * Sets what one call may take before it is refused with the code `too-large`, in all modules of this thread; without an
 * argument, the defaults. The workers of a pool have limits of their own, and none on operations: a job can be cancelled.
 */
export function setLimits(limits?: Limits): void {
  core.call(() => Instance.setLimits(limits));
}
