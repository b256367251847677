/** Writes that come within this time are kept together: waiting for a disk is what takes longest. */
const GATHER_MS = 2;

/**
 * Gathers writes of many objects for one commit; each promise stands for the commit that its write is in.
 *
 * @template T
 * @template R
 * @param {(writes: T[]) => R | Promise<R>} commit
 * @returns {(write: T) => Promise<R>}
 */
export function together(commit) {
  /** @type {T[]} */
  let waiting = [];
  /** @type {Promise<R> | undefined} */
  let next;
  /** @type {Promise<unknown>} */
  let last = Promise.resolve();
  return (write) => {
    waiting.push(write);
    next ??= Promise.all([last, new Promise((resolve) => setTimeout(resolve, GATHER_MS))]).then(async () => {
      const writes = waiting;
      waiting = [];
      next = undefined;
      const done = (async () => commit(writes))();
      last = done.catch(() => {});
      return done;
    });
    return next;
  };
}
