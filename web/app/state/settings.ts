/** Settings of the viewer that are not part of a link. */
import { signal } from '@preact/signals';

export const showHelp = signal(false);
