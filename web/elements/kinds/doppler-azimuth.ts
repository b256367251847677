import { AZIMUTH } from '../../plots/axes.ts';
import { detectionLayer, detectionLegend, nearest } from '../../plots/detections.ts';
import { type Motion, standingRate } from '../../plots/doppler.ts';
import { fixed, signed } from '../../plots/format.ts';
import { COLOR_BAR_WIDTH, colorBar } from '../../plots/heat.ts';
import { polyline } from '../../plots/layers.ts';
import { quantiles } from '../../plots/quantiles.ts';
import { toCsv } from '../../plots/save.ts';
import { methodStyle, type SeriesStyle, weightColor } from '../../plots/theme.ts';
import type { Interval } from '../../plots/types.ts';
import type { Drawing, LegendItem } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';
import { sectorOf } from '../base/sector.ts';

/** Detections of a scan as columns of one length, and the motion they show. */
export interface DopplerFrame {
  /** In the radar's frame, positive to the left. */
  azimuthDeg: ArrayLike<number>;
  /** Positive when receding. */
  rangeRateMps: ArrayLike<number>;
  rangeM?: ArrayLike<number> | null;
  rcsDbsm?: ArrayLike<number> | null;
  /** From 0, moving, to 1, static. */
  weights?: ArrayLike<number> | null;
  /** 1 where the drive knows that a detection is of something that moves. */
  moving?: ArrayLike<number> | null;
  /** The radar's velocity in its own frame. */
  motion?: Motion | null;
}

/** The radar's motion as one of several ways has it: a curve of what stands. */
export interface MotionCurve {
  id: string;
  label: string;
  motion: Motion;
  style: SeriesStyle;
  /** Drawn over the others. */
  leading?: boolean;
}

/** Azimuths of the curves, 2 degrees apart. */
const GRID = Float64Array.from({ length: 181 }, (_, i) => 2 * i - 180);
const STANDING: SeriesStyle = { color: methodStyle('recursive').color, width: 2 };

/**
 * Range rate over azimuth, with the curve of what stands. Rates far from that stand at the edge.
 *
 * @element boresight-doppler-azimuth
 * @attr {boolean} residual - rates less those of what stands, by the frame's motion
 * @attr {string} sector - how far to each side the plot shows, deg (90), or from where to where (`-60 45`)
 * @attr {boolean} weight-bar - a bar of the colours of weights
 */
export class DopplerAzimuthElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, 'residual', 'sector', 'weight-bar'];
  }

  #frame: DopplerFrame | null = null;
  #motions: readonly MotionCurve[] | null = null;

  /** The detections of a scan and the radar's motion. */
  get frame(): DopplerFrame | null {
    return this.#frame;
  }

  set frame(given: DopplerFrame | null) {
    this.#frame = given || null;
    this.changed();
  }

  /** Curves of what stands, in place of that by the frame's motion. */
  get motions(): readonly MotionCurve[] | null {
    return this.#motions;
  }

  set motions(given: readonly MotionCurve[] | null) {
    this.#motions = given || null;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    const label = this.hasAttribute('residual') ? 'Residual (m/s)' : 'Range rate (m/s), + receding';
    return { x: AZIMUTH, y: { label }, ...(this.hasAttribute('weight-bar') ? { right: COLOR_BAR_WIDTH } : {}) };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const frame = this.#frame;
    if (!frame) return null;
    const { azimuthDeg, rangeRateMps, motion = null, weights = null, moving = null } = frame;
    const standing = motion && Float64Array.from(azimuthDeg, (azimuth) => standingRate(motion, azimuth));
    const off = (i: number): number => (rangeRateMps[i] as number) - (standing?.[i] ?? Number.NaN);
    const against = this.hasAttribute('residual') ? motion : null;
    const y = Float64Array.from(rangeRateMps, (rate, i) => (against ? off(i) : rate));
    const own: MotionCurve[] = motion ? [{ id: 'standing', label: 'What stands', motion, style: STANDING }] : [];
    const motions = this.#motions ?? own;
    const drawn = [...motions].sort((a, b) => Number(a.leading ?? false) - Number(b.leading ?? false));
    const x = sectorOf(this.getAttribute('sector'), [-90, 90]);
    const extent = { x, y: rateExtent(y, motion && [x, motion], against !== null) };
    return {
      content: {
        x: GRID,
        series: [],
        extent,
        above: [
          ...drawn.map(({ motion: by, style }) =>
            polyline(
              GRID,
              GRID.map((azimuth) => standingRate(by, azimuth) - (against ? standingRate(against, azimuth) : 0)),
              style,
            ),
          ),
          detectionLayer(azimuthDeg, y, { weights, moving }, { edge: true }),
          ...(this.hasAttribute('weight-bar') ? [colorBar([0, 1], weightColor, 'Weight')] : []),
        ],
      },
      legend: [
        ...detectionLegend({ weights, moving }),
        ...motions.map(({ id, label, style }): LegendItem => {
          const { marker: _, ...line } = style;
          return { id, label, style: line, line: true };
        }),
      ],
      alternative: `${azimuthDeg.length} detections${motion ? `; the radar moves with ${fixed(Math.hypot(motion.vxMps, motion.vyMps), 2)} m/s` : ''}.`,
      readout: (position) => {
        const i = nearest(azimuthDeg, y, position, extent);
        if (i === null) return `Azimuth ${signed(position.x, 1)}°   ${signed(position.y, 2)} m/s`;
        return [
          `Detection ${i + 1}: azimuth ${signed(azimuthDeg[i] as number, 1)}°`,
          `rate ${signed(rangeRateMps[i] as number, 2)} m/s`,
          ...(motion ? [`residual ${signed(off(i), 2)} m/s`] : []),
          ...(weights ? [`weight ${fixed(weights[i] as number, 2)}`] : []),
        ].join('   ');
      },
      csv: () =>
        toCsv(
          ['azimuth_deg', 'range_rate_mps', 'range_m', 'rcs_dbsm', 'residual_mps', 'weight'],
          Array.from(azimuthDeg, (azimuth, i) => [
            azimuth,
            rangeRateMps[i],
            frame.rangeM?.[i],
            frame.rcsDbsm?.[i],
            motion ? off(i) : undefined,
            weights?.[i],
          ]),
        ),
    };
  }
}

/** Around the curve and what lies near it; the rest stands at the edge. In steps, so that playing does not shake it. */
function rateExtent(y: Float64Array, curve: readonly [Interval, Motion] | null, residual: boolean): Interval {
  const standing = (): number[] => {
    if (!curve) return [...(quantiles(y, 0.1, 0.9) ?? [-1, 1])];
    const [[left, right], motion] = curve;
    return [left, 0, right].map((azimuth) => standingRate(motion, Math.min(Math.max(azimuth, left), right)));
  };
  const centre = residual && curve ? [0] : standing();
  const reach = residual ? 2 : 8;
  let [low, high] = [Math.min(...centre), Math.max(...centre)];
  const near = y.filter((rate) => rate > low - reach && rate < high + reach);
  [low, high] = [Math.min(low, ...near), Math.max(high, ...near)];
  const unit = residual ? 1 : 2;
  return [Math.floor((low - 0.25 * unit) / unit) * unit, Math.ceil((high + 0.25 * unit) / unit) * unit];
}
