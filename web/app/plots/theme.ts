/** Colours of everything drawn on a canvas, in both themes, and the look of each method's series. */

export type ThemeName = 'light' | 'dark';

export interface PlotTheme {
  background: string;
  text: string;
  muted: string;
  grid: string;
  accent: string;
  truth: string;
  band: string;
  shade: string;
  font: string;
}

const FONT = '-apple-system, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, system-ui, sans-serif';

export const THEMES: Record<ThemeName, PlotTheme> = {
  light: {
    background: '#ffffff', text: '#23292f', muted: '#5b6670', grid: '#e6e9ec', accent: '#0a5ea8',
    truth: '#23292f', band: 'rgba(35, 41, 47, 0.13)', shade: 'rgba(91, 102, 112, 0.10)', font: FONT,
  },
  dark: {
    background: '#191d21', text: '#dfe4e8', muted: '#98a3ad', grid: '#2a3037', accent: '#63b1f5',
    truth: '#f0f3f5', band: 'rgba(240, 243, 245, 0.16)', shade: 'rgba(152, 163, 173, 0.10)', font: FONT,
  },
};

export type MarkerShape =
  | 'circle' | 'square' | 'diamond' | 'up' | 'down' | 'plus' | 'cross' | 'star' | 'left' | 'right' | 'bar';

export interface SeriesStyle {
  /** One colour a theme; hue, dash and marker together tell series apart, never hue alone. */
  color: Record<ThemeName, string>;
  dash?: number[];
  width?: number;
  marker?: MarkerShape;
}

/** Hues after Okabe and Ito (2008), darkened or lightened to keep their contrast in each theme. */
const METHOD_STYLES: Record<string, SeriesStyle> = {
  bartlett: { color: { light: '#6a7580', dark: '#a4afb9' }, marker: 'circle' },
  capon: { color: { light: '#0072b2', dark: '#4aa8e8' }, marker: 'square' },
  music: { color: { light: '#d55e00', dark: '#ff8a3d' }, marker: 'diamond' },
  'single-snapshot-music': { color: { light: '#a0430a', dark: '#e0a37c' }, dash: [7, 3], marker: 'left' },
  'root-music': { color: { light: '#a3154e', dark: '#ff7fa8' }, marker: 'up' },
  esprit: { color: { light: '#1b6e3c', dark: '#8fd694' }, marker: 'down' },
  'min-norm': { color: { light: '#00896a', dark: '#2fcf9f' }, dash: [4, 3], marker: 'right' },
  iaa: { color: { light: '#8a3ab9', dark: '#c99af2' }, marker: 'star' },
  nomp: { color: { light: '#3d4650', dark: '#e9edf0' }, marker: 'plus' },
  'maximum-likelihood': { color: { light: '#0e7f92', dark: '#56d3e6' }, marker: 'cross' },
  'sparse-bayesian': { color: { light: '#8c6d00', dark: '#e8c84a' }, dash: [9, 3, 2, 3], marker: 'bar' },
};

const FALLBACK: SeriesStyle = { color: { light: '#0a5ea8', dark: '#63b1f5' }, marker: 'circle' };

export function methodStyle(method: string): SeriesStyle {
  return METHOD_STYLES[method] ?? FALLBACK;
}

export const ACCENT_STYLE: SeriesStyle = FALLBACK;

export const TRUTH_STYLE: SeriesStyle = { color: { light: '#23292f', dark: '#f0f3f5' }, marker: 'cross' };
