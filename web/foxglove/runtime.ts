/** The calibration, opened out of this script when the first panel needs it. */
import { initDrives } from 'boresight';

let state: 'closed' | 'open' = 'closed';

/** Whether it can be used. */
export const isOpen = (): boolean => state === 'open';

/** Opens it, once for all panels; a failure is tried anew by the next. */
export async function opened(): Promise<void> {
  await initDrives();
  state = 'open';
}
