/** Colour-coded maps: an image under the axes and a colour bar beside them. */
import { type ColorMapName, colorTable } from './colormap.ts';
import { fixed } from './format.ts';
import type { Layer } from './layers.ts';
import { AXIS_HEIGHT } from './plot.ts';
import type { ThemeName } from './theme.ts';

export interface HeatMap {
  /** Centres of the columns and rows, ascending and evenly spaced. */
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  /** Value of column i and row j at `i * y.length + j`; nothing is painted where it is not a number. */
  values: ArrayLike<number>;
  /** Values of the first and last colour. */
  limits: readonly [number, number];
  colors: ColorMapName;
}

/** Interval the cells cover: half a cell beyond the outer centres. */
export function cellExtent(centres: ArrayLike<number>): [number, number] {
  const first = centres[0] ?? 0;
  const last = centres[centres.length - 1] ?? 1;
  const half = centres.length > 1 ? (last - first) / (centres.length - 1) / 2 : 0.5;
  return [first - half, last + half];
}

/** The cell whose centre is nearest to a value. */
export function nearestCell(value: number, centres: ArrayLike<number>): number {
  const first = centres[0] ?? 0;
  const step = (centres[1] ?? first + 1) - first;
  return Math.min(Math.max(Math.round((value - first) / step), 0), centres.length - 1);
}

/** Pixels of an image's side that any browser's canvas has room for. */
const MOST_PIXELS = 8192;

/** The image, painted once; the layer only scales it. Where cells share a pixel the highest is seen. */
export function heatImage(map: HeatMap): Layer {
  const columns = map.x.length;
  const rows = map.y.length;
  if (!columns || !rows) return () => {};
  const image = document.createElement('canvas');
  const width = Math.min(columns, MOST_PIXELS);
  const height = Math.min(rows, MOST_PIXELS);
  image.width = width;
  image.height = height;
  const target = image.getContext('2d');
  if (!target) return () => {};
  const pixels = target.createImageData(width, height);
  const table = new Uint32Array(colorTable(map.colors).slice().buffer);
  const out = new Uint32Array(pixels.data.buffer);
  const [low, high] = map.limits;
  const scale = 255 / (high - low || 1);
  for (let px = 0; px < width; px++) {
    const fromX = Math.floor((px * columns) / width);
    const toX = Math.floor(((px + 1) * columns) / width);
    for (let py = 0; py < height; py++) {
      const fromY = Math.floor((py * rows) / height);
      const toY = Math.floor(((py + 1) * rows) / height);
      let highest = Number.NaN;
      for (let i = fromX; i < toX; i++) {
        for (let j = fromY; j < toY; j++) {
          const value = map.values[i * rows + j] as number;
          if (!(value <= highest)) highest = Number.isNaN(value) ? highest : value;
        }
      }
      if (Number.isNaN(highest)) continue;
      const level = Math.min(Math.max(Math.round((highest - low) * scale), 0), 255);
      out[(height - 1 - py) * width + px] = table[level] as number;
    }
  }
  target.putImageData(pixels, 0, 0);
  const [left, right] = cellExtent(map.x);
  const [bottom, top] = cellExtent(map.y);
  let turned: HTMLCanvasElement | undefined;
  return ({ ctx, x, y }) => {
    ctx.imageSmoothingEnabled = false;
    const [from, to] = [x(left), x(right)];
    // A canvas draws an image of negative width where it is asked to, but does not mirror it.
    if (to < from) turned ??= mirrored(image);
    ctx.drawImage(
      to < from && turned ? turned : image,
      Math.min(from, to),
      y(top),
      Math.abs(to - from),
      y(bottom) - y(top),
    );
  };
}

/** An image with left and right exchanged, for axes whose largest value stands at the left. */
function mirrored(image: HTMLCanvasElement): HTMLCanvasElement {
  const other = document.createElement('canvas');
  [other.width, other.height] = [image.width, image.height];
  const ctx = other.getContext('2d');
  ctx?.scale(-1, 1);
  ctx?.drawImage(image, -image.width, 0);
  return other;
}

/** Limits of colours that span so much, below a level that is rounded up. */
export function limitsBelow(topDb: number, spanDb: number): [number, number] {
  const ceiling = Number.isFinite(topDb) ? Math.ceil(topDb / 5) * 5 : 0;
  return [ceiling - spanDb, ceiling];
}

type BarColors = ColorMapName | ((share: number, theme: ThemeName) => string);

