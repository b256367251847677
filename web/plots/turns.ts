/** Work for what is out of sight: each in a task of its own, in which the page stays awake. */

const waiting = new Set<() => void>();
let running = false;

/** Has it done once its turn comes; asked for again before that, it is done once. */
export function inTurn(work: () => void): void {
  waiting.add(work);
  if (!running) next();
}

/** Does it now if it waits. */
export function atOnce(work: () => void): void {
  if (waiting.delete(work)) work();
}

/** It is not to be done any more. */
export function drop(work: () => void): void {
  waiting.delete(work);
}

function next(): void {
  running = waiting.size > 0;
  if (running)
    setTimeout(() => {
      const [work] = waiting;
      if (work) atOnce(work);
      next();
    });
}
