/**
 * Keeps the demo for use offline. Pages, code and small examples of a release are kept together, so that no two releases
 * mix; large files (networks, the module that runs them) are kept once they were used. Their names change with their
 * contents, so a name once kept is never asked for again. The page itself is asked for anew, and taken from what is
 * kept where no answer comes.
 */
import { cacheNames, clientsClaim, setCacheNameDetails } from 'workbox-core';
import { cleanupOutdatedCaches, getCacheKeyForURL, matchPrecache, precacheAndRoute } from 'workbox-precaching';
import { registerRoute } from 'workbox-routing';
import { CacheFirst, NetworkOnly } from 'workbox-strategies';
import { CACHE_PREFIX, cacheEnding, type ReleaseQuestion } from './names.ts';

/** Files of this release: `web/offline.ts` names them when they are built. */
declare const RELEASE: {
  /** Kept at once. */
  files: { url: string; revision: string | null }[];
  /** Kept once they were used. */
  large: string[];
};

/** The few things used of a service worker's global scope, which the DOM's types do not have. */
const scope = self as unknown as {
  registration: ServiceWorkerRegistration;
  skipWaiting(): Promise<void>;
  addEventListener(type: 'activate', then: (event: { waitUntil(work: Promise<unknown>): void }) => void): void;
  addEventListener(
    type: 'message',
    then: (event: MessageEvent<ReleaseQuestion | { type: 'SKIP_WAITING' }>) => void,
  ): void;
};

/** How long the newest page is waited for, s. */
const PATIENCE_S = 3;

setCacheNameDetails({
  prefix: CACHE_PREFIX,
  precache: 'release',
  runtime: 'large',
  suffix: cacheEnding(scope.registration.scope),
});
clientsClaim();
cleanupOutdatedCaches();

const { pathname: home } = new URL(scope.registration.scope);
registerRoute(
  ({ request, url }) => request.mode === 'navigate' && (url.pathname === home || url.pathname === `${home}index.html`),
  new NetworkOnly({
    networkTimeoutSeconds: PATIENCE_S,
    plugins: [{ handlerDidError: () => matchPrecache('index.html') }],
  }),
);
precacheAndRoute(RELEASE.files);

const large = new Set(RELEASE.large.map((file) => new URL(file, scope.registration.scope).href));
registerRoute(
  ({ url }) => large.has(url.href),
  new CacheFirst({
    // Where the viewer has removed what is kept, nothing is kept anew.
    plugins: [{ cacheWillUpdate: async ({ response }) => ((await caches.has(cacheNames.precache)) ? response : null) }],
  }),
);

scope.addEventListener('activate', (event) => event.waitUntil(forgetOthers()));

/** Removes large files that are no part of this release. */
async function forgetOthers(): Promise<void> {
  const cache = await caches.open(cacheNames.runtime);
  for (const request of await cache.keys()) if (!large.has(request.url)) await cache.delete(request);
}

scope.addEventListener('message', ({ data, ports }) => {
  if (data.type === 'SAME_RELEASE') ports[0]?.postMessage(getCacheKeyForURL(data.script) !== undefined);
  else if (data.type === 'SKIP_WAITING') void scope.skipWaiting();
});
