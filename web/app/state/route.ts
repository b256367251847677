/** Which page is shown, and its state as the address's query after the hash. */
import { signal } from '@preact/signals';

export const PAGES = ['angle', 'capture', 'mounting', 'birdseye', 'networks', 'live', 'elements'] as const;
export type Page = (typeof PAGES)[number];

export const TITLES: Record<Page, string> = {
  angle: 'Angle lab',
  capture: 'Capture',
  mounting: 'Mounting angle',
  birdseye: 'Bird’s-eye view',
  networks: 'Networks',
  live: 'Live',
  elements: 'Elements',
};

export interface Route {
  page: Page;
  params: URLSearchParams;
}

function parse(hash: string): Route {
  const [path = '', query = ''] = hash.replace(/^#\/?/, '').split('?', 2);
  const page = PAGES.find((name) => name === path) ?? 'angle';
  return { page, params: new URLSearchParams(query) };
}

/** Changes when the address is edited, a link is followed, or one goes back. */
export const route = signal<Route>(parse(location.hash));

/** The address that {@link route} is of. */
let known = location.hash;

addEventListener('hashchange', () => {
  flush();
  known = location.hash;
  route.value = parse(known);
});

/** The address of what is shown now, which the browser may be told of only later. */
export function link(): string {
  return `${location.href.split('#')[0]}${pageAddress(route.peek().page, shownParams.peek())}`;
}

export function pageAddress(page: Page, params?: URLSearchParams): string {
  const query = params && readable(params);
  return `#/${page}${query ? `?${query}` : ''}`;
}

/** Commas and colons may stand in a fragment as they are, and read better. */
export const readable = (params: URLSearchParams): string =>
  params.toString().replaceAll('%2C', ',').replaceAll('%3A', ':').replaceAll('%3B', ';');

/** Each page's last parameters, so that going back to it finds it as it was. */
const last = new Map<Page, URLSearchParams>();

export function lastParams(page: Page): URLSearchParams | undefined {
  return last.get(page);
}

/** What a page is found with when it is shown next; without parameters, as on a fresh visit. */
export function setParams(page: Page, params: URLSearchParams | null): void {
  if (params) last.set(page, params);
  else last.delete(page);
}

/** The parameters of the page that is shown, as they are or soon will be in the address. */
export const shownParams = signal<URLSearchParams>(route.peek().params);

let pending: { page: Page; params: URLSearchParams } | null = null;
let timer: ReturnType<typeof setTimeout> | undefined;

function flush(): void {
  clearTimeout(timer);
  timer = undefined;
  pending = null;
}

/** Puts what is pending into the address, unless that has changed and its event is still to come. */
export function writePending(): void {
  const shown = pending;
  flush();
  if (!shown || location.hash !== known || parse(known).page !== shown.page) return;
  history.replaceState(null, '', pageAddress(shown.page, shown.params));
  known = location.hash;
}

/** Puts the state into the address without a new history entry; browsers limit how often. */
export function writeParams(page: Page, params: URLSearchParams): void {
  last.set(page, params);
  if (page === route.peek().page) shownParams.value = params;
  pending = { page, params };
  timer ??= setTimeout(writePending, 150);
}
