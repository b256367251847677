/** The pool that elements with files work on: one for all, or the host's own. */
import { createPool, type Pool } from 'boresight/worker';

let given: Pool | null = null;
let own: Pool | null = null;
let users = 0;

/** Has elements work on a pool of the host's, which ends it; `null` for one of their own. */
export function usePool(pool: Pool | null): void {
  given = pool;
}

/** The pool, until `release`. */
export function acquire(): Pool {
  users += 1;
  if (given) return given;
  own ??= createPool({ workers: 1 });
  return own;
}

/** Without users the elements' own pool ends, with its workers. */
export function release(): void {
  users -= 1;
  if (users > 0 || !own) return;
  own.terminate();
  own = null;
}