function barColor(colors: BarColors): (share: number, theme: ThemeName) => string {
  if (typeof colors === 'function') return colors;
  return (share) => {
    const [r, g, b] = colorTable(colors).subarray(Math.round(255 * share) * 4);
    return `rgb(${r}, ${g}, ${b})`;
  };
}

/** Values beside a bar with room for that many labels. */
function barTicks([low, high]: readonly [number, number], room: number): { value: number; text: string }[] {
  const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find((s) => (high - low) / s <= room) ?? 50;
  const found = [];
  for (let value = Math.ceil(low / step) * step; value <= high; value += step)
    found.push({ value, text: fixed(value, step < 1 ? 1 : 0) });
  return found;
}

/** Colour bar in the space right of the plot; colours by name, or for a share from 0 to 1. */
export function colorBar(limits: readonly [number, number], colors: BarColors, label: string): Layer {
  const color = barColor(colors);
  return ({ ctx, plot, theme, themeName, ratio }) => {
    const { left, top, width, height } = plot.bbox;
    const x = left + width + 12 * ratio;
    const bar = 12 * ratio;
    for (let row = 0; row < height; row++) {
      ctx.fillStyle = color(1 - row / Math.max(height - 1, 1), themeName);
      ctx.fillRect(x, top + row, bar, 1.5);
    }
    ctx.strokeStyle = theme.muted;
    ctx.lineWidth = ratio;
    ctx.strokeRect(x + 0.5, top + 0.5, bar, height - 1);
    ctx.fillStyle = theme.muted;
    ctx.font = `${11 * ratio}px ${theme.font}`;
    ctx.textAlign = 'left';
    ctx.textBaseline = 'middle';
    const [low, high] = limits;
    for (const { value, text } of barTicks(limits, height / (26 * ratio))) {
      const at = top + height * (1 - (value - low) / (high - low));
      ctx.beginPath();
      ctx.moveTo(x + bar, at);
      ctx.lineTo(x + bar + 3 * ratio, at);
      ctx.stroke();
      ctx.fillText(text, x + bar + 5 * ratio, Math.min(Math.max(at, top + 6 * ratio), top + height - 6 * ratio));
    }
    ctx.textAlign = 'center';
    ctx.save();
    ctx.translate(x + bar + 40 * ratio, top + height / 2);
    ctx.rotate(-Math.PI / 2);
    ctx.font = `${12 * ratio}px ${theme.font}`;
    ctx.fillText(label, 0, 0);
    ctx.restore();
  };
}

/** Width a colour bar needs, CSS pixels. */
export const COLOR_BAR_WIDTH = 74;

/** Colour bar in the space under the plot's axis, where width is short; its unit stands left of it. */
export function colorBarBelow(limits: readonly [number, number], colors: BarColors, unit: string): Layer {
  const color = barColor(colors);
  return ({ ctx, plot, theme, themeName, ratio }) => {
    const { left, top, width, height } = plot.bbox;
    const y = top + height + AXIS_HEIGHT * ratio;
    const bar = 10 * ratio;
    for (let column = 0; column < width; column++) {
      ctx.fillStyle = color(column / Math.max(width - 1, 1), themeName);
      ctx.fillRect(left + column, y, 1.5, bar);
    }
    ctx.strokeStyle = theme.muted;
    ctx.lineWidth = ratio;
    ctx.strokeRect(left + 0.5, y + 0.5, width - 1, bar);
    ctx.fillStyle = theme.muted;
    ctx.font = `${11 * ratio}px ${theme.font}`;
    ctx.textBaseline = 'middle';
    ctx.textAlign = 'right';
    ctx.fillText(unit, left - 8 * ratio, y + bar / 2);
    ctx.textBaseline = 'top';
    ctx.textAlign = 'center';
    const [low, high] = limits;
    for (const { value, text } of barTicks(limits, width / (44 * ratio))) {
      const at = left + (width * (value - low)) / (high - low);
      const half = ctx.measureText(text).width / 2;
      ctx.beginPath();
      ctx.moveTo(at, y + bar);
      ctx.lineTo(at, y + bar + 3 * ratio);
      ctx.stroke();
      ctx.fillText(text, Math.min(Math.max(at, left + half), left + width - half), y + bar + 4 * ratio);
    }
  };
}

/** Height it needs, CSS pixels. */
export const COLOR_BAR_HEIGHT = 30;
