import type { Axes } from '../../plots/types.ts';
import type { Drawing, MovablePoints } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';

/** A drawing with the axes it is drawn on. */
export interface OwnDrawing extends Drawing {
  axes: Axes;
  /** Points that people move, told by `boresight-drag` and `boresight-remove`. */
  movable?: MovablePoints | null;
}

const BLANK: Axes = { x: { label: '' }, y: { label: '' } };

/**
 * A plot of one's own: series, layers and legend with the axes, tools and words that all elements have.
 *
 * @element boresight-plot
 */
export class OwnPlotElement extends PlotElement {
  #drawing: OwnDrawing | null = null;

  /** What to draw, and on which axes. */
  get drawing(): OwnDrawing | null {
    return this.#drawing;
  }

  set drawing(given: OwnDrawing | null) {
    this.#drawing = given || null;
    this.changed();
  }

  /** @internal */
  protected override axes(): Axes {
    return this.#drawing?.axes ?? BLANK;
  }

  /** @internal */
  protected override draw(): Drawing | null {
    return this.#drawing;
  }

  /** @internal */
  protected override movablePoints(): MovablePoints | null {
    return this.#drawing?.movable ?? null;
  }
}
