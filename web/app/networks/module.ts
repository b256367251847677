/**
 * Whether the site has the module that runs networks. A published site has; `npm start` serves the demo first and builds the
 * module behind it (scripts/lib/build/networks-later.mjs).
 */
declare const WITHOUT_NETWORKS: boolean;

export const hasModule = !WITHOUT_NETWORKS;

const POLL_MS = 2000;
/** The script of this build, whose name changes with its contents. */
const script = (): string => document.querySelector('script[type="module"][src]')?.getAttribute('src') ?? '';
let waiting: Promise<void> | undefined;

/** Resolves at once where the module is there; otherwise the page reloads with it once it is built. */
export function moduleReady(): Promise<void> {
  if (hasModule) return Promise.resolve();
  waiting ??= new Promise(() => {
    setInterval(() => void reloadWhenBuilt(), POLL_MS);
  });
  return waiting;
}

async function reloadWhenBuilt(): Promise<void> {
  const response = await fetch(location.pathname, { cache: 'no-store' }).catch(() => null);
  if (response?.ok && !(await response.text()).includes(script())) location.reload();
}
