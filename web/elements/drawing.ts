import type { LegendEntry } from '../plots/picture.ts';
import type { CursorPosition, PlotContent, PlotOptions } from '../plots/plot.ts';

/** What an element draws. */
export interface Drawing {
  content: PlotContent;
  legend?: readonly LegendEntry[];
  /** What is to be seen, in words. */
  alternative: string;
  /** What the cursor points at. */
  readout(position: CursorPosition): string;
}

/** The plot that an element draws on. */
export type Axes = Pick<PlotOptions, 'x' | 'y'> & Partial<PlotOptions>;
