/** The drive from above: from the radar's motion with the angle found and the nominal one, and as the log has it. */

import type { Trajectory } from 'boresight';
import { useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../../elements/base/drawing.ts';
import { fixed, signed } from '../../../../plots/format.ts';
import { type Layer, markers, polyline } from '../../../../plots/layers.ts';
import type { View } from '../../../../plots/plot.ts';
import { toCsv } from '../../../../plots/save.ts';
import { methodStyle, type SeriesStyle, TRUTH_STYLE } from '../../../../plots/theme.ts';
import { PlotFrame } from '../../../ui/plot-frame.tsx';
import { loaded } from '../drive/drive.ts';
import { after, time } from '../drive/playhead.ts';
import { shown, shownMethod } from '../results/process.ts';
import { mountingState } from '../state.ts';
import { fileParts, frameKey } from './time-plot.tsx';
import { paths, SEGMENT_M } from './trajectory.ts';

const NOMINAL: SeriesStyle = { color: methodStyle('weighted-mean').color, dash: [5, 4] };
const REFERENCE: SeriesStyle = { color: TRUTH_STYLE.color, width: 1.3, dash: [2, 2] };

const REFERENCES = { truth: 'Truth', poses: 'Poses of the log', odometry: 'Speed and yaw rate as measured' } as const;

export function TrajectoryPlot() {
  const all = paths.value;
  const calibration = shown.value;
  const simulated = loaded.value?.truth !== null;
  const FOUND: SeriesStyle = { ...methodStyle(shownMethod.value ?? 'recursive'), width: 2 };
  const lines = useMemo(
    () =>
      all
        ? (
            [
              [all.nominal, NOMINAL],
              [all.found, FOUND],
              [all.reference, REFERENCE],
            ] as const
          ).flatMap(([path, style]): Layer[] => (path ? [polyline(path.xM, path.yM, style)] : []))
        : [],
    [all],
  );
  const extent = useMemo(() => bounds(all?.reference ?? null, all?.found ?? null), [all]);
  const now = time.value;
  const content = useMemo(() => {
    const here = (path: Trajectory | null | undefined, style: SeriesStyle, marker: 'circle' | 'square' | 'cross') => {
      if (!path) return [];
      const i = Math.max(after(path.timeS, now) - 1, 0);
      return path.xM.length
        ? [{ x: path.xM[i] as number, y: path.yM[i] as number, style: { ...style, marker }, size: 5 }]
        : [];
    };
    return {
      x: [],
      series: [],
      extent,
      above: [
        ...lines,
        markers(
          [
            ...here(all?.nominal, NOMINAL, 'square'),
            ...here(all?.reference, REFERENCE, 'cross'),
            ...here(all?.found, FOUND, 'circle'),
          ],
          { edge: false },
        ),
      ],
    };
  }, [lines, extent, now]);
  const error = (value: number | null | undefined): string => (value == null ? '' : `, RTE ${fixed(value, 2)} m`);
  const nominalDeg = calibration?.mounting.nominalDeg;
  const legend: LegendItem[] = all
    ? [
        {
          id: 'found',
          label: `Angle found, ${signed(calibration?.result.angleDeg ?? Number.NaN, 2)}°${error(all.foundError)}`,
          style: { ...FOUND, marker: 'circle' },
          line: true,
        },
        ...(all.nominal
          ? [
              {
                id: 'nominal',
                label: `Nominal angle, ${signed(nominalDeg ?? Number.NaN, 2)}°${error(all.nominalError)}`,
                style: { ...NOMINAL, marker: 'square' as const },
                line: true,
              },
            ]
          : []),
        ...(all.reference
          ? [
              {
                id: 'reference',
                label: REFERENCES[simulated ? 'truth' : (all.kind ?? 'poses')],
                style: { ...REFERENCE, marker: 'cross' as const },
                line: true,
              },
            ]
          : []),
      ]
    : [];
  const remark = !all
    ? 'Not calibrated yet.'
    : !all.found
      ? 'The radar is too near the rear axle’s line to tell how the car turns.'
      : `The radar’s own motion from the start, ${mountingState.value.heading === 'sensor' ? 'turned by the yaw rate as measured less its bias' : 'which also turns the car: a wrong angle bends the way'}. RTE: mean end-point error of ${SEGMENT_M} m segments.${all.reference ? '' : ' This drive has neither poses nor speed to compare with.'}`;
  return (
    <PlotFrame
      title="Trajectory"
      name="trajectory"
      height="tall"
      content={content}
      legend={legend}
      keys="Space plays; arrows step by a frame, with Shift by ten."
      axes={{
        x: { label: 'Along the first heading (m)' },
        y: { label: 'Left of it (m)' },
        equal: true,
      }}
      onKey={frameKey}
      readout={({ x, y }) => `Along ${signed(x, 0)} m   left ${signed(y, 0)} m`}
      csv={() =>
        toCsv(
          ['path', 'time_s', 'x_m', 'y_m', 'yaw_deg'],
          all
            ? (
                [
                  ['found', all.found],
                  ['nominal', all.nominal],
                  ['reference', all.reference],
                ] as const
              ).flatMap(([name, path]) =>
                Array.from(path?.timeS ?? [], (t, i) => [name, t, path?.xM[i], path?.yM[i], path?.yawDeg[i]]),
              )
            : [],
        )
      }
      fileParts={fileParts()}
      remarks={[remark]}
    />
  );
}

/** All of the reference, and of the path found unless that strays far beyond; the nominal one may run out of sight. */
function bounds(reference: Trajectory | null, found: Trajectory | null): View {
  const along = (axis: 'xM' | 'yM'): [number, number] => {
    const range = (path: Trajectory | null): [number, number] => {
      let [low, high] = [0, 0];
      for (const value of path?.[axis] ?? [])
        if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
      return [low, high];
    };
    const [[a, b], [c, d]] = [range(reference ?? found), range(found)];
    const spare = Math.max(b - a, 50);
    const [low, high] = [Math.max(Math.min(a, c), a - spare), Math.min(Math.max(b, d), b + spare)];
    const room = Math.max(0.06 * (high - low), 10);
    return [low - room, high + room];
  };
  return { x: along('xM'), y: along('yM') };
}
