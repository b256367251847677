import type { Estimate } from 'boresight';
import { AZIMUTH } from '../plots/axes.ts';
import { fixed, signed } from '../plots/format.ts';
import { markers, verticalLines } from '../plots/layers.ts';
import { methodStyle } from '../plots/theme.ts';
import type { Drawing } from './drawing.ts';
import { PlotElement } from './plot-element.ts';

/**
 * Spectra of angle, one a method, with the angles found.
 *
 * @element boresight-spectrum
 * @attr {number} floor-db - the lowest level shown, dB below the highest (60)
 */
export class SpectrumElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, 'floor-db'];
  }

  #estimates: readonly Estimate[] = [];
  #truthDeg: readonly number[] = [];

  /** Results of `estimate`, of one array and one scene. */
  get estimates(): readonly Estimate[] {
    return this.#estimates;
  }

  set estimates(given: readonly Estimate[] | Estimate | null) {
    this.#estimates = given === null ? [] : Array.isArray(given) ? given : [given as Estimate];
    this.changed();
  }

  /** True azimuths where they are known, deg. */
  get truthDeg(): readonly number[] {
    return this.#truthDeg;
  }

  set truthDeg(given: readonly number[] | null) {
    this.#truthDeg = given ?? [];
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: AZIMUTH, y: { label: 'Relative power (dB)' } };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const shown = this.#estimates.map((estimate) => ({ estimate, style: methodStyle(estimate.method) }));
    if (!shown.length) return null;
    const curves = shown.flatMap(({ estimate, style }) => {
      const { spectrum } = estimate;
      if (!spectrum) return [];
      const values = spectrum.valuesDb.subarray(0, spectrum.azimuthDeg.length);
      const top = values.reduce((most, value) => Math.max(most, value), Number.NEGATIVE_INFINITY);
      return [{ method: estimate.method, style, x: spectrum.azimuthDeg, y: values.map((value) => value - top) }];
    });
    const floor = -Math.abs(this.numberOf('floor-db', 60));
    const x = curves[0]?.x ?? new Float64Array([-90, 90]);
    const marks = shown.flatMap(({ estimate, style }) =>
      estimate.sources.map(({ azimuthDeg }) => ({ x: azimuthDeg, y: 0, style })),
    );
    return {
      content: {
        x,
        // uPlot has one grid of abscissae: other spectra are read off at its angles.
        series: curves.map(({ method, style, x: own, y }) => ({
          id: method,
          label: method,
          y: own === x ? y : Float64Array.from(x, (angle) => at(own, y, angle)),
          style,
        })),
        above: [verticalLines(this.#truthDeg.map((angle) => ({ x: angle }))), markers(marks)],
        extent: { x: [x[0] as number, x[x.length - 1] as number], y: [floor, 3] },
      },
      legend: shown.map(({ estimate, style }) => ({
        label: estimate.method,
        style,
        line: estimate.spectrum !== undefined,
      })),
      alternative: shown
        .map(({ estimate: { method, sources } }) => {
          const angles = sources.map(({ azimuthDeg }) => `${signed(azimuthDeg, 2)}°`).join(', ');
          return `${method}: ${angles || 'no angle found'}.`;
        })
        .join('\n'),
      readout: ({ x: angle, index }) =>
        [
          `Azimuth ${signed(angle, 2)}°`,
          ...curves.map(({ method, x: own, y }) =>
            own === x
              ? `${method} ${fixed(y[index ?? -1] ?? Number.NaN, 1)} dB`
              : `${method} ${fixed(at(own, y, angle), 1)} dB`,
          ),
        ].join('   '),
    };
  }
}

/** A value between those of ascending abscissae; not a number beyond them. */
function at(x: ArrayLike<number>, y: ArrayLike<number>, place: number): number {
  let [low, high] = [0, x.length - 1];
  if (!(place >= (x[low] as number) && place <= (x[high] as number))) return Number.NaN;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((x[middle] as number) <= place) low = middle;
    else high = middle;
  }
  const [a, b] = [x[low] as number, x[high] as number];
  const share = b > a ? (place - a) / (b - a) : 0;
  return (y[low] as number) + share * ((y[high] as number) - (y[low] as number));
}
