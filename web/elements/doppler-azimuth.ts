import { AZIMUTH } from '../plots/axes.ts';
import { detectionLayer, detectionLegend, nearest } from '../plots/detections.ts';
import { type Motion, standingRate } from '../plots/doppler.ts';
import { fixed, signed } from '../plots/format.ts';
import { polyline } from '../plots/layers.ts';
import { methodStyle } from '../plots/theme.ts';
import type { Drawing } from './drawing.ts';
import { PlotElement } from './plot-element.ts';

/** Detections of a scan as columns of one length, and the motion they show. */
export interface DopplerFrame {
  /** In the radar's frame, positive to the left. */
  azimuthDeg: ArrayLike<number>;
  /** Positive when receding. */
  rangeRateMps: ArrayLike<number>;
  /** From 0, moving, to 1, static. */
  weights?: ArrayLike<number> | null;
  /** 1 where the drive knows that a detection is of something that moves. */
  moving?: ArrayLike<number> | null;
  /** The radar's velocity in its own frame. */
  motion?: Motion | null;
}

/** Azimuths of the curve, 2 degrees apart. */
const GRID = Float64Array.from({ length: 181 }, (_, i) => 2 * i - 180);
const STANDING = methodStyle('recursive');

/**
 * Range rate over azimuth, with the curve of what stands.
 *
 * @element boresight-doppler-azimuth
 * @attr {number} sector - how far to each side the plot shows, deg (90)
 */
export class DopplerAzimuthElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, 'sector'];
  }

  #frame: DopplerFrame | null = null;

  get frame(): DopplerFrame | null {
    return this.#frame;
  }

  set frame(given: DopplerFrame | null) {
    this.#frame = given;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: AZIMUTH, y: { label: 'Range rate (m/s), + receding' } };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const frame = this.#frame;
    if (!frame) return null;
    const { azimuthDeg, rangeRateMps, motion = null } = frame;
    const sector = Math.min(Math.abs(this.numberOf('sector', 90)) || 90, 180);
    let most = 1;
    for (let i = 0; i < rangeRateMps.length; i++) {
      const rate = Math.abs(rangeRateMps[i] as number);
      if (Number.isFinite(rate)) most = Math.max(most, rate);
    }
    const curve = motion ? GRID.map((azimuth) => standingRate(motion, azimuth)) : null;
    const weighed = { weights: frame.weights ?? null, moving: frame.moving ?? null };
    const view = { x: [-sector, sector], y: [-1.1 * most, 1.1 * most] } as const;
    return {
      content: {
        x: GRID,
        series: [],
        above: [...(curve ? [polyline(GRID, curve, STANDING)] : []), detectionLayer(azimuthDeg, rangeRateMps, weighed)],
        extent: view,
      },
      legend: [
        ...detectionLegend(weighed),
        ...(motion ? [{ label: 'What stands', style: { color: STANDING.color, width: 2 }, line: true }] : []),
      ],
      alternative: `${azimuthDeg.length} detections${motion ? `; the radar moves with ${fixed(Math.hypot(motion.vxMps, motion.vyMps), 2)} m/s` : ''}.`,
      readout: (position) => {
        const i = nearest(azimuthDeg, rangeRateMps, position, view);
        const [azimuth, rate] =
          i === null ? [position.x, position.y] : [azimuthDeg[i] as number, rangeRateMps[i] as number];
        return `Azimuth ${signed(azimuth, 1)}°   Range rate ${signed(rate, 2)} m/s${curve && motion ? `   ${signed(rate - standingRate(motion, azimuth), 2)} m/s from what stands` : ''}`;
      },
    };
  }
}
