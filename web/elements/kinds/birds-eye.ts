import type { BirdsEyeView } from 'boresight';
import { AHEAD, LEFT } from '../../plots/axes.ts';
import { carOutline } from '../../plots/car.ts';
import { fixed, signed } from '../../plots/format.ts';
import { COLOR_BAR_HEIGHT, COLOR_BAR_WIDTH, cellExtent, colorBar, colorBarBelow, heatImage } from '../../plots/heat.ts';
import { faded, type Layer } from '../../plots/layers.ts';
import { toCsv } from '../../plots/save.ts';
import type { Interval } from '../../plots/types.ts';
import type { Drawing, LegendItem } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';
import { COLOR_ATTRIBUTES, colorsOf, limitsOf } from './map.ts';

/** The part of the ground that a plot shows, m. */
export interface Ground {
  xM: Interval;
  yM: Interval;
}

/** What a radar of a view is called in its numbers, and in words. */
export interface RadarName {
  name: string;
  title?: string;
}

/**
 * Power on the ground around the car.
 *
 * @element boresight-birds-eye
 * @attr {'right' | 'below'} bar - where the bar of colours stands (right)
 * @attr {'viridis' | 'cividis' | 'magma'} colors - of the map
 * @attr {number} high-db - level of the last colour; the highest there is by default
 * @attr {number} low-db - level of the first colour
 * @attr {number} opacity - of the map, from 0 to 1 (1)
 * @attr {number} span-db - how far the first colour is below the last (40)
 * @attr {string} unit - of levels (dB)
 * @attr {boolean} without-car - no outline of the car
 */
