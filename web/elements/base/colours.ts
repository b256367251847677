/** Colours of an element: those of its theme, with what custom properties put in their place. */
import { type PlotTheme, THEMES, type ThemeName } from '../../plots/theme.ts';

const PROPERTIES = {
  background: '--boresight-background',
  text: '--boresight-text',
  muted: '--boresight-muted',
  grid: '--boresight-grid',
  accent: '--boresight-accent',
  truth: '--boresight-truth',
  font: '--boresight-font',
} as const;

/** The theme an element asks for, that of the system where it asks for none. */
export function themeOf(element: HTMLElement): ThemeName {
  const asked = element.getAttribute('theme');
  if (asked === 'light' || asked === 'dark') return asked;
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

/** The colours, which are also given to the element's styles. */
export function paletteOf(element: HTMLElement, figure: HTMLElement): PlotTheme {
  const given = getComputedStyle(element);
  const palette: PlotTheme = { ...THEMES[themeOf(element)] };
  for (const [key, property] of Object.entries(PROPERTIES) as [keyof typeof PROPERTIES, string][]) {
    const value = given.getPropertyValue(property).trim();
    if (value) palette[key] = value;
  }
  for (const key of ['background', 'text', 'muted', 'accent'] as const)
    figure.style.setProperty(`--${key}`, palette[key]);
  return palette;
}
