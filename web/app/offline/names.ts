/** What pages and service worker both name. */

export const CACHE_PREFIX = 'boresight';

/** Ending of the names of this site's caches: another site of the same server has its own. */
export const cacheEnding = (scope: string): string => new URL(scope).pathname;

/** Asks a service worker whether it is of the release whose main script this is. */
export interface ReleaseQuestion {
  type: 'SAME_RELEASE';
  script: string;
}
