/** The code that is shown. Its dialog, and what makes the code, come when it is first asked for. */
import { signal } from '@preact/signals';
import type { ComponentType } from 'preact';
import type { Code } from './code.ts';

/** Gives a page's code; of what a page makes it, the page's own module knows. */
export type CodeSource = () => Promise<() => Code>;

export const shownCode = signal<{ Dialog: ComponentType<{ code: Code }>; code: Code } | null>(null);
/** It could not be loaded, which a line that is down may do. */
export const codeProblem = signal(false);

/**
 * Fails where the server does not answer. Chromium keeps a failed import for the life of the page, so nothing is imported
 * before the server has answered. A service worker answers from its store.
 */
async function reachServer(): Promise<void> {
  if (navigator.serviceWorker?.controller) return;
  const { ok, status } = await fetch(import.meta.url, { method: 'HEAD', cache: 'no-store' });
  if (!ok) throw new Error(`the server answered ${status}`);
}

export async function showCode(source: CodeSource): Promise<void> {
  codeProblem.value = false;
  try {
    await reachServer();
    const [{ CodeDialog: Dialog }, make] = await Promise.all([import('./dialog.tsx'), source()]);
    shownCode.value = { Dialog, code: make() };
  } catch (error) {
    codeProblem.value = true;
    console.error(error);
  }
}

/** Shows the code of what is there, once it was asked for. */
export function ShownCode() {
  const shown = shownCode.value;
  return shown && <shown.Dialog code={shown.code} />;
}
