/** Writes that come within this time are kept together: waiting for a disk is what takes longest. */
const GATHER_MS = 2;

/**
 * Gathers writes of many objects for one commit; each promise stands for the commit that its write is in.
 *
 * @template T
 * @param {(writes: T[]) => void | Promise<void>} commit
 * @returns {(write: T) => Promise<void>}
 */
export function together(commit) {
  /** @type {T[]} */
  let waiting = [];
  /** @type {Promise<void> | undefined} */
  let next;
  let last = Promise.resolve();
  return (write) => {
    waiting.push(write);
    next ??= Promise.all([last, new Promise((resolve) => setTimeout(resolve, GATHER_MS))]).then(async () => {
      const writes = waiting;
      waiting = [];
      next = undefined;
      const done = (async () => commit(writes))();
      last = done.catch(() => {});
      await done;
    });
    return next;
  };
}
