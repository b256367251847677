/** What elements draw, and what they say of it. */
import type { CursorPosition, HandlePoint, HandleSteps, LegendEntry, PlotContent } from '../../plots/types.ts';

/** An entry of a legend, with what the cursor reads. */
export interface LegendItem extends LegendEntry {
  /** Tells it from the others. */
  id?: string;
  /** Text for the cursor's position, and while there is none. */
  value?(position: CursorPosition): string;
  rest?: string;
}

/** What is drawn, and what is said of it. */
export interface Drawing {
  content: PlotContent;
  legend?: readonly LegendItem[];
  /** What is to be seen, in words, for who does not see it. */
  alternative?: string;
  /** What the cursor points at. */
  readout(position: CursorPosition): string;
  /** What is drawn as numbers, with a header row; without it there is no such file. */
  csv?(): string;
}

/** Points of a plot that people move, by dragging or by keys. */
export interface MovablePoints {
  points: readonly HandlePoint[];
  /** How far keys move them. */
  steps: HandleSteps;
  /** How they are moved, in words. */
  help: string;
}
