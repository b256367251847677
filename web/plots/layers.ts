/** Things drawn on a plot besides its series: functions of canvas, plot and theme. */
import { parseColor } from './colormap.ts';
import type { MarkerShape, PlotTheme, SeriesStyle, ThemeName } from './theme.ts';

/** The plot that is drawn: the box between its axes, device pixels. */
export interface Drawn {
  readonly bbox: { readonly left: number; readonly top: number; readonly width: number; readonly height: number };
}

/** What a layer draws on; `x` and `y` place values on the canvas, in device pixels. */
export interface LayerContext {
  ctx: CanvasRenderingContext2D;
  plot: Drawn;
  theme: PlotTheme;
  themeName: ThemeName;
  /** Device pixels a CSS pixel. */
  ratio: number;
  x(value: number): number;
  y(value: number): number;
}

/** Something drawn besides curves. */
export type Layer = (c: LayerContext) => void;

/** A layer that lets through what is under it; opacity from 0 to 1. */
export function faded(layer: Layer, opacity: number): Layer {
  return (context) => {
    context.ctx.globalAlpha = opacity;
    layer(context);
  };
}

/** Vertical lines at given abscissae, full height, with an optional label at the top. */
export function verticalLines(
  lines: readonly { x: number; label?: string }[],
  style: { color?: (t: PlotTheme) => string; dash?: number[]; width?: number } = {},
): Layer {
  return ({ ctx, plot, theme, ratio, x }) => {
    const { top, height } = plot.bbox;
    ctx.strokeStyle = style.color?.(theme) ?? theme.truth;
    ctx.fillStyle = ctx.strokeStyle;
    ctx.lineWidth = (style.width ?? 1) * ratio;
    ctx.setLineDash((style.dash ?? []).map((d) => d * ratio));
    ctx.font = `${11 * ratio}px ${theme.font}`;
    ctx.textAlign = 'left';
    ctx.textBaseline = 'top';
    for (const line of lines) {
      const at = Math.round(x(line.x)) + 0.5;
      ctx.beginPath();
      ctx.moveTo(at, top);
      ctx.lineTo(at, top + height);
      ctx.stroke();
      if (line.label) ctx.fillText(line.label, at + 4 * ratio, top + 3 * ratio);
    }
    ctx.setLineDash([]);
  };
}

/** Horizontal line across the plot with a label at its right end, or at its left one. */
export function horizontalLine(
  value: number,
  label: string,
  style: { color?: (t: PlotTheme) => string; dash?: number[]; left?: boolean } = {},
): Layer {
  return ({ ctx, plot, theme, ratio, y }) => {
    const { left, top, width, height } = plot.bbox;
    const at = Math.round(y(value)) + 0.5;
    if (at < top || at > top + height) return;
    ctx.strokeStyle = style.color?.(theme) ?? theme.muted;
    ctx.fillStyle = ctx.strokeStyle;
    ctx.lineWidth = ratio;
    ctx.setLineDash((style.dash ?? [2, 3]).map((d) => d * ratio));
    ctx.beginPath();
    ctx.moveTo(left, at);
    ctx.lineTo(left + width, at);
    ctx.stroke();
    ctx.setLineDash([]);
    ctx.font = `${11 * ratio}px ${theme.font}`;
    ctx.textAlign = style.left ? 'left' : 'right';
    ctx.textBaseline = 'bottom';
    const place = style.left ? left + 5 * ratio : left + width - 5 * ratio;
    ctx.strokeStyle = theme.background;
    ctx.lineWidth = 3 * ratio;
    ctx.strokeText(label, place, at - 3 * ratio);
    ctx.fillText(label, place, at - 3 * ratio);
  };
}

/** Shaded intervals of the abscissa: error bands, or sectors that are out of bounds. */
export function bands(intervals: readonly (readonly [number, number])[], fill: (t: PlotTheme) => string): Layer {
  return ({ ctx, plot, theme, x }) => {
    const { top, height } = plot.bbox;
    ctx.fillStyle = fill(theme);
    for (const [from, to] of intervals) {
      const a = x(from);
      const b = x(to);
      ctx.fillRect(Math.min(a, b), top, Math.max(Math.abs(b - a), 1), height);
    }
  };
}

