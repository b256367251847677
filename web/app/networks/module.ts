/**
 * Whether the module that runs networks is there. It is part of a site that is published; `npm start` serves the page
 * first, and builds the module behind it.
 */
import { signal } from '@preact/signals';
import { FileProblem } from '../data.ts';
import { announce } from '../state/announce.ts';

declare const NETWORKS_LATER: boolean;

/** How far its build is (scripts/lib/networks-behind.mjs). */
export type Build =
  | { state: 'waiting' }
  | { state: 'building'; started: number; step: string; seconds: number }
  | { state: 'failed'; reason: string }
  | { state: 'ready' };

export const moduleBuild = signal<Build>({ state: NETWORKS_LATER ? 'waiting' : 'ready' });

const POLL_MS = 1000;
let following: Promise<void> | undefined;

/** Resolves when the module is there, and rejects where it could not be built; another call then looks again. */
export function moduleReady(): Promise<void> {
  if (!NETWORKS_LATER || moduleBuild.peek().state === 'ready') return Promise.resolve();
  following ??= follow().finally(() => {
    following = undefined;
  });
  return following;
}

async function follow(): Promise<void> {
  for (;;) {
    const now = await ask();
    moduleBuild.value = now;
    if (now.state === 'failed')
      throw new FileProblem('not-built', 'The module that runs networks', `could not be built: ${now.reason}`);
    if (now.state === 'ready') break;
    await new Promise((resolve) => setTimeout(resolve, POLL_MS));
  }
  announce('The module that runs networks is there.');
}

async function ask(): Promise<Build> {
  try {
    const response = await fetch(new URL('/later/state.json', location.href));
    if (!response.ok) throw new Error(`the server answered ${response.status}`);
    const state = (await response.json()) as Build;
    // By the server's clock, which need not be this machine's.
    if (state.state === 'building')
      state.seconds = Math.max(0, (Date.parse(response.headers.get('Date') ?? '') - state.started) / 1000);
    return state;
  } catch (error) {
    return { state: 'failed', reason: `the server that builds it does not answer (${(error as Error).message})` };
  }
}
