/** Copies text, and has a button say for a moment what became of it. */
import { type ReadonlySignal, signal } from '@preact/signals';
import { announce } from '../state/announce.ts';

const SHOWN_MS = 2500;

/** `what` was copied, in words; `instead` is what to do where the browser does not let pages copy. */
export function copier(what: string, instead: string) {
  const told = signal<'Copied' | 'Not copied' | null>(null);
  return {
    told: told as ReadonlySignal<typeof told.value>,
    async copy(text: string): Promise<void> {
      setTimeout(() => {
        told.value = null;
      }, SHOWN_MS);
      try {
        await navigator.clipboard.writeText(text);
        told.value = 'Copied';
        announce(`${what} is copied.`, 0);
      } catch {
        told.value = 'Not copied';
        announce(`The browser does not let pages copy; ${instead}.`, 0);
      }
    },
  };
}
