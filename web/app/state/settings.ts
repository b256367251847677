/** Settings of the viewer that are not part of a link. */
import { signal } from '@preact/signals';

export const showHelp = signal(false);

const MOVED = 'boresight-moved';

function remembered(): boolean {
  try {
    return localStorage.getItem(MOVED) !== null;
  } catch {
    return false;
  }
}

/** Whether this viewer has found out that targets can be moved. */
export const hasMoved = signal(remembered());

export function rememberMoved(): void {
  if (hasMoved.peek()) return;
  hasMoved.value = true;
  try {
    localStorage.setItem(MOVED, '1');
  } catch {
    // It is told again on the next visit.
  }
}
