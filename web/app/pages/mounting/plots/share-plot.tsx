/** What became of each frame: its inliers, its weight, and why it was left out. */

import { useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../../elements/base/drawing.ts';
import { fixed } from '../../../../plots/format.ts';
import { clipToPlot, dots, type Layer, polyline } from '../../../../plots/layers.ts';
import { quantiles } from '../../../../plots/quantiles.ts';
import { toCsv } from '../../../../plots/save.ts';
import { ACCENT_STYLE, methodStyle, type SeriesStyle } from '../../../../plots/theme.ts';
import { api } from '../../../data.ts';
import { loaded, scans } from '../drive/drive.ts';
import { after, frame } from '../drive/playhead.ts';
import { about } from '../motion/ways.ts';
import { shown, shownMethod } from '../results/process.ts';
import { sinceStart, startTime, TimePlot, timeExtent } from './time-plot.tsx';

/** Below the curves a lane for each verdict, so that no colour has to tell them apart. */
const LANES = [
  ['used', 'used'],
  ['standing', 'standing'],
  ['slow', 'slow'],
  ['turning', 'turning'],
  ['sparse', 'sparse'],
  ['off-speed', 'off speed'],
  ['without-motion', 'no motion'],
] as const;
const LANE = 0.085;

const SHARE: SeriesStyle = { color: ACCENT_STYLE.color };
const WEIGHT: SeriesStyle = { color: methodStyle('weighted-mean').color, dash: [6, 3] };

export function SharePlot() {
  const calibration = shown.value;
  const drive = loaded.value?.drive;
  const data = useMemo(() => {
    if (!calibration || !drive) return null;
    const { frames } = calibration;
    const x = sinceStart(frames.timeS);
    const { offsets } = drive.scans;
    const sizes = Float32Array.from(frames.scan, (i) => (offsets[i + 1] as number) - (offsets[i] as number));
    const share = sizes.map((size, i) =>
      size && Number.isFinite(frames.vxMps[i]) ? (frames.inliers[i] as number) / size : Number.NaN,
    );
    const [, heaviest] = quantiles(frames.weight, 0, 0.98) ?? [0, 1];
    const weight = Float32Array.from(frames.weight, (value) =>
      value > 0 ? Math.min(value / (heaviest || 1), 1.1) : Number.NaN,
    );
    return { x, sizes, share, weight, heaviest, frames };
  }, [calibration, drive]);
  const content = useMemo(() => {
    const extent = { x: timeExtent(), y: [-LANE * (LANES.length + 0.6), 1.05] as const };
    if (!data) return { x: [], series: [], extent };
    const { x, share, weight, frames } = data;
    return {
      x,
      series: [],
      extent,
      above: [
        dots(x, weight, WEIGHT, 0.15),
        dots(x, share, SHARE, 0.2),
        polyline(x, smoothed(x, weight), WEIGHT),
        polyline(x, smoothed(x, share), SHARE),
        lanes(x, frames.verdict),
      ],
    };
  }, [data, scans.value]);
  const at = (x: number): number => (data ? Math.max(after(data.frames.timeS, x + startTime()) - 1, 0) : -1);
  const verdict = (i: number): string => api.frameVerdicts[data?.frames.verdict[i] ?? -1] ?? '–';
  const now = frame.value;
  const part = (values: Float32Array | undefined) => ({
    value: ({ x }: { x: number }) => fixed(values?.[at(x)] ?? Number.NaN, 2),
    rest: fixed(values?.[now] ?? Number.NaN, 2),
  });
  const legend: LegendItem[] = [
    { id: 'share', label: 'Share of static detections', style: SHARE, line: true, ...part(data?.share) },
    { id: 'weight', label: 'Weight of the frame, relative', style: WEIGHT, line: true, ...part(data?.weight) },
  ];
  return (
    <TimePlot
      title="Frames: inliers, weights, what became of them"
      {...(shownMethod.value ? { detail: about(shownMethod.value).title } : {})}
      name="frame-weights"
      height="medium"
      content={content}
      legend={legend}
      y={{ label: 'Share, relative weight', from: 0, width: 64 }}
      readout={({ x }) => {
        const i = at(x);
        return data
          ? `Time ${fixed(x, 2)} s   frame ${i + 1}: ${data.frames.inliers[i] ?? 0} of ${data.sizes[i] ?? 0} static   ${verdict(i).replace('-', ' ')}`
          : '';
      }}
      csv={() =>
        toCsv(
          [
            'time_s',
            'verdict',
            'detections',
            'inliers',
            'weight_per_rad2',
            'vx_mps',
            'vy_mps',
            'angle_deg',
            'angle_sigma_deg',
          ],
          Array.from(data?.frames.timeS ?? [], (time, i) => {
            const { inliers, weight, vxMps, vyMps, angleDeg, angleSigmaDeg } = data!.frames;
            return [
              time,
              verdict(i),
              data!.sizes[i],
              inliers[i],
              weight[i],
              vxMps[i],
              vyMps[i],
              angleDeg[i],
              angleSigmaDeg[i],
            ];
          }),
        )
      }
      remarks={[
        `Lines: means over 4 s.${data && data.heaviest > 0 ? ` Weights are relative to ${data.heaviest.toExponential(1)} rad⁻².` : ''}`,
      ]}
    />
  );
}

/** Means over a window of 4 s of what there is. */
function smoothed(x: Float64Array, values: Float32Array): Float32Array {
  const out = new Float32Array(values.length).fill(Number.NaN);
  let [first, last, sum, size] = [0, 0, 0, 0];
  for (let i = 0; i < x.length; i++) {
    for (; last < x.length && (x[last] as number) < (x[i] as number) + 2; last++) {
      if (Number.isFinite(values[last])) [sum, size] = [sum + (values[last] as number), size + 1];
    }
    for (; (x[first] as number) < (x[i] as number) - 2; first++) {
      if (Number.isFinite(values[first])) [sum, size] = [sum - (values[first] as number), size - 1];
    }
    if (size > 0 && Number.isFinite(values[i])) out[i] = sum / size;
  }
  return out;
}

function lanes(times: Float64Array, verdicts: Uint8Array): Layer {
  return ({ ctx, plot, theme, ratio, x, y }) => {
    const { left } = plot.bbox;
    const height = Math.abs(y(0) - y(LANE));
    ctx.font = `${10 * ratio}px ${theme.font}`;
    ctx.textBaseline = 'middle';
    ctx.textAlign = 'right';
    LANES.forEach(([name, label], lane) => {
      const code = api.frameVerdicts.indexOf(name);
      const top = y(-LANE * (lane + 0.5));
      ctx.fillStyle = lane === 0 ? theme.accent : theme.muted;
      ctx.save();
      clipToPlot(ctx, plot);
      for (let i = 0; i < times.length; i++) {
        if (verdicts[i] !== code) continue;
        const start = i;
        while (i + 1 < times.length && verdicts[i + 1] === code) i += 1;
        const end = times[Math.min(i + 1, times.length - 1)] as number;
        const from = x(times[start] as number);
        ctx.fillRect(from, top + 0.15 * height, Math.max(x(end) - from, ratio), 0.7 * height);
      }
      ctx.restore();
      ctx.fillStyle = theme.text;
      ctx.fillText(label, left - 6 * ratio, top + height / 2);
    });
  };
}
