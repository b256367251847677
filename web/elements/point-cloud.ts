import { AHEAD, LEFT } from '../plots/axes.ts';
import { carOutline } from '../plots/car.ts';
import { detectionLayer, detectionLegend, nearest } from '../plots/detections.ts';
import { fixed, signed } from '../plots/format.ts';
import type { Interval, View } from '../plots/types.ts';
import type { Drawing } from './drawing.ts';
import { PlotElement } from './plot-element.ts';

/** Detections of a scan as columns of one length. */
export interface PointCloud {
  rangeM: ArrayLike<number>;
  /** In the radar's frame, positive to the left. */
  azimuthDeg: ArrayLike<number>;
  rangeRateMps?: ArrayLike<number> | null;
  /** From 0, moving, to 1, static. */
  weights?: ArrayLike<number> | null;
  /** 1 where the drive knows that a detection is of something that moves. */
  moving?: ArrayLike<number> | null;
}

/** Where a radar sits on the car; at its origin, looking ahead, if not given. */
export interface Place {
  xM: number;
  yM: number;
  yawDeg: number;
}

/**
 * Detections around the car, from above.
 *
 * @element boresight-point-cloud
 * @attr {number} range - how far the plot shows, m; as far as there are points by default
 */
export class PointCloudElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, 'range'];
  }

  #points: PointCloud | null = null;
  #mounting: Place = { xM: 0, yM: 0, yawDeg: 0 };
  /** Where points were so far, so that a live plot does not jump: to the left and ahead, m. */
  #seen = { left: [-5, 5], ahead: [-5, 5] };

  get points(): PointCloud | null {
    return this.#points;
  }

  set points(given: PointCloud | null) {
    this.#points = given;
    this.changed();
  }

  get mounting(): Place {
    return this.#mounting;
  }

  set mounting(given: Place | null) {
    this.#mounting = given ?? { xM: 0, yM: 0, yawDeg: 0 };
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: LEFT, y: AHEAD, equal: true, navigate: true };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const cloud = this.#points;
    if (!cloud) return null;
    const { rangeM, azimuthDeg, rangeRateMps } = cloud;
    const { xM, yM, yawDeg } = this.#mounting;
    const count = Math.min(rangeM.length, azimuthDeg.length);
    const [left, ahead] = [new Float64Array(count), new Float64Array(count)];
    for (let i = 0; i < count; i++) {
      const angle = (((azimuthDeg[i] as number) + yawDeg) * Math.PI) / 180;
      ahead[i] = xM + (rangeM[i] as number) * Math.cos(angle);
      left[i] = yM + (rangeM[i] as number) * Math.sin(angle);
      widen(this.#seen.left, left[i] as number);
      widen(this.#seen.ahead, ahead[i] as number);
    }
    const reach = Math.abs(this.numberOf('range', Number.NaN));
    const view: View =
      reach > 0 ? { x: [-reach, reach], y: [-reach, reach] } : { x: pair(this.#seen.left), y: pair(this.#seen.ahead) };
    const weighed = { weights: cloud.weights ?? null, moving: cloud.moving ?? null };
    return {
      content: { x: [], series: [], above: [carOutline(), detectionLayer(left, ahead, weighed)], extent: view },
      legend: detectionLegend(weighed),
      alternative: `${count} detections${cloud.weights ? `, of which ${Array.from(cloud.weights).filter((weight) => weight >= 0.5).length} are taken as static` : ''}.`,
      readout: (position) => {
        const i = nearest(left, ahead, position, view);
        const place = `x ${signed(position.y, 1)} m   y ${signed(position.x, 1)} m`;
        if (i === null) return place;
        const rate = rangeRateMps?.[i];
        return `${place}   Range ${fixed(rangeM[i] as number, 1)} m   Azimuth ${signed(azimuthDeg[i] as number, 1)}°${rate === undefined ? '' : `   Range rate ${signed(rate, 2)} m/s`}`;
      },
    };
  }
}

const pair = ([low = -5, high = 5]: number[]): Interval => [low, high];

/** Widens an interval to hold a place, in steps of ten metres. */
function widen(interval: number[], place: number): void {
  if (!Number.isFinite(place)) return;
  const [low, high] = pair(interval);
  interval[0] = place < low ? 10 * Math.floor(place / 10) : low;
  interval[1] = place > high ? 10 * Math.ceil(place / 10) : high;
}
