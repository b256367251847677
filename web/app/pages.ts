/** Each page is a script of its own, so that the first one waits for no other. */
import { signal } from '@preact/signals';
import type { ComponentType } from 'preact';
import { quiet } from './quiet.ts';
import { PAGES, type Page } from './state/route.ts';

const SCRIPTS: Record<Page, () => Promise<ComponentType>> = {
  angle: async () => (await import('./pages/angle/page.tsx')).AnglePage,
  capture: async () => (await import('./pages/capture/page.tsx')).CapturePage,
  mounting: async () => (await import('./pages/mounting/page.tsx')).MountingPage,
  birdseye: async () => (await import('./pages/birdseye/page.tsx')).BirdseyePage,
  networks: async () => (await import('./pages/networks/page.tsx')).NetworksPage,
  live: async () => (await import('./pages/live/page.tsx')).LivePage,
  elements: async () => (await import('./pages/elements/page.tsx')).ElementsPage,
};

/** Pages that are here. */
export const components = signal<Partial<Record<Page, ComponentType>>>({});

export async function loadPage(page: Page): Promise<void> {
  if (components.peek()[page]) return;
  const component = await SCRIPTS[page]();
  components.value = { ...components.peek(), [page]: component };
}

/** Has the others come once the first is loaded: they are to open at once, and without a line. */
export async function loadOthers(): Promise<void> {
  await quiet();
  performance.mark('other pages');
  // What fails is tried again when it is opened.
  for (const page of PAGES) await loadPage(page).catch(() => {});
}
