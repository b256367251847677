import { AHEAD, LEFT } from '../../plots/axes.ts';
import { BORESIGHT, boresight, carOutline, inCar, NOMINAL, type Place } from '../../plots/car.ts';
import { detectionLayer, detectionLegend, nearest } from '../../plots/detections.ts';
import { fixed, signed } from '../../plots/format.ts';
import { toCsv } from '../../plots/save.ts';
import type { Interval, View } from '../../plots/types.ts';
import type { Drawing, LegendItem } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';
import type { Ground } from './birds-eye.ts';

export type { Place } from '../../plots/car.ts';

/** Detections of a scan as columns of one length. */
export interface PointCloud {
  /** Without ranges detections have no place. */
  rangeM?: ArrayLike<number> | null;
  /** In the radar's frame, positive to the left. */
  azimuthDeg: ArrayLike<number>;
  /** Positive upwards; all at 0 where it is not given. */
  elevationDeg?: ArrayLike<number> | null;
  rangeRateMps?: ArrayLike<number> | null;
  rcsDbsm?: ArrayLike<number> | null;
  /** From 0, moving, to 1, static. */
  weights?: ArrayLike<number> | null;
  /** 1 where the drive knows that a detection is of something that moves. */
  moving?: ArrayLike<number> | null;
}

const AT_ORIGIN: Place = { xM: 0, yM: 0, yawDeg: 0 };

/**
 * Detections around the car, from above.
 *
 * @element boresight-point-cloud
 * @attr {boolean} boresight - where the radar is and looks
 * @attr {boolean} drag-zooms - a drag zooms to a region in place of moving the view
 * @attr {number} nominal-deg - where the radar should look, with `boresight`
 * @attr {number} range - how far the plot shows, m; as far as there are points by default
 */
export class PointCloudElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, 'boresight', 'drag-zooms', 'nominal-deg', 'range'];
  }

  #points: PointCloud | null = null;
  #mounting: Place = AT_ORIGIN;
  #extent: Ground | null = null;
  /** Where points were so far, so that a live plot does not jump: to the left and ahead, m. */
  #seen = { left: [-5, 5], ahead: [-5, 5] };

  /** The detections of a scan. */
  get points(): PointCloud | null {
    return this.#points;
  }

  set points(given: PointCloud | null) {
    this.#points = given || null;
    this.changed();
  }

  /** Where the radar sits on the car; at its origin, looking ahead, if not given. */
  get mounting(): Place {
    return this.#mounting;
  }

  set mounting(given: Place | null) {
    this.#mounting = given || AT_ORIGIN;
    this.changed();
  }

  /** The ground that is shown, in place of what `range` says. */
  get extent(): Ground | null {
    return this.#extent;
  }

  set extent(given: Ground | null) {
    this.#extent = given || null;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: LEFT, y: AHEAD, equal: true, navigate: !this.hasAttribute('drag-zooms') };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const cloud = this.#points;
    if (!cloud) return null;
    const { rangeM, azimuthDeg, elevationDeg, rangeRateMps, rcsDbsm, weights = null, moving = null } = cloud;
    const count = azimuthDeg.length;
    const [left, ahead, up] = [new Float64Array(count), new Float64Array(count), new Float64Array(count)];
    for (let i = 0; i < count; i++) {
      const steep = ((elevationDeg?.[i] ?? 0) * Math.PI) / 180;
      const range = rangeM?.[i] ?? Number.NaN;
      // From above a detection is as far as its shadow.
      const [x, y] = inCar(this.#mounting, range * Math.cos(steep), azimuthDeg[i] as number);
      up[i] = range * Math.sin(steep);
      [ahead[i], left[i]] = [x, y];
      widen(this.#seen.left, y);
      widen(this.#seen.ahead, x);
    }
    const view = this.#shown();
    const nominal = this.numberOf('nominal-deg', Number.NaN);
    const known = Number.isFinite(nominal);
    const rays = this.hasAttribute('boresight');
    return {
      content: {
        x: [],
        series: [],
        below: [carOutline(), ...(rays ? [boresight(this.#mounting, known ? nominal : null)] : [])],
        above: [detectionLayer(left, ahead, { weights, moving })],
        extent: view,
      },
      legend: [...detectionLegend({ weights, moving }), ...(rays ? raySigns(this.#mounting.yawDeg, nominal) : [])],
      alternative: `${count} detections${weights ? `, of which ${Array.from(weights).filter((weight) => weight >= 0.5).length} are taken as static` : ''}.`,
      readout: (position) => {
        const i = nearest(left, ahead, position, view);
        if (i === null) return `Ahead ${signed(position.y, 1)} m   left ${signed(position.x, 1)} m`;
        const [rate, rcs] = [rangeRateMps?.[i], rcsDbsm?.[i]];
        return [
          `Detection ${i + 1}: ahead ${signed(ahead[i] as number, 1)} m`,
          `left ${signed(left[i] as number, 1)} m`,
          ...(elevationDeg ? [`up ${signed(up[i] as number, 2)} m`] : []),
          `range ${fixed(rangeM?.[i] ?? Number.NaN, 1)} m`,
          ...(rate === undefined ? [] : [`rate ${signed(rate, 2)} m/s`]),
          ...(rcs !== undefined && Number.isFinite(rcs) ? [`RCS ${signed(rcs, 1)} dBsm`] : []),
        ].join('   ');
      },
      csv: () =>
        toCsv(
          [
            'x_m',
            'y_m',
            'range_m',
            'azimuth_deg',
            'rcs_dbsm',
            'weight',
            ...(elevationDeg ? ['z_m', 'elevation_deg'] : []),
          ],
          Array.from(azimuthDeg, (azimuth, i) => [
            ...[ahead[i], left[i], rangeM?.[i], azimuth, rcsDbsm?.[i], weights?.[i]],
            ...(elevationDeg ? [up[i], elevationDeg[i]] : []),
          ]),
        ),
    };
  }

  #shown(): View {
    if (this.#extent) return { x: this.#extent.yM, y: this.#extent.xM };
    const reach = Math.abs(this.numberOf('range', Number.NaN));
    return reach > 0
      ? { x: [-reach, reach], y: [-reach, reach] }
      : { x: pair(this.#seen.left), y: pair(this.#seen.ahead) };
  }
}

/** What the rays mean. */
function raySigns(yawDeg: number, nominalDeg: number): LegendItem[] {
  const sign = (id: string, name: string, angle: number, style: typeof BORESIGHT): LegendItem => ({
    id,
    label: `${name}, ${signed(angle, 2)}°`,
    style,
    line: true,
  });
  return [
    sign('boresight', 'Boresight', yawDeg, BORESIGHT),
    ...(Number.isFinite(nominalDeg) ? [sign('nominal', 'Nominal', nominalDeg, NOMINAL)] : []),
  ];
}

const pair = ([low = -5, high = 5]: number[]): Interval => [low, high];

/** Widens an interval to hold a place, in steps of ten metres. */
function widen(interval: number[], place: number): void {
  if (!Number.isFinite(place)) return;
  const [low, high] = pair(interval);
  interval[0] = place < low ? 10 * Math.floor(place / 10) : low;
  interval[1] = place > high ? 10 * Math.ceil(place / 10) : high;
}
