/** What a plot is given, and what it tells. */
import type { Layer } from './layers.ts';
import type { SeriesStyle, ThemeName } from './theme.ts';

/** From and to. */
export type Interval = readonly [number, number];
/** A part of a plot. */
export interface View {
  x: Interval;
  y: Interval;
}

/** An axis. */
export interface AxisOptions {
  /** Quantity and unit: `Range (m)`. */
  label: string;
  /** Preferred tick steps. */
  steps?: number[];
  /** Space for the labels of a vertical axis, CSS pixels. */
  width?: number;
  /** The largest value stands at the left. */
  descending?: boolean;
  /** Lowest value with a label: what is below is no number of the axis. */
  from?: number;
  /** Values are logarithms to base 10 of the quantity, which the labels show. */
  log?: boolean;
}

/** A curve. */
export interface PlotSeries {
  id: string;
  label: string;
  y: ArrayLike<number | null>;
  style: SeriesStyle;
}

/** What a plot shows. */
export interface PlotContent {
  /** Abscissae, ascending, shared by all series. */
  x: ArrayLike<number>;
  series: readonly PlotSeries[];
  /** Drawn under the axes. */
  below?: readonly Layer[];
  /** Drawn over the series. */
  above?: readonly Layer[];
  /** What is shown when nothing is zoomed. */
  extent: View;
}

/** Where the cursor points, in the units of the axes. */
export interface CursorPosition {
  x: number;
  y: number;
  /** Nearest abscissa's index. */
  index: number | null;
}

/** Axes of a plot, and how it is zoomed and moved. */
export interface Axes {
  x: AxisOptions;
  y: AxisOptions;
  /** Space for a colour bar, CSS pixels. */
  right?: number;
  /** The same under the axis. */
  bottom?: number;
  /** Smallest share of the extent a zoom may show. */
  minZoom?: number;
  grid?: boolean;
  /** A unit takes as much room on one axis as on the other: for places. */
  equal?: boolean;
  /**
   * A drag, two fingers or the arrows move the view, the wheel zooms; else a drag zooms to a region, as it does with
   * Shift here.
   */
  navigate?: boolean;
}

export interface PlotOptions extends Axes {
  /** What a screen reader says the plot is. */
  label: string;
  /** Plots with the same key share their cursor's abscissa, those with equal scales the whole of it. */
  cursorKey?: string;
  theme: ThemeName;
  onCursor?(position: CursorPosition | null): void;
  onClick?(position: CursorPosition): void;
  /** Return true where the zoom is not to be reset. */
  onDoubleClick?(position: CursorPosition): boolean;
  /** Called for zooms made here, not through `setView`. */
  onView?(view: View, zoomed: boolean): void;
  /** Return true where the key was used. */
  onKey?(event: KeyboardEvent): boolean;
}

/** What a sign on a plot means. */
export interface LegendEntry {
  label: string;
  style: SeriesStyle;
  line: boolean;
  hollow?: boolean;
}

/** A point that people move. */
export interface HandlePoint {
  x: number;
  y: number;
  label: string;
}

/** How far one key moves a point along an axis, and with Shift held. */
export interface HandleSteps {
  x: readonly [fine: number, coarse: number];
  y: readonly [fine: number, coarse: number];
}
