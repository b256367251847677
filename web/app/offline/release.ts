/** Has the site kept by its service worker, once the page is there, and tells of a newer release. */
import { signal } from '@preact/signals';
import { mayKeep } from './kept.ts';

declare const KEPT_OFFLINE: boolean;

/** Set when a newer release than this page's is there; `start` shows it. */
export const newRelease = signal<{ start(): void } | null>(null);

/** How long nothing comes before the page counts as loaded, ms: keeping must not delay its first picture. */
const QUIET_MS = 3000;

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

function quiet(): Promise<void> {
  return new Promise((resolve) => {
    const done = (): void => {
      observer.disconnect();
      resolve();
    };
    let timer = setTimeout(done, QUIET_MS);
    const observer = new PerformanceObserver(() => {
      clearTimeout(timer);
      timer = setTimeout(done, QUIET_MS);
    });
    observer.observe({ type: 'resource' });
  });
}
