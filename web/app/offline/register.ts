/** The page's side of the service worker. Its own chunk, which is loaded when the page is there. */
import { Workbox } from 'workbox-window';
import type { ReleaseQuestion } from './names.ts';

/** `tell` is called with what starts a newer release than this page's. */
export async function register(tell: (start: () => void) => void): Promise<void> {
  const worker = new Workbox('./service-worker.js');
  const script = document.querySelector<HTMLScriptElement>('script[type="module"][src]')?.src ?? '';
  const question: ReleaseQuestion = { type: 'SAME_RELEASE', script };
  /** A release that waits is this page's own, which the server has given already, or a newer one. */
  const waits = async (waiting: ServiceWorker | undefined): Promise<void> => {
    if (!waiting) return;
    if (await answer(waiting, question)) worker.messageSkipWaiting();
    else
      tell(() => {
        worker.addEventListener('controlling', () => location.reload());
        worker.messageSkipWaiting();
      });
  };
  worker.addEventListener('waiting', ({ sw }) => void waits(sw));
  worker.addEventListener('controlling', () => void controlled());
  /** What was loaded before is handed to the worker that now keeps it; one of another release came from another tab. */
  const controlled = async (): Promise<void> => {
    const { controller } = navigator.serviceWorker;
    if (!controller) return;
    if (!(await answer(controller, question))) {
      tell(() => location.reload());
      return;
    }
    const urlsToCache = performance.getEntriesByType('resource').map(({ name }) => name);
    controller.postMessage({ type: 'CACHE_URLS', payload: { urlsToCache } });
  };
  await worker.register({ immediate: true });
  // A tab may stay open for days.
  document.addEventListener('visibilitychange', () => {
    if (document.visibilityState === 'visible') worker.update().catch(() => {});
  });
}

function answer(worker: ServiceWorker, question: ReleaseQuestion): Promise<boolean> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = ({ data }) => resolve(data === true);
    worker.postMessage(question, [port2]);
  });
}