/** More points of a line than a plot shows cost time when it is drawn, dashed ones most. */
const MOST_POINTS = 4000;

/** A line through points; parts with a missing number are left out. */
export function polyline(
  px: ArrayLike<number>,
  py: ArrayLike<number | null>,
  style: SeriesStyle,
  most = MOST_POINTS,
): Layer {
  return ({ ctx, plot, themeName, ratio, x, y }) => {
    clipToPlot(ctx, plot);
    ctx.strokeStyle = style.color[themeName];
    ctx.lineWidth = (style.width ?? 1.6) * ratio;
    ctx.lineJoin = 'round';
    ctx.setLineDash((style.dash ?? []).map((d) => d * ratio));
    ctx.beginPath();
    let drawing = false;
    const every = Math.max(Math.floor(px.length / most), 1);
    for (let i = 0; i < px.length; i += every) {
      const [a, b] = [x(px[i] as number), y(py[i] ?? Number.NaN)];
      if (!Number.isFinite(a) || !Number.isFinite(b)) drawing = false;
      else if (drawing) ctx.lineTo(a, b);
      else {
        ctx.moveTo(a, b);
        drawing = true;
      }
    }
    ctx.stroke();
  };
}

/** The area between a lower and an upper curve; where either is missing there is none. */
export function areaBetween(
  px: ArrayLike<number>,
  low: ArrayLike<number>,
  high: ArrayLike<number>,
  style: SeriesStyle,
): Layer {
  return ({ ctx, plot, themeName, x, y }) => {
    clipToPlot(ctx, plot);
    ctx.fillStyle = style.color[themeName];
    ctx.globalAlpha = 0.17;
    for (let i = 0; i < px.length; i++) {
      const start = i;
      while (i < px.length && Number.isFinite(low[i]) && Number.isFinite(high[i])) i += 1;
      if (i - start < 2) continue;
      ctx.beginPath();
      for (let j = start; j < i; j++) ctx.lineTo(x(px[j] as number), y(high[j] as number));
      for (let j = i - 1; j >= start; j--) ctx.lineTo(x(px[j] as number), y(low[j] as number));
      ctx.fill();
    }
  };
}

/** Small dots, for tens of thousands of points: painted pixel by pixel, darker where they lie on each other. */
export function dots(px: ArrayLike<number>, py: ArrayLike<number>, style: SeriesStyle, alpha = 0.4): Layer {
  return ({ ctx, plot, themeName, ratio, x, y }) => {
    const [left, top, width, height] = [plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height].map(
      Math.round,
    ) as [number, number, number, number];
    if (width < 1 || height < 1) return;
    const image = document.createElement('canvas');
    [image.width, image.height] = [width, height];
    const target = image.getContext('2d');
    if (!target) return;
    const pixels = target.createImageData(width, height);
    const { data } = pixels;
    const [red, green, blue] = parseColor(style.color[themeName]);
    const size = Math.max(Math.round(1.5 * ratio), 1);
    for (let i = 0; i < px.length; i++) {
      const [column, row] = [
        Math.round(x(px[i] as number) - left - size / 2),
        Math.round(y(py[i] as number) - top - size / 2),
      ];
      if (!(column >= 0 && row >= 0 && column + size <= width && row + size <= height)) continue;
      for (let k = 0; k < size * size; k++) {
        const at = 4 * ((row + Math.floor(k / size)) * width + column + (k % size));
        [data[at], data[at + 1], data[at + 2]] = [red, green, blue];
        data[at + 3] = 255 - (255 - (data[at + 3] as number)) * (1 - alpha);
      }
    }
    target.putImageData(pixels, 0, 0);
    ctx.drawImage(image, left, top);
  };
}

export function clipToPlot(ctx: CanvasRenderingContext2D, { bbox: { left, top, width, height } }: Drawn): void {
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
}

