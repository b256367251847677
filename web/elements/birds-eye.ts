import type { BirdsEyeView } from 'boresight';
import { AHEAD, LEFT } from '../plots/axes.ts';
import { carOutline } from '../plots/car.ts';
import { fixed, signed } from '../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage } from '../plots/heat.ts';
import type { Drawing } from './drawing.ts';
import { COLOR_ATTRIBUTES, colorsOf, limitsOf } from './map.ts';
import { PlotElement } from './plot-element.ts';

/**
 * Power on the ground around the car.
 *
 * @element boresight-birds-eye
 * @attr {'viridis' | 'cividis' | 'magma'} colors - of the map
 * @attr {number} high-db - level of the last colour; the highest there is by default
 * @attr {number} low-db - level of the first colour
 * @attr {number} span-db - how far the first colour is below the last (40)
 */
export class BirdsEyeElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, ...COLOR_ATTRIBUTES];
  }

  #view: BirdsEyeView | null = null;

  /** A view as `birdsEyeView` gives it. */
  get view(): BirdsEyeView | null {
    return this.#view;
  }

  set view(given: BirdsEyeView | null) {
    this.#view = given;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: LEFT, y: AHEAD, right: COLOR_BAR_WIDTH, equal: true, navigate: true, grid: false };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const view = this.#view;
    if (!view) return null;
    const { xM, yM, power, shape } = view;
    const [ahead, across] = shape;
    // The plot's first axis is that to the left.
    const values = new Float32Array(power.length).fill(Number.NaN);
    for (let i = 0; i < ahead; i++) {
      for (let j = 0; j < across; j++) {
        const linear = power[i * across + j] as number;
        if (linear > 0) values[j * ahead + i] = 10 * Math.log10(linear);
      }
    }
    const colors = colorsOf(this.getAttribute('colors'));
    const limits = limitsOf(values, (name, absent) => this.numberOf(name, absent), 40);
    const cell = (x: number, y: number): number => {
      const i = Math.round((y - (xM[0] as number)) / view.cellM);
      const j = Math.round((x - (yM[0] as number)) / view.cellM);
      return i < 0 || j < 0 || i >= ahead || j >= across ? Number.NaN : (values[j * ahead + i] as number);
    };
    return {
      content: {
        x: yM,
        series: [],
        below: [heatImage({ x: yM, y: xM, values, limits, colors })],
        above: [carOutline(), colorBar(limits, colors, 'Power (dB)')],
        extent: { x: cellExtent(yM), y: cellExtent(xM) },
      },
      alternative: `${fixed(cellExtent(xM)[1] - cellExtent(xM)[0], 0)} m ahead by ${fixed(cellExtent(yM)[1] - cellExtent(yM)[0], 0)} m across in cells of ${view.cellM} m; levels from ${fixed(limits[0], 0)} to ${fixed(limits[1], 0)} dB.`,
      readout: ({ x, y }) => `x ${signed(y, 2)} m   y ${signed(x, 2)} m   Power ${fixed(cell(x, y), 1)} dB`,
    };
  }
}
