/**
 * A plot with axes, cursor, zoom and layers, on uPlot. Everything the demo draws is one of these:
 * line plots give it series, maps give it a layer below the axes.
 */
import uPlot from 'uplot';
import { divert } from './divert.ts';
import { significant, ticks } from './format.ts';
import { clipToPlot, type Layer, type LayerContext, polyline } from './layers.ts';
import { navigate } from './navigate.ts';
import { type PlotTheme, THEMES, type ThemeName } from './theme.ts';
import { atOnce, drop, inTurn } from './turns.ts';
import type { AxisOptions, CursorPosition, Interval, PlotContent, PlotOptions, PlotSeries, View } from './types.ts';

export type * from './types.ts';

/** Decades, and 2 and 5 between them where there are few; as logarithms. */
function logSplits(low: number, high: number): number[] {
  const parts = high - low > 3.5 ? [1] : high - low > 0.8 ? [1, 2, 5] : [1, 2, 3, 4, 5, 6, 8];
  const all: number[] = [];
  for (let decade = Math.floor(low); decade <= high; decade++) {
    for (const part of parts) {
      const value = decade + Math.log10(part);
      if (value >= low && value <= high) all.push(value);
    }
  }
  return all;
}

/** Where values of an axis are drawn: as uPlot has it, without looking the axis up for each of thousands. */
function linear(u: uPlot, axis: 'x' | 'y'): (value: number) => number {
  const { min, max } = u.scales[axis] ?? {};
  if (min == null || max == null || !(max > min)) return (value) => u.valToPos(value, axis, true);
  const from = u.valToPos(min, axis, true);
  const unit = (u.valToPos(max, axis, true) - from) / (max - min);
  return (value) => from + (value - min) * unit;
}

const AXIS_WIDTH = 52;
export const AXIS_HEIGHT = 40;

export class Plot {
  readonly host: HTMLElement;
  readonly u: uPlot;
  #options: PlotOptions;
  #content: PlotContent = { x: [], series: [], extent: { x: [0, 1], y: [0, 1] } };
  #view: View | null = null;
  #theme: ThemeName;
  #palette: PlotTheme;
  #ids: string[] = [];
  #observer: ResizeObserver;
  #sight: IntersectionObserver;
  #inSight = false;
  #listeners = new Set<() => void>();
  #stopNavigating: (() => void) | undefined;

