/** Range rate against azimuth of one frame, with the curve of what stands. */

import { useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../elements/drawing.ts';
import { AZIMUTH } from '../../../plots/axes.ts';
import { detectionLayer, detectionLegend, nearest } from '../../../plots/detections.ts';
import { type Motion, standingRate } from '../../../plots/doppler.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { COLOR_BAR_WIDTH, colorBar } from '../../../plots/heat.ts';
import { type Layer, polyline } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { methodStyle, type SeriesStyle, TRUTH_STYLE, weightColor } from '../../../plots/theme.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { loaded } from './drive.ts';
import { expectedMotion, type FrameView, quantiles, sample } from './frame.ts';
import { shownMethod } from './process.ts';
import { mountingState } from './state.ts';
import { fileParts, frameKey } from './time-plot.tsx';
import { about } from './ways.ts';

const EXPECTED: SeriesStyle = { color: TRUTH_STYLE.color, width: 1.2, dash: [2, 3] };

/** Azimuths of the curves, 2 degrees apart. */
const GRID = Float64Array.from({ length: 181 }, (_, i) => 2 * i - 180);

export function DopplerPlot({ view, label }: { view: FrameView; label: string }) {
  const { residual } = mountingState.value;
  const method = shownMethod.value;
  const drive = loaded.value?.drive;
  const sector = useMemo((): [number, number] => {
    const azimuth = drive?.detections.azimuthDeg;
    const [low, high] = quantiles(
      sample.value.map((k) => azimuth?.[k] ?? Number.NaN),
      0,
      1,
    ) ?? [-60, 60];
    return [Math.floor((low - 2) / 5) * 5, Math.ceil((high + 2) / 5) * 5];
  }, [drive, sample.value]);
  const y = useMemo(
    () =>
      Float64Array.from(view.rangeRateMps, (rate, i) =>
        residual && view.motion ? rate - standingRate(view.motion, view.azimuthDeg[i] as number) : rate,
      ),
    [view, residual],
  );
  const expected = expectedMotion(view);
  const content = useMemo(() => {
    const lines: Layer[] = [];
    const against = residual ? view.motion : null;
    const curve = (motion: Motion): Float64Array =>
      GRID.map((azimuth) => standingRate(motion, azimuth) - (against ? standingRate(against, azimuth) : 0));
    if (expected) lines.push(polyline(GRID, curve(expected), EXPECTED));
    const curves = [...view.motions].sort(([a], [b]) => Number(a === method) - Number(b === method));
    for (const [name, motion] of curves) {
      lines.push(polyline(GRID, curve(motion), { ...methodStyle(name), width: name === method ? 2.4 : 1.2 }));
    }
    return {
      x: GRID,
      series: [],
      extent: { x: sector, y: rateExtent(view, y, sector, residual) },
      above: [
        ...lines,
        detectionLayer(view.azimuthDeg, y, view, { edge: true }),
        colorBar([0, 1], weightColor, 'Weight'),
      ],
    };
  }, [view, y, method, sector, expected?.vxMps, expected?.vyMps]);
  const legend: LegendItem[] = [
    ...detectionLegend(view),
    ...(expected
      ? [
          {
            id: 'expected',
            label: 'From the car’s speed and yaw rate, with the angle found',
            style: EXPECTED,
            line: true,
          },
        ]
      : []),
    ...[...view.motions].map(
      ([name, motion]): LegendItem => ({
        id: name,
        label: `${about(name).title}: ${fixed(Math.hypot(motion.vxMps, motion.vyMps), 2)} m/s`,
        style: { ...methodStyle(name), marker: undefined as never },
        line: true,
      }),
    ),
  ];
  return (
    <PlotFrame
      title={residual ? 'Range-rate residual against azimuth' : 'Range rate against azimuth'}
      name="doppler-azimuth"
      height="tall"
      content={content}
      legend={legend}
      keys="Space plays; arrows step by a frame, with Shift by ten."
      axes={{
        x: AZIMUTH,
        y: { label: residual ? 'Residual (m/s)' : 'Range rate (m/s), + receding' },
        right: COLOR_BAR_WIDTH,
      }}
      onKey={frameKey}
      readout={(position) => {
        const i = nearest(view.azimuthDeg, y, position, content.extent);
        if (i === null) return `Azimuth ${signed(position.x, 1)}°   ${signed(position.y, 2)} m/s`;
        const off = view.motion
          ? `   residual ${signed((view.rangeRateMps[i] as number) - standingRate(view.motion, view.azimuthDeg[i] as number), 2)} m/s`
          : '';
        return (
          `Detection ${i + 1}: azimuth ${signed(view.azimuthDeg[i] as number, 1)}°   rate ${signed(view.rangeRateMps[i] as number, 2)} m/s${off}` +
          `${view.weights ? `   weight ${fixed(view.weights[i] as number, 2)}` : ''}`
        );
      }}
      csv={() =>
        toCsv(
          ['azimuth_deg', 'range_rate_mps', 'range_m', 'rcs_dbsm', 'residual_mps', 'weight'],
          Array.from(view.azimuthDeg, (azimuth, i) => [
            azimuth,
            view.rangeRateMps[i],
            view.rangeM?.[i],
            view.rcsDbsm?.[i],
            view.motion ? (view.rangeRateMps[i] as number) - standingRate(view.motion, azimuth) : undefined,
            view.weights?.[i],
          ]),
        )
      }
      fileParts={[...fileParts(), `${fixed(view.timeS, 2)}s`]}
      remarks={[
        `${label}. Lines: what stands, −(vx cos a + vy sin a), for the radar’s own motion as each method has it.`,
      ]}
    />
  );
}

/** Around the curve and what lies near it; the rest stands at the edge. In steps, so that playing does not shake it. */
function rateExtent(
  view: FrameView,
  y: Float64Array,
  [left, right]: readonly [number, number],
  residual: boolean,
): [number, number] {
  const curve =
    view.motion && !residual
      ? [left, 0, right].map((azimuth) => standingRate(view.motion!, Math.min(Math.max(azimuth, left), right)))
      : [];
  const centre = residual && view.motion ? [0] : curve.length ? curve : [...(quantiles(y, 0.1, 0.9) ?? [-1, 1])];
  const reach = residual ? 2 : 8;
  let [low, high] = [Math.min(...centre), Math.max(...centre)];
  const near = [...y].filter((rate) => rate > low - reach && rate < high + reach);
  [low, high] = [Math.min(low, ...near), Math.max(high, ...near)];
  const unit = residual ? 1 : 2;
  return [Math.floor((low - 0.25 * unit) / unit) * unit, Math.ceil((high + 0.25 * unit) / unit) * unit];
}
