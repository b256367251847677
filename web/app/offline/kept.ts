/** What the browser keeps of this site, so that it works offline, and whether it may. */
import { signal } from '@preact/signals';
import { CACHE_PREFIX, cacheEnding } from './names.ts';

const CHOICE = 'boresight-keep';

function chosen(): boolean {
  try {
    return localStorage.getItem(CHOICE) !== 'no';
  } catch {
    return true;
  }
}

/** Whether the viewer lets the site be kept. */
export const mayKeep = signal(chosen());

export function setMayKeep(may: boolean): void {
  mayKeep.value = may;
  try {
    if (may) localStorage.removeItem(CHOICE);
    else localStorage.setItem(CHOICE, 'no');
  } catch {
    // Where storage is off nothing is kept in any case.
  }
}

/** One kind of what is kept. */
export interface Kept {
  title: string;
  files: number;
  bytes: number;
}

async function ownCaches(): Promise<string[]> {
  const ending = cacheEnding(new URL('./', location.href).href);
  return (await caches.keys()).filter((name) => name.startsWith(`${CACHE_PREFIX}-`) && name.endsWith(`-${ending}`));
}

/** What is kept, by kind: nothing where the browser keeps nothing. */
export async function kept(): Promise<Kept[]> {
  const kinds = new Map<string, Kept>();
  try {
    for (const name of await ownCaches()) {
      const cache = await caches.open(name);
      for (const request of await cache.keys()) {
        const title = kindOf(new URL(request.url).pathname);
        const { files, bytes } = kinds.get(title) ?? { files: 0, bytes: 0 };
        const size = (await (await cache.match(request))?.blob())?.size ?? 0;
        kinds.set(title, { title, files: files + 1, bytes: bytes + size });
      }
    }
  } catch {
    // Storage may be off.
  }
  return [...kinds.values()];
}

function kindOf(path: string): string {
  if (path.endsWith('.onnx')) return 'networks that were used';
  if (/neural[^/]*\.wasm$/.test(path)) return 'the module that runs networks';
  return 'pages, signal processing and examples';
}

/** Removes all that is kept. Pages that are open go on. */
export async function removeKept(): Promise<void> {
  try {
    await (await navigator.serviceWorker?.getRegistration())?.unregister();
    for (const name of await ownCaches()) await caches.delete(name);
  } catch {
    // Storage may be off.
  }
}
