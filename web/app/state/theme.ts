/** Light or dark: the system's choice unless the user made one. */
import { computed, effect, signal } from '@preact/signals';
import type { ThemeName } from '../../plots/theme.ts';

export type ThemeChoice = 'auto' | ThemeName;
const KEY = 'boresight-theme';
const query = matchMedia('(prefers-color-scheme: dark)');
const system = signal<ThemeName>(query.matches ? 'dark' : 'light');
query.addEventListener('change', () => {
  system.value = query.matches ? 'dark' : 'light';
});

function stored(): ThemeChoice {
  try {
    const value = localStorage.getItem(KEY);
    return value === 'light' || value === 'dark' ? value : 'auto';
  } catch {
    return 'auto';
  }
}

export const themeChoice = signal<ThemeChoice>(stored());
/** Paper is light. */
const print = matchMedia('print');
const printing = signal(print.matches);
print.addEventListener('change', () => {
  printing.value = print.matches;
});

export const theme = computed<ThemeName>(() =>
  printing.value ? 'light' : themeChoice.value === 'auto' ? system.value : themeChoice.value,
);

effect(() => {
  document.documentElement.dataset.theme = theme.value;
  try {
    if (themeChoice.value === 'auto') localStorage.removeItem(KEY);
    else localStorage.setItem(KEY, themeChoice.value);
  } catch {
    // Storage may be off; the choice then lasts as long as the page.
  }
});