export class BirdsEyeElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, ...COLOR_ATTRIBUTES, 'bar', 'opacity', 'unit', 'without-car'];
  }

  #view: BirdsEyeView | null = null;
  #extent: Ground | null = null;
  #radars: readonly RadarName[] = [];
  #overlays: readonly Layer[] = [];
  #signs: readonly LegendItem[] = [];
  #about: ((xM: number, yM: number) => string) | null = null;
  /** What takes time: levels of the view, and their image in the colours of `key`. */
  #levels: Float32Array | null = null;
  #heat: { key: string; layer: Layer } | null = null;

  /** A view as `birdsEyeView` gives it. */
  get view(): BirdsEyeView | null {
    return this.#view;
  }

  set view(given: BirdsEyeView | null) {
    this.#view = given || null;
    this.#levels = this.#heat = null;
    this.changed();
  }

  /** The ground that is shown, also while there is no view; that of the view by default. */
  get extent(): Ground | null {
    return this.#extent;
  }

  set extent(given: Ground | null) {
    this.#extent = given || null;
    this.changed();
  }

  /** The radars of the view by their index. */
  get radars(): readonly RadarName[] {
    return this.#radars;
  }

  set radars(given: readonly RadarName[] | null) {
    this.#radars = given || [];
    this.changed();
  }

  /** Drawn over the map: functions of a canvas, whose `x` places what is to the left and `y` what is ahead, m. */
  get overlays(): readonly Layer[] {
    return this.#overlays;
  }

  set overlays(given: readonly Layer[] | null) {
    this.#overlays = given || [];
    this.changed();
  }

  /** What the overlays' signs mean. */
  get signs(): readonly LegendItem[] {
    return this.#signs;
  }

  set signs(given: readonly LegendItem[] | null) {
    this.#signs = given || [];
    this.changed();
  }

  /** Says what else is at a place, where the cursor reads. */
  get about(): ((xM: number, yM: number) => string) | null {
    return this.#about;
  }

  set about(given: ((xM: number, yM: number) => string) | null) {
    this.#about = given || null;
  }

  /** @internal */
  protected override axes() {
    const bar = this.getAttribute('bar') === 'below' ? { bottom: COLOR_BAR_HEIGHT } : { right: COLOR_BAR_WIDTH };
    return { x: LEFT, y: AHEAD, ...bar, equal: true, navigate: true, grid: false, minZoom: 0.01 };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const view = this.#view;
    const ground = this.#extent ?? (view && { xM: cellExtent(view.xM), yM: cellExtent(view.yM) });
    if (!ground) return null;
    const values = view ? this.#levelsOf(view) : new Float32Array(0);
    const colors = colorsOf(this.getAttribute('colors'));
    const limits = limitsOf(values, (name, absent) => this.numberOf(name, absent), 40);
    const unit = this.getAttribute('unit') ?? 'dB';
    const key = JSON.stringify([limits, colors]);
    if (view && this.#heat?.key !== key)
      this.#heat = { key, layer: heatImage({ x: view.yM, y: view.xM, values, limits, colors }) };
    const levelAt = (i: number, j: number): number => values[j * (view?.shape[0] ?? 0) + i] as number;
    return {
      content: {
        x: [],
        series: [],
        below: this.#heat ? [faded(this.#heat.layer, Math.min(Math.max(this.numberOf('opacity', 1), 0), 1))] : [],
        above: [
          ...(this.hasAttribute('without-car') ? [] : [carOutline()]),
          ...this.#overlays,
          this.getAttribute('bar') === 'below'
            ? colorBarBelow(limits, colors, unit)
            : colorBar(limits, colors, `Power (${unit})`),
        ],
        extent: { x: ground.yM, y: ground.xM },
      },
      legend: this.#signs,
      alternative: view
        ? `${fixed(cellExtent(view.xM)[1] - cellExtent(view.xM)[0], 0)} m ahead by ${fixed(cellExtent(view.yM)[1] - cellExtent(view.yM)[0], 0)} m across in cells of ${view.cellM} m; levels from ${fixed(limits[0], 0)} to ${fixed(limits[1], 0)} ${unit}.`
        : 'No image yet.',
      readout: ({ x: yM, y: xM }) => {
        const place = `x ${signed(xM, 1)} m  y ${signed(yM, 1)} m`;
        const more = this.#about?.(xM, yM);
        const i = view ? Math.round((xM - (view.xM[0] as number)) / view.cellM) : -1;
        const j = view ? Math.round((yM - (view.yM[0] as number)) / view.cellM) : -1;
        const inside = view && i >= 0 && j >= 0 && i < view.shape[0] && j < view.shape[1];
        const level = inside ? levelAt(i, j) : Number.NaN;
        const { name, title = name } = (inside && this.#radars[view.radar?.[i * view.shape[1] + j] as number]) || {};
        const seen = Number.isFinite(level) ? `${fixed(level, 1)}\u00a0${unit}` : 'nothing';
        const said = Number.isNaN(level) ? 'not seen' : [seen, title?.toLowerCase()].filter(Boolean).join('  ');
        return [place, said, more].filter(Boolean).join('  ');
      },
      csv: () =>
        toCsv(
          ['x_m', 'y_m', `power_${unit.toLowerCase()}`, 'radar'],
          (function* rows(radars: readonly RadarName[]) {
            if (!view) return;
            for (let i = 0; i < view.shape[0]; i++) {
              for (let j = 0; j < view.shape[1]; j++) {
                const level = levelAt(i, j);
                if (Number.isNaN(level)) continue;
                const { name } = radars[view.radar?.[i * view.shape[1] + j] as number] ?? {};
                yield [
                  view.xM[i]?.toFixed(3),
                  view.yM[j]?.toFixed(3),
                  Number.isFinite(level) ? level.toFixed(2) : '',
                  name,
                ];
              }
            }
          })(this.#radars),
        ),
    };
  }

  /** Levels column by column of what is to the left, as the plot's first axis has it; no numbers where no radar sees. */
  #levelsOf({ power, seen, shape: [ahead, across] }: BirdsEyeView): Float32Array {
    if (this.#levels) return this.#levels;
    const values = new Float32Array(power.length);
    for (let i = 0; i < ahead; i++) {
      for (let j = 0; j < across; j++) {
        const at = i * across + j;
        const linear = power[at] as number;
        values[j * ahead + i] = (seen ? seen[at] : linear > 0) ? 10 * Math.log10(linear) : Number.NaN;
      }
    }
    this.#levels = values;
    return values;
  }
}
