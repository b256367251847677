/** Colours of everything drawn on a canvas, in both themes, and the look of each method's series. */
import { parseColor } from './colormap.ts';

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
    background: '#ffffff',
    text: '#23292f',
    muted: '#5b6670',
    grid: '#e6e9ec',
    accent: '#0a5ea8',
    truth: '#23292f',
    band: 'rgba(35, 41, 47, 0.13)',
    shade: 'rgba(91, 102, 112, 0.10)',
    font: FONT,
  },
  dark: {
    background: '#191d21',
    text: '#dfe4e8',
    muted: '#98a3ad',
    grid: '#2a3037',
    accent: '#63b1f5',
    truth: '#f0f3f5',
    band: 'rgba(240, 243, 245, 0.16)',
    shade: 'rgba(152, 163, 173, 0.10)',
    font: FONT,
  },
};

export type MarkerShape =
  | 'circle'
  | 'square'
  | 'diamond'
  | 'up'
  | 'down'
  | 'plus'
  | 'cross'
  | 'star'
  | 'left'
  | 'right'
  | 'bar';

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
  'coarray-music': { color: { light: '#b35900', dark: '#ffb366' }, dash: [2, 3], marker: 'diamond' },
  iaa: { color: { light: '#8a3ab9', dark: '#c99af2' }, marker: 'star' },
  nomp: { color: { light: '#3d4650', dark: '#e9edf0' }, marker: 'plus' },
  'atomic-norm': { color: { light: '#5b7f00', dark: '#b6d95c' }, dash: [6, 2], marker: 'right' },
  'maximum-likelihood': { color: { light: '#0e7f92', dark: '#56d3e6' }, marker: 'cross' },
  'weighted-mean': { color: { light: '#d55e00', dark: '#ff8a3d' }, dash: [7, 3], marker: 'square' },
  kabsch: { color: { light: '#a3154e', dark: '#ff7fa8' }, dash: [2, 3], marker: 'up' },
  'least-squares': { color: { light: '#00896a', dark: '#2fcf9f' }, dash: [9, 3, 2, 3], marker: 'diamond' },
  'orthogonal-distance': { color: { light: '#8a3ab9', dark: '#c99af2' }, dash: [4, 3], marker: 'down' },
  recursive: { color: { light: '#0072b2', dark: '#4aa8e8' }, width: 2, marker: 'circle' },
  joint: { color: { light: '#3d4650', dark: '#e9edf0' }, dash: [10, 3], marker: 'star' },
  aaetr: { color: { light: '#d62f1f', dark: '#ff7a66' }, width: 2.4, marker: 'diamond' },
  'learned-pursuit': { color: { light: '#b8327a', dark: '#ff8ac2' }, width: 2.4, marker: 'up' },
  'unrolled-iaa': { color: { light: '#6a1f9c', dark: '#d9b0ff' }, width: 2.4, marker: 'star' },
  'covariance-cnn': { color: { light: '#1b4fd1', dark: '#86a8ff' }, width: 2.4, marker: 'square' },
  'deep-music': { color: { light: '#0e7f92', dark: '#56d3e6' }, width: 2.4, marker: 'up' },
  cnn3d: { color: { light: '#1b4fd1', dark: '#86a8ff' }, width: 2.4, marker: 'square' },
  dnn: { color: { light: '#6d4432', dark: '#d9ab93' }, width: 2, dash: [8, 3], marker: 'down' },
  counting: { color: { light: '#d62f1f', dark: '#ff7a66' }, width: 2.4, marker: 'diamond' },
  'sparse-bayesian': { color: { light: '#8c6d00', dark: '#e8c84a' }, dash: [9, 3, 2, 3], marker: 'bar' },
};

const FALLBACK: SeriesStyle = { color: { light: '#0a5ea8', dark: '#63b1f5' }, marker: 'circle' };

export function methodStyle(method: string): SeriesStyle {
  return METHOD_STYLES[method] ?? FALLBACK;
}

export const ACCENT_STYLE: SeriesStyle = FALLBACK;

/** Static detections have a weight near 1, others near 0: from orange to blue, through grey. */
const WEIGHT_COLORS: Record<
  ThemeName,
  readonly [low: readonly number[], middle: readonly number[], high: readonly number[]]
> = {
  light: [
    [213, 94, 0],
    [138, 138, 138],
    [0, 98, 165],
  ],
  dark: [
    [255, 138, 61],
    [150, 150, 150],
    [94, 180, 240],
  ],
};

export function weightColor(weight: number, theme: ThemeName): string {
  const [low, middle, high] = WEIGHT_COLORS[theme];
  const share = Math.min(Math.max(weight, 0), 1) * 2;
  const [from, to, part] = share < 1 ? [low, middle, share] : [middle, high, share - 1];
  return `rgb(${from.map((value, i) => Math.round(value + ((to[i] as number) - value) * part)).join(', ')})`;
}

export const TRUTH_STYLE: SeriesStyle = { color: { light: '#23292f', dark: '#f0f3f5' }, marker: 'cross' };

/** The same colour, fainter and dashed: what is there to compare with. */
export function faint({ color, marker }: SeriesStyle): SeriesStyle {
  const seen = (text: string): string => `rgba(${parseColor(text).slice(0, 3).join(', ')}, 0.6)`;
  return {
    color: { light: seen(color.light), dark: seen(color.dark) },
    dash: [4, 4],
    ...(marker ? { marker } : {}),
  };
}