/** A line in two colours and widths, one over the other, that shows on every colour of a map. */
export function strokeTwice(
  ctx: CanvasRenderingContext2D,
  trace: (path: CanvasPath) => void,
  ...looks: readonly [under: { color: string; width: number }, over: { color: string; width: number }]
): void {
  for (const { color, width } of looks) {
    ctx.strokeStyle = color;
    ctx.lineWidth = width;
    ctx.beginPath();
    trace(ctx);
    ctx.stroke();
  }
}

export interface Marker {
  x: number;
  y: number;
  style: SeriesStyle;
  size?: number;
  hollow?: boolean;
  /** Half lengths of its bars, in the plot's units. */
  deviation?: { x: number; y: number };
}

/** Bars through a point, one deviation to each side, with ends across; ends closer than the marker is large are left out. */
function drawBars(
  { ctx, plot, themeName, ratio, x, y }: LayerContext,
  { x: px, y: py, style, deviation, size = 4.5 }: Marker,
): void {
  if (!deviation) return;
  ctx.save();
  clipToPlot(ctx, plot);
  ctx.strokeStyle = style.color[themeName];
  ctx.lineWidth = 1.5 * ratio;
  const cap = 3.5 * ratio;
  const [left, right] = [x(px - deviation.x), x(px + deviation.x)];
  const [low, high] = [y(py - deviation.y), y(py + deviation.y)];
  ctx.beginPath();
  ctx.moveTo(left, y(py));
  ctx.lineTo(right, y(py));
  ctx.moveTo(x(px), low);
  ctx.lineTo(x(px), high);
  if (right - left > 2 * size * ratio) {
    for (const end of [left, right]) {
      ctx.moveTo(end, y(py) - cap);
      ctx.lineTo(end, y(py) + cap);
    }
  }
  if (low - high > 2 * size * ratio) {
    for (const end of [low, high]) {
      ctx.moveTo(x(px) - cap, end);
      ctx.lineTo(x(px) + cap, end);
    }
  }
  ctx.stroke();
  ctx.restore();
}

/** Markers at points, with bars where a point has deviations; what is beyond top or bottom stands at the edge unless `edge` is off. */
export function markers(points: readonly Marker[], { edge = true } = {}): Layer {
  return (context) => {
    const { ctx, plot, theme, themeName, ratio, x, y } = context;
    const { left, top, width, height } = plot.bbox;
    for (const point of points) {
      drawBars(context, point);
      const size = (point.size ?? 4.5) * ratio;
      const px = x(point.x);
      if (px < left - 1 || px > left + width + 1) continue;
      const level = y(point.y);
      if (!edge && (level < top || level > top + height)) continue;
      const py = Math.min(Math.max(level, top + size), top + height - size);
      drawMarker(ctx, point.style.marker ?? 'circle', px, py, size, {
        stroke: point.style.color[themeName],
        fill: point.hollow ? null : point.style.color[themeName],
        halo: theme.background,
        ratio,
      });
    }
  };
}