  constructor(host: HTMLElement, options: PlotOptions) {
    this.host = host;
    this.#options = options;
    this.#theme = options.theme;
    this.#palette = THEMES[options.theme];
    host.classList.add('plot');
    host.tabIndex = 0;
    host.setAttribute('role', 'application');
    host.setAttribute('aria-label', options.label);
    this.u = new uPlot(this.#uplotOptions(), [[], []], host);
    this.u.over.addEventListener('click', this.#click);
    host.addEventListener('keydown', this.#key);
    if (options.navigate) this.#stopNavigating = navigate(this);
    this.#observer = new ResizeObserver(() => this.#resize());
    this.#observer.observe(host);
    this.#sight = new IntersectionObserver((entries) => {
      this.#inSight = entries.at(-1)?.isIntersecting ?? false;
      if (this.#inSight) atOnce(this.#drawContent);
    });
    this.#sight.observe(host);
    this.#resize();
  }

  get content(): PlotContent {
    return this.#content;
  }

  get view(): View {
    return this.#view ?? this.#content.extent;
  }

  get zoomed(): boolean {
    return this.#view !== null;
  }

  get theme(): ThemeName {
    return this.#theme;
  }

  /** Its colours. */
  get palette(): PlotTheme {
    return this.#palette;
  }

  /** 1 where values grow to the right, -1 where they grow to the left. */
  get direction(): 1 | -1 {
    return this.#options.x.descending ? -1 : 1;
  }

  /** Calls back after each drawing, for things laid over the plot. */
  onDraw(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  setContent(content: PlotContent): void {
    this.#content = content;
    if (this.#inSight) this.#drawContent();
    else inTurn(this.#drawContent);
  }

  #drawContent = (): void => {
    const content = this.#content;
    drop(this.#drawContent);
    const ids = content.series.map((series) => series.id);
    this.u.batch(() => {
      if (ids.join('\n') !== this.#ids.join('\n')) {
        while (this.u.series.length > 1) this.u.delSeries(this.u.series.length - 1);
        content.series.forEach((series, i) => this.u.addSeries(this.#uplotSeries(series), i + 1));
        if (!content.series.length) this.u.addSeries({ scale: 'y', show: false }, 1);
        this.#ids = ids;
      }
      const columns = content.series.length
        ? content.series.map((series) => series.y)
        : [new Array(content.x.length).fill(null)];
      this.u.setData([content.x, ...columns] as unknown as uPlot.AlignedData, false);
      this.#applyView();
    });
  };

  /** Colours of a theme, or of a palette of one's own beside that theme's colours of series. */
  setTheme(theme: ThemeName, palette = THEMES[theme]): void {
    this.#theme = theme;
    this.#palette = palette;
    this.u.redraw(false, true);
  }

  /** Shows part of the extent; `null` all of it. */
  setView(view: View | null, report = false): void {
    if (!view && !this.#view && !report) return;
    this.#view = view ? this.#within(view) : null;
    this.#applyView();
    if (report) this.#options.onView?.(this.view, this.zoomed);
  }

  /** Zooms about a place, the middle if none is given; a factor below 1 shows less. */
  zoomBy(factor: number, about?: { x: number; y: number }): void {
    const { extent } = this.#content;
    const scaled = ([a, b]: Interval, at = (a + b) / 2): Interval => [at + (a - at) * factor, at + (b - at) * factor];
    const view: View = {
      x: scaled(this.view.x, about?.x),
      y: this.#options.equal ? scaled(this.view.y, about?.y) : this.view.y,
    };
    const all = view.x[1] - view.x[0] >= extent.x[1] - extent.x[0];
    this.setView(all ? null : view, true);
  }

  resetZoom(): void {
    this.setView(null, true);
  }

  /** Moves a zoomed view to the right and up by shares of what it shows. */
  panBy(right: number, up = 0): void {
    const { x, y } = this.#drawn(this.u);
    this.moveBy((x[1] - x[0]) * this.direction * right, (y[1] - y[0]) * up);
  }

  /** Moves a zoomed view along by what its axes say. */
  moveBy(x: number, y: number): void {
    if (!this.#view) return;
    const moved = ([a, b]: Interval, step: number): Interval => [a + step, b + step];
    this.setView({ x: moved(this.#view.x, x), y: moved(this.#view.y, y) }, true);
  }

  /** Device pixels a CSS pixel. */
  get ratio(): number {
    return uPlot.pxRatio;
  }

  /** Device pixels it takes when it is drawn so many times as large. */
  sizeAt(scale: number): { width: number; height: number } {
    const { width, height } = this.u;
    return { width: Math.round(width * scale * this.ratio), height: Math.round(height * scale * this.ratio) };
  }

  /** What is shown, drawn afresh and larger on a canvas of its own, or on a context that is given. */
  drawAgain(scale: number, onto?: CanvasRenderingContext2D): HTMLCanvasElement {
    const size = { width: this.u.width * scale, height: this.u.height * scale };
    const lines = this.#content.series.map(({ y, style }) => polyline(this.#content.x, y, style, Infinity));
    const copy = new uPlot(
      {
        ...this.#uplotOptions(scale),
        ...size,
        cursor: { show: false },
        hooks: {
          drawClear: [(u) => this.#drawBelow(u, scale)],
          draw: [(u) => this.#drawLayers([...lines, ...(this.#content.above ?? [])], u, scale)],
        },
      },
      [[], []],
      (u, start) => {
        if (onto) divert(u.ctx, onto);
        start();
      },
    );
    // All at once: what is drawn on takes no second drawing.
    copy.batch((u: uPlot) => {
      const { x, y } = this.#drawn(u);
      u.setScale('x', { min: x[0], max: x[1] });
      u.setScale('y', { min: y[0], max: y[1] });
    });
    const { canvas } = copy.ctx;
    copy.destroy();
    return canvas;
  }

  destroy(): void {
    this.#observer.disconnect();
    this.#sight.disconnect();
    drop(this.#drawContent);
    this.#stopNavigating?.();
    this.#listeners.clear();
    this.host.removeEventListener('keydown', this.#key);
    this.u.destroy();
  }

  #uplotOptions(scale = 1): uPlot.Options {
    const theme = () => this.#palette;
    const family = THEMES.light.font;
    const axis = (options: AxisOptions, side: number, size: number): uPlot.Axis => ({
      scale: side === 2 ? 'x' : 'y',
      side,
      size: size * scale,
      label: options.label,
      labelSize: 18 * scale,
      labelGap: 0,
      gap: 4 * scale,
      font: `${11 * scale}px ${family}`,
      labelFont: `${12 * scale}px ${family}`,
      space: (side === 2 ? 54 : 28) * scale,
      stroke: () => theme().muted,
      grid: { show: this.#options.grid ?? true, stroke: () => theme().grid, width: scale },
      ticks: { show: true, stroke: () => theme().muted, width: scale, size: 4 * scale },
      border: { show: true, stroke: () => theme().muted, width: scale },
      values: (_u, splits, _axis, _space, step) =>
        ticks(splits, step).map((text, i) =>
          (splits[i] as number) < (options.from ?? Number.NEGATIVE_INFINITY) ? '' : text,
        ),
      ...(options.steps ? { incrs: options.steps } : {}),
      ...(options.log
        ? {
            splits: (_u: uPlot, _axis: number, low: number, high: number) => logSplits(low, high),
            values: (_u: uPlot, splits: number[]) => splits.map((value) => significant(10 ** value, 1)),
          }
        : {}),
    });
    const options = this.#options;
    return {
      width: 300,
      height: 200,
      padding: [8 * scale, (options.right ?? 14) * scale, (options.bottom ?? 0) * scale, 0],
      legend: { show: false },
      scales: {
        x: {
          time: false,
          auto: false,
          dir: this.direction,
          range: (u) => [...this.#drawn(u).x] as [number, number],
        },
        y: { auto: false, range: (u) => [...this.#drawn(u).y] as [number, number] },
      },
      axes: [axis(options.x, 2, AXIS_HEIGHT - 18), axis(options.y, 3, (options.y.width ?? AXIS_WIDTH) - 18)],
      series: [{}, { scale: 'y', show: false }],
      cursor: {
        drag: { x: true, y: true, uni: 24, setScale: false },
        points: { size: 6 },
        bind: {
          dblclick: () => (event: MouseEvent) => {
            this.#doubleClick(event);
            return null;
          },
          ...(options.navigate
            ? {
                mousedown: (_u, _over, handler) => (event: MouseEvent) => {
                  if (event.button === 0 && event.shiftKey) handler(event);
                  return null;
                },
              }
            : {}),
        },
        ...(options.cursorKey
          ? {
              sync: {
                key: options.cursorKey,
                setSeries: false,
                scales: ['x', options.equal ? 'y' : null] as [string, string | null],
                filters: { pub: (type: string) => type === 'mousemove' || type === 'mouseleave' },
              },
            }
          : {}),
      },
      hooks: {
        drawClear: [(u) => this.#drawBelow(u)],
        draw: [(u) => this.#drawAbove(u)],
        setCursor: [(u) => this.#reportCursor(u)],
        setSelect: [(u) => this.#select(u)],
      },
    };
  }

  #uplotSeries(series: PlotSeries): uPlot.Series {
    return {
      label: series.label,
      scale: 'y',
      auto: false,
      stroke: () => series.style.color[this.#theme],
      width: series.style.width ?? 1.6,
      ...(series.style.dash ? { dash: series.style.dash } : {}),
      points: { show: false },
      spanGaps: false,
    };
  }

  #applyView(): void {
    const { x, y } = this.#drawn(this.u);
    this.u.batch(() => {
      this.u.setScale('x', { min: x[0], max: x[1] });
      this.u.setScale('y', { min: y[0], max: y[1] });
      this.u.redraw(true, true);
    });
  }

  /** The view, with equal scales widened to the shape of the plot. */
  #drawn({ bbox }: uPlot): View {
    const { x, y } = this.view;
    if (!this.#options.equal || !(bbox.width > 0 && bbox.height > 0)) return { x, y };
    const unit = Math.max((x[1] - x[0]) / bbox.width, (y[1] - y[0]) / bbox.height);
    const widened = ([a, b]: Interval, size: number): Interval => [
      (a + b - unit * size) / 2,
      (a + b + unit * size) / 2,
    ];
    return { x: widened(x, bbox.width), y: widened(y, bbox.height) };
  }

  #within(view: View): View {
    const clamp = ([a, b]: Interval, [low, high]: Interval): Interval => {
      const width = Math.min(Math.max(b - a, (high - low) * (this.#options.minZoom ?? 1e-4)), high - low);
      const start = Math.min(Math.max((a + b - width) / 2, low), high - width);
      return [start, start + width];
    };
    return { x: clamp(view.x, this.#content.extent.x), y: clamp(view.y, this.#content.extent.y) };
  }

  #resize(): void {
    const width = this.host.clientWidth;
    const height = this.host.clientHeight;
    if (width > 0 && height > 0 && (width !== this.u.width || height !== this.u.height)) {
      this.u.setSize({ width, height });
      if (this.#options.equal) this.#applyView();
    }
  }

  #select(u: uPlot): void {
    const { left, top, width, height } = u.select;
    if (width < 4 && height < 4) return;
    const whole = (size: number, full: number): boolean => size < 4 || size >= full - 1;
    const [a, b] = [u.posToVal(left, 'x'), u.posToVal(left + width, 'x')];
    const x: Interval = whole(width, u.over.clientWidth) ? this.view.x : [Math.min(a, b), Math.max(a, b)];
    const y: Interval = whole(height, u.over.clientHeight)
      ? this.view.y
      : [u.posToVal(top + height, 'y'), u.posToVal(top, 'y')];
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.setView({ x, y }, true);
  }

  #position(event: MouseEvent): CursorPosition {
    const box = this.u.over.getBoundingClientRect();
    const x = this.u.posToVal(event.clientX - box.left, 'x');
    return {
      x,
      y: this.u.posToVal(event.clientY - box.top, 'y'),
      index: this.#content.x.length ? this.u.valToIdx(x) : null,
    };
  }

  /** uPlot keeps clicks that end a drag to itself. */
  #click = (event: MouseEvent): void => {
    if (event.detail <= 1) this.#options.onClick?.(this.#position(event));
  };

  #doubleClick(event: MouseEvent): void {
    if (!this.#options.onDoubleClick?.(this.#position(event))) this.resetZoom();
  }

  #key = (event: KeyboardEvent): void => {
    if (event.target !== this.host || event.ctrlKey || event.metaKey || event.altKey) return;
    // A plot that came into focus before its turn to be drawn.
    atOnce(this.#drawContent);
    if (this.#options.onKey?.(event) || this.#ownKey(event)) event.preventDefault();
  };

  #ownKey(event: KeyboardEvent): boolean {
    if (this.#options.navigate && this.#arrow(event)) return true;
    switch (event.key) {
      case '+':
      case '=':
        this.zoomBy(0.5);
        return true;
      case '-':
        this.zoomBy(2);
        return true;
      case '0':
      case 'Escape':
        this.resetZoom();
        return true;
      case 'PageUp':
        this.panBy(0.25);
        return true;
      case 'PageDown':
        this.panBy(-0.25);
        return true;
      case 'ArrowLeft':
      case 'ArrowRight':
        this.#moveCursor((event.key === 'ArrowLeft' ? -1 : 1) * (event.shiftKey ? 10 : 1));
        return true;
      default:
        return false;
    }
  }

  /** Arrows move the view, or with Shift the cursor. */
  #arrow({ key, shiftKey }: KeyboardEvent): boolean {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key];
    if (!step) return false;
    const [x, y] = step as [number, number];
    if (shiftKey) {
      const { clientWidth: width, clientHeight: height } = this.u.over;
      const { left = -1, top = -1 } = this.u.cursor;
      const at = left >= 0 ? { left, top } : { left: width / 2, top: height / 2 };
      const within = (value: number, size: number): number => Math.min(Math.max(value, 0), size - 1);
      this.u.setCursor({ left: within(at.left + 4 * x, width), top: within(at.top - 4 * y, height) });
    } else {
      this.panBy(0.1 * x, 0.1 * y);
    }
    return true;
  }

  #moveCursor(steps: number): void {
    const { x } = this.#content;
    if (!x.length) return;
    const middle = this.u.valToIdx((this.view.x[0] + this.view.x[1]) / 2);
    const from = (this.u.cursor.left ?? -1) >= 0 ? (this.u.cursor.idx ?? middle) : middle;
    const value = x[Math.min(Math.max(from + this.direction * steps, 0), x.length - 1)] as number;
    if (value < this.view.x[0] || value > this.view.x[1]) return;
    const first = this.#content.series[0]?.y[this.u.valToIdx(value)];
    this.u.setCursor({
      left: this.u.valToPos(value, 'x'),
      top:
        typeof first === 'number'
          ? Math.min(Math.max(this.u.valToPos(first, 'y'), 0), this.u.over.clientHeight)
          : this.u.over.clientHeight / 2,
    });
  }

  #reportCursor(u: uPlot): void {
    const { left, top } = u.cursor;
    if (left == null || top == null || left < 0) {
      this.#options.onCursor?.(null);
      return;
    }
    const x = u.posToVal(left, 'x');
    this.#options.onCursor?.({ x, y: u.posToVal(top, 'y'), index: this.#content.x.length ? u.valToIdx(x) : null });
  }

  #context(u: uPlot, scale: number): LayerContext {
    return {
      ctx: u.ctx,
      plot: u,
      theme: this.#palette,
      themeName: this.#theme,
      ratio: this.ratio * scale,
      x: linear(u, 'x'),
      y: linear(u, 'y'),
    };
  }

  #drawLayers(layers: readonly Layer[], u: uPlot, scale: number): void {
    const context = this.#context(u, scale);
    for (const layer of layers) {
      u.ctx.save();
      layer(context);
      u.ctx.restore();
    }
  }

  #drawBelow(u: uPlot, scale = 1): void {
    const { ctx, width, height } = u;
    ctx.save();
    ctx.fillStyle = this.#palette.background;
    ctx.fillRect(0, 0, width * this.ratio, height * this.ratio);
    clipToPlot(ctx, u);
    this.#drawLayers(this.#content.below ?? [], u, scale);
    ctx.restore();
  }

  #drawAbove(u: uPlot): void {
    this.#drawLayers(this.#content.above ?? [], u, 1);
    for (const listener of this.#listeners) listener();
  }
}
