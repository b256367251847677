/** What a board sends of a frame: points, a profile, and maps where it is told to send them. */
import { useSignal } from '@preact/signals';
import type { BoardFrame, RadarConfig } from 'boresight';
import { useMemo } from 'preact/hooks';
import { pointsOf } from '../../../elements/kinds/board.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage, limitsBelow, nearestCell } from '../../../plots/heat.ts';
import { verticalLines } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { ACCENT_STYLE, TRUTH_STYLE } from '../../../plots/theme.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { CloudPlot } from '../../ui/space/cloud.tsx';
import type { SpacePoint } from '../../ui/space/points.ts';
import { azimuthMap, dopplerMap, type GroundMap, rangeAxis } from './maps.ts';
import { liveState, update } from './state.ts';

interface Props {
  frame: BoardFrame;
  config: RadarConfig | null;
}

export function BoardPlots({ frame, config }: Props) {
  const doppler = useMemo(() => dopplerMap(frame, config), [frame, config]);
  const azimuth = useMemo(() => azimuthMap(frame, config), [frame, config]);
  return (
    <>
      <div class="wide-narrow">
        <Points frame={frame} config={config} />
        <Profile frame={frame} config={config} />
      </div>
      {doppler && (
        <Heat map={doppler} title="Range and Doppler, by the board" name="board-range-doppler" frame={frame} />
      )}
      {azimuth && (
        <Heat map={azimuth} title="Range and azimuth, by the board" name="board-range-azimuth" frame={frame} />
      )}
    </>
  );
}

function Points({ frame, config }: Props) {
  const cloud = useMemo(() => pointsOf(frame), [frame]);
  const points = useMemo(
    () =>
      frame.objects.map(
        ({ xM, yM, zM, rateMps, snrDb }, i): SpacePoint => ({
          xM,
          yM,
          zM,
          rateMps: rateMps ?? Number.NaN,
          powerDb: snrDb ?? Number.NaN,
          key: String(i),
        }),
      ),
    [frame],
  );
  const chosen = useSignal<string | null>(null);
  const { range, points: shown, pointColour } = liveState.value;
  return (
    <CloudPlot
      title="Detections"
      name="board-points"
      detail={`Frame ${frame.frameNumber}`}
      cloud={cloud}
      points={points}
      of={config}
      chosen={chosen.value}
      onChoose={(key) => {
        chosen.value = key;
      }}
      inSpace={shown === 'space'}
      onSwitch={(inSpace) => update({ points: inSpace ? 'space' : 'above' })}
      by={pointColour}
      level="SNR (dB)"
      onColour={(by) => update({ pointColour: by })}
      range={range > 0 ? range : undefined}
      remarks={[`${frame.objects.length} detections of the board, ${frame.platform}, SDK ${frame.sdkVersion}.`]}
    />
  );
}

function Profile({ frame, config }: Props) {
  const { rangeProfileDb: profile, noiseProfileDb: noise, objects } = frame;
  const x = useMemo(() => rangeAxis(profile?.length ?? 0, config), [profile?.length, config]);
  if (!profile) {
    return (
      <section class="panel loading" role="status">
        The board sends no range profile. The third number of guiMonitor in its configuration turns it on.
      </section>
    );
  }
  const top = profile.reduce((most, value) => Math.max(most, value), 0);
  const series = [
    { id: 'profile', label: 'Range profile', y: profile, style: { color: ACCENT_STYLE.color } },
    ...(noise ? [{ id: 'noise', label: 'Noise profile', y: noise, style: { color: TRUTH_STYLE.color } }] : []),
  ];
  return (
    <PlotFrame
      title="Range profile"
      name="board-profile"
      height="medium"
      detail={`Frame ${frame.frameNumber}`}
      axes={{ x: { label: x.label }, y: { label: 'Level (dB), over the board’s unit' } }}
      content={{
        x: x.values,
        series,
        above: [
          verticalLines(config ? objects.map(({ rangeM }) => ({ x: rangeM })) : [], {
            dash: [2, 4],
            color: (theme) => theme.muted,
          }),
        ],
        extent: { x: cellExtent(x.values), y: [0, 10 * Math.ceil((top + 4) / 10)] },
      }}
      legend={series.map(({ id, label, style }) => ({ id, label, style, line: true }))}
      readout={({ index }) =>
        index === null ? '' : `${x.name} ${fixed(x.values[index] ?? 0, 2)}   ${fixed(profile[index] ?? 0, 1)} dB`
      }
      alternative={`Range profile of ${profile.length} bins, up to ${fixed(top, 1)} dB.`}
      csv={() =>
        toCsv(
          [x.column, 'level_db'],
          Array.from(profile, (value, i) => [x.values[i], value]),
        )
      }
      remarks={config ? ['At zero Doppler. Dotted lines: ranges of the detections.'] : ['At zero Doppler.']}
    />
  );
}

function Heat({ map, title, name, frame }: { map: GroundMap; title: string; name: string; frame: BoardFrame }) {
  const { span, colors } = liveState.value;
  const { x, y, values } = map;
  const limits = useMemo(() => {
    let top = Number.NEGATIVE_INFINITY;
    for (const value of values) if (value > top) top = value;
    return limitsBelow(top, Number(span));
  }, [values, span]);
  const heat = useMemo(
    () => heatImage({ x: x.values, y: y.values, values, limits, colors }),
    [x, y, values, limits, colors],
  );
  const level = (i: number, j: number): number => values[i * y.values.length + j] ?? Number.NaN;
  return (
    <PlotFrame
      title={title}
      name={name}
      height="medium"
      listed="none"
      detail={`Frame ${frame.frameNumber}`}
      axes={{ x: { ...map.xAxis }, y: { label: y.label }, right: COLOR_BAR_WIDTH, grid: false }}
      content={{
        x: x.values,
        series: [],
        below: [heat],
        above: [colorBar(limits, colors, 'dB')],
        extent: { x: cellExtent(x.values), y: cellExtent(y.values) },
      }}
      readout={(at) => {
        const [i, j] = [nearestCell(at.x, x.values), nearestCell(at.y, y.values)];
        return `${x.name} ${signed(x.values[i] ?? 0, 2)}   ${y.name} ${signed(y.values[j] ?? 0, 2)}   ${fixed(level(i, j), 1)} dB`;
      }}
      alternative={`${x.values.length} by ${y.values.length} cells; levels from ${fixed(limits[0], 0)} to ${fixed(limits[1], 0)} dB.`}
      csv={() =>
        toCsv(
          [x.column, y.column, 'level_db'],
          (function* rows() {
            for (let i = 0; i < x.values.length; i++)
              for (let j = 0; j < y.values.length; j++) yield [x.values[i], y.values[j], level(i, j)];
          })(),
        )
      }
      remarks={map.remarks}
    />
  );
}
