/** Has the site kept by its service worker, once the page is there, and tells of a newer release. */
import { signal } from '@preact/signals';
import { quiet } from '../quiet.ts';
import { mayKeep } from './kept.ts';

declare const KEPT_OFFLINE: boolean;

/** Set when a newer release than this page's is there; `start` shows it. */
export const newRelease = signal<{ start(): void } | null>(null);

export async function keepOffline(): Promise<void> {
  if (!KEPT_OFFLINE || !('serviceWorker' in navigator)) return;
  await quiet();
  if (!mayKeep.peek()) return;
  try {
    const { register } = await import('./register.ts');
    await register((start) => {
      newRelease.value = { start };
    });
  } catch {
    // A browser that keeps nothing, as in private windows, shows the site all the same.
  }
}