export function drawMarker(
  ctx: CanvasRenderingContext2D,
  shape: MarkerShape,
  x: number,
  y: number,
  r: number,
  look: { stroke: string; fill: string | null; halo?: string; ratio: number },
): void {
  const polygon = (corners: [number, number][]): void => {
    corners.forEach(([dx, dy], i) => (i ? ctx.lineTo(x + dx * r, y + dy * r) : ctx.moveTo(x + dx * r, y + dy * r)));
    ctx.closePath();
  };
  const open = shape === 'plus' || shape === 'cross' || shape === 'bar';
  const trace = (): void => {
    ctx.beginPath();
    switch (shape) {
      case 'circle':
        ctx.arc(x, y, r * 0.95, 0, 2 * Math.PI);
        break;
      case 'square':
        ctx.rect(x - r * 0.85, y - r * 0.85, 1.7 * r, 1.7 * r);
        break;
      case 'diamond':
        polygon([
          [0, -1.25],
          [1.1, 0],
          [0, 1.25],
          [-1.1, 0],
        ]);
        break;
      case 'up':
        polygon([
          [0, -1.15],
          [1.1, 0.85],
          [-1.1, 0.85],
        ]);
        break;
      case 'down':
        polygon([
          [0, 1.15],
          [1.1, -0.85],
          [-1.1, -0.85],
        ]);
        break;
      case 'left':
        polygon([
          [-1.15, 0],
          [0.85, 1.1],
          [0.85, -1.1],
        ]);
        break;
      case 'right':
        polygon([
          [1.15, 0],
          [-0.85, 1.1],
          [-0.85, -1.1],
        ]);
        break;
      case 'star':
        polygon(
          Array.from({ length: 10 }, (_, i) => {
            const radius = i % 2 ? 0.55 : 1.35;
            const angle = (i * Math.PI) / 5 - Math.PI / 2;
            return [radius * Math.cos(angle), radius * Math.sin(angle)] as [number, number];
          }),
        );
        break;
      case 'plus':
      case 'cross':
      case 'bar': {
        const strokes: [number, number, number, number][] =
          shape === 'plus'
            ? [
                [-1.2, 0, 1.2, 0],
                [0, -1.2, 0, 1.2],
              ]
            : shape === 'cross'
              ? [
                  [-1, -1, 1, 1],
                  [-1, 1, 1, -1],
                ]
              : [
                  [0, -1.4, 0, 1.4],
                  [-0.7, -1.4, 0.7, -1.4],
                  [-0.7, 1.4, 0.7, 1.4],
                ];
        for (const [ax, ay, bx, by] of strokes) {
          ctx.moveTo(x + ax * r, y + ay * r);
          ctx.lineTo(x + bx * r, y + by * r);
        }
      }
    }
  };
  if (look.halo) {
    ctx.strokeStyle = look.halo;
    ctx.lineWidth = (open ? 4.5 : 3) * look.ratio;
    trace();
    ctx.stroke();
  }
  if (!open && look.fill) {
    ctx.fillStyle = look.fill;
    trace();
    ctx.fill();
  }
  ctx.strokeStyle = look.stroke;
  ctx.lineWidth = (open ? 2 : 1.5) * look.ratio;
  trace();
  ctx.stroke();
}

/** Size of a series' sign in a legend, CSS pixels. */
export const SWATCH = { width: 26, height: 14 } as const;

/** A series' sign in a legend: its line and marker as on the plot, the left end of it at `x`. */
export function drawSwatch(
  ctx: CanvasRenderingContext2D,
  { style, line, hollow = false }: { style: SeriesStyle; line: boolean; hollow?: boolean },
  at: { x: number; y: number; ratio: number },
  theme: PlotTheme,
  themeName: ThemeName,
): void {
  const { x, y, ratio } = at;
  const color = style.color[themeName];
  if (line) {
    ctx.strokeStyle = color;
    ctx.lineWidth = 2 * ratio;
    ctx.setLineDash((style.dash ?? []).map((d) => d * ratio));
    ctx.beginPath();
    ctx.moveTo(x + ratio, y);
    ctx.lineTo(x + (SWATCH.width - 1) * ratio, y);
    ctx.stroke();
    ctx.setLineDash([]);
  }
  if (style.marker) {
    drawMarker(ctx, style.marker, x + (SWATCH.width / 2) * ratio, y, (hollow ? 5 : 3.6) * ratio, {
      stroke: color,
      fill: hollow ? null : color,
      halo: theme.background,
      ratio,
    });
  }
}

/** The same on a canvas of its own, as sharp as the screen is. */
export function paintSwatch(
  canvas: HTMLCanvasElement,
  sign: { style: SeriesStyle; line: boolean; hollow?: boolean },
  theme: PlotTheme,
  themeName: ThemeName,
): void {
  const ratio = devicePixelRatio || 1;
  [canvas.width, canvas.height] = [SWATCH.width * ratio, SWATCH.height * ratio];
  [canvas.style.width, canvas.style.height] = [`${SWATCH.width}px`, `${SWATCH.height}px`];
  const ctx = canvas.getContext('2d');
  if (ctx) drawSwatch(ctx, sign, { x: 0, y: canvas.height / 2, ratio }, theme, themeName);
}
