/** What a screen reader is told: the last text, once changes have settled. */
import { signal } from '@preact/signals';

export const announcement = signal('');
let timer: ReturnType<typeof setTimeout> | undefined;

export function announce(text: string, delayMs = 700): void {
  clearTimeout(timer);
  timer = setTimeout(() => {
    announcement.value = text;
  }, delayMs);
}
