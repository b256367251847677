/** The angle over driving time, as each method has it, with the deviation it claims. */

import type { AngleHistory } from 'boresight';
import { useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../../elements/base/drawing.ts';
import { angleBand, angleExtent } from '../../../../plots/angle-history.ts';
import { fixed, signed } from '../../../../plots/format.ts';
import { dots, horizontalLine, type Layer } from '../../../../plots/layers.ts';
import { toCsv } from '../../../../plots/save.ts';
import { methodStyle, type SeriesStyle, THEMES, TRUTH_STYLE } from '../../../../plots/theme.ts';
import { loaded, sensor } from '../drive/drive.ts';
import { after } from '../drive/playhead.ts';
import { about, WAYS, type Way } from '../motion/ways.ts';
import { results, shown, shownMethod, where } from '../results/process.ts';
import { mountingState } from '../state.ts';
import { sinceStart, startTime, TimePlot, timeExtent } from './time-plot.tsx';

/** Frames before they are smoothed. */
const ALONE: SeriesStyle = { color: { light: THEMES.light.muted, dark: THEMES.dark.muted } };

interface Curve {
  method: Way;
  title: string;
  history: AngleHistory;
}

/** The last entry not later than a time. */
const entry = (history: AngleHistory, timeS: number): number => after(history.timeS, timeS) - 1;

export function AnglePlot() {
  const { band, singles } = mountingState.value;
  const sigmas = Number(band);
  const radar = sensor.value;
  const open = loaded.value;
  const trueDeg = radar ? open?.statedDeg.get(radar.id) : undefined;
  const nominalDeg = where.value?.nominalDeg ?? null;
  const found = results.value;
  const frames = shown.value;
  const method = shownMethod.value;
  const alone = (method && found.get(method)?.aloneDeg) ?? null;
  const curves = useMemo(
    () =>
      WAYS.flatMap((way): Curve[] => {
        const result = found.get(way);
        const history = result?.calibration?.history;
        return history ? [{ method: way, title: about(way).title, history }] : [];
      }),
    [found],
  );
  const content = useMemo(() => {
    const below: Layer[] = [];
    const lines: Layer[] = [];
    for (const { method: way, history } of [...curves].sort(
      (a, b) => Number(a.method === method) - Number(b.method === method),
    )) {
      const x = sinceStart(history.timeS);
      const style = methodStyle(way);
      const { band: area, line } = angleBand(x, history, sigmas, style);
      below.push(area);
      lines.push(line);
    }
    if (frames && singles && alone) lines.unshift(dots(sinceStart(frames.frames.timeS), alone, ALONE, 0.4));
    if (frames && method && singles)
      lines.splice(
        alone ? 1 : 0,
        0,
        dots(sinceStart(frames.frames.timeS), frames.frames.angleDeg, methodStyle(method), alone ? 0.8 : 0.2),
      );
    const extent = {
      x: timeExtent(),
      y: angleExtent(
        curves.map(({ history }) => history),
        sigmas,
        { trueDeg, nominalDeg, shownDeg: found.get(method ?? 'recursive')?.calibration?.result.angleDeg },
      ),
    };
    if (nominalDeg !== null)
      lines.push(horizontalLine(nominalDeg, `nominal ${signed(nominalDeg, 2)}°`, { left: true }));
    if (trueDeg !== undefined) {
      lines.push(
        horizontalLine(trueDeg, `${open?.truth ? 'true' : 'stated'} ${signed(trueDeg, 2)}°`, {
          color: (t) => t.truth,
          dash: [6, 3],
        }),
      );
    }
    return { x: sinceStart(curves[0]?.history.timeS ?? new Float64Array()), series: [], extent, below, above: lines };
  }, [curves, frames, alone, method, singles, sigmas, trueDeg, nominalDeg]);
  const at = (curve: Curve, x: number): string => {
    const i = entry(curve.history, x + startTime());
    const [angle, sigma] = [curve.history.angleDeg[i] ?? Number.NaN, curve.history.sigmaDeg[i] ?? Number.NaN];
    return `${signed(angle, 3)}° ± ${sigma === Number.POSITIVE_INFINITY ? '∞' : fixed(sigma, 3)}`;
  };
  const legend: LegendItem[] = [
    ...curves.map(
      (curve): LegendItem => ({
        id: curve.method,
        label: curve.title,
        style: methodStyle(curve.method),
        line: true,
        value: ({ x }) => at(curve, x),
        rest: at(curve, Number.POSITIVE_INFINITY),
      }),
    ),
    ...(trueDeg === undefined
      ? []
      : [
          {
            id: 'truth',
            label: open?.truth ? 'True angle' : 'Angle stated by the data set',
            style: { ...TRUTH_STYLE, dash: [6, 3] },
            line: true,
          },
        ]),
  ];
  const ends = curves.map(({ history }) => history.angleDeg.at(-1) ?? Number.NaN);
  const beyond = curves
    .filter((_, i) => (ends[i] as number) < content.extent.y[0] || (ends[i] as number) > content.extent.y[1])
    .map(({ title }) => title);
  const outside = nominalDeg !== null && (nominalDeg < content.extent.y[0] || nominalDeg > content.extent.y[1]);
  return (
    <TimePlot
      title="Angle over driving time"
      name="angle-history"
      height="medium"
      content={content}
      legend={legend}
      y={{ label: 'Mounting angle (°)', width: 64 }}
      readout={({ x, y }) => `Time ${fixed(x, 1)} s   Angle ${signed(y, 3)}°`}
      csv={() =>
        toCsv(
          ['method', 'time_s', 'angle_deg', 'sigma_deg'],
          curves.flatMap(({ method, history }) =>
            Array.from(history.timeS, (time, i) => [method, time, history.angleDeg[i], history.sigmaDeg[i]]),
          ),
        )
      }
      remarks={[
        `Shaded: the angle ± ${band} standard deviation${band === '1' ? '' : 's'}, as each method claims them.` +
          `${frames && singles ? (alone ? ' Dots: what frames give, smoothed over eight; grey: before smoothing.' : ' Dots: what single frames give.') : ''}${outside ? ` The nominal angle, ${signed(nominalDeg, 2)}°, is outside.` : ''}${beyond.length ? ` Out of sight at the end: ${beyond.join('; ')}.` : ''}`,
      ]}
    />
  );
}
