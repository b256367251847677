/** What is not seen at first: it comes in a task of its own, so that what is seen does not wait for it. */
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect } from 'preact/hooks';
import { drop, inTurn } from '../../plots/turns.ts';

export function InTurn({ children }: { children: ComponentChildren }) {
  const isHere = useSignal(false);
  useEffect(() => {
    const show = (): void => {
      isHere.value = true;
    };
    inTurn(show);
    return () => drop(show);
  }, []);
  return isHere.value ? children : null;
}
