/** The code that is shown. Its dialog, and what makes the code, come when it is first asked for. */
import { signal } from '@preact/signals';
import type { ComponentType } from 'preact';
import type { Code } from './code.ts';

/** Gives a page's code; of what a page makes it, the page's own module knows. */
export type CodeSource = () => Promise<() => Code>;

export const shownCode = signal<{ Dialog: ComponentType<{ code: Code }>; code: Code } | null>(null);
/** It could not be loaded, which a line that is down may do. */
export const codeProblem = signal(false);

export async function showCode(source: CodeSource): Promise<void> {
  codeProblem.value = false;
  try {
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
