import type { Detection, FrameResult } from 'boresight';
import { fixed, signed } from '../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage, nearestCell } from '../plots/heat.ts';
import { markers } from '../plots/layers.ts';
import { TRUTH_STYLE } from '../plots/theme.ts';
import type { Drawing } from './drawing.ts';
import { COLOR_ATTRIBUTES, colorsOf, limitsOf } from './map.ts';
import { PlotElement } from './plot-element.ts';

/** What a range-Doppler map is drawn from: a frame as a capture gives it, or one's own. */
export type RangeDopplerFrame = Pick<FrameResult, 'rangeM' | 'rateMps' | 'rangeDopplerDb'> & {
  detections?: readonly Pick<Detection, 'rangeM' | 'rateMps'>[];
};

const DETECTION = { ...TRUTH_STYLE, marker: 'square' as const };

/**
 * Power over range and range rate, with what was detected.
 *
 * @element boresight-range-doppler
 * @attr {'viridis' | 'cividis' | 'magma'} colors - of the map
 * @attr {number} high-db - level of the last colour; the highest there is by default
 * @attr {number} low-db - level of the first colour
 * @attr {number} span-db - how far the first colour is below the last (60)
 */
export class RangeDopplerElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, ...COLOR_ATTRIBUTES];
  }

  #frame: RangeDopplerFrame | null = null;

  /** The frame shown; another one, or the same after its numbers changed, is drawn when it is set. */
  get frame(): RangeDopplerFrame | null {
    return this.#frame;
  }

  set frame(given: RangeDopplerFrame | null) {
    this.#frame = given;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: { label: 'Range (m)' }, y: { label: 'Range rate (m/s)' }, right: COLOR_BAR_WIDTH, grid: false };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const frame = this.#frame;
    if (!frame) return null;
    const { rangeM, rateMps, rangeDopplerDb, detections = [] } = frame;
    const colors = colorsOf(this.getAttribute('colors'));
    const limits = limitsOf(rangeDopplerDb, (name, absent) => this.numberOf(name, absent), 60);
    return {
      content: {
        x: rangeM,
        series: [],
        below: [heatImage({ x: rangeM, y: rateMps, values: rangeDopplerDb, limits, colors })],
        above: [
          markers(detections.map(({ rangeM: x, rateMps: y }) => ({ x, y, style: DETECTION, hollow: true }))),
          colorBar(limits, colors, 'Power (dBFS)'),
        ],
        extent: { x: cellExtent(rangeM), y: cellExtent(rateMps) },
      },
      legend: detections.length ? [{ label: 'Detection', style: DETECTION, line: false, hollow: true }] : [],
      alternative: [
        `${rangeM.length} ranges to ${fixed(rangeM[rangeM.length - 1] ?? 0, 1)} m, ${rateMps.length} range rates; levels from ${fixed(limits[0], 0)} to ${fixed(limits[1], 0)} dBFS.`,
        ...detections
          .slice(0, 10)
          .map(({ rangeM: range, rateMps: rate }) => `Detection at ${fixed(range, 2)} m, ${signed(rate, 2)} m/s.`),
      ].join('\n'),
      readout: ({ x, y }) => {
        const cell = nearestCell(x, rangeM) * rateMps.length + nearestCell(y, rateMps);
        return `Range ${fixed(x, 2)} m   Range rate ${signed(y, 2)} m/s   Power ${fixed(rangeDopplerDb[cell] ?? Number.NaN, 1)} dBFS`;
      },
    };
  }
}
