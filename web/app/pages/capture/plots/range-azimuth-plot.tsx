/** The range-azimuth map of the shown frame, which follows while frames play. */
import { useMemo } from 'preact/hooks';
import { AZIMUTH } from '../../../../plots/axes.ts';
import { count, fixed, signed } from '../../../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage, limitsBelow, nearestCell } from '../../../../plots/heat.ts';
import type { PlotContent } from '../../../../plots/plot.ts';
import { toCsv } from '../../../../plots/save.ts';
import { api } from '../../../data.ts';
import { PlotFrame } from '../../../ui/plot-frame.tsx';
import { ProgressLine, Stopped } from '../../../ui/progress.tsx';
import { frameKey, playing, togglePlaying } from '../frames/playback.ts';
import { captureState } from '../state.ts';
import {
  cancelRangeAzimuth,
  rangeAzimuth,
  rangeAzimuthProblem,
  rangeAzimuthProgress,
  rangeAzimuthStopped,
  rangeAzimuthTopDb,
  rangeAzimuthWorking,
  resumeRangeAzimuth,
  type ShownMap,
} from './range-azimuth.ts';

export function RangeAzimuth({ fileParts }: { fileParts: readonly (string | number)[] }) {
  const shown = rangeAzimuth.value;
  const problem = rangeAzimuthProblem.value;
  if (problem) {
    return (
      <p class="alert" role="alert" data-error={problem.code}>
        <strong>No range-azimuth map of one frame.</strong> {problem.message} <code>{problem.code}</code>
      </p>
    );
  }
  return (
    <>
      <Progress />
      {shown && <Picture shown={shown} name={fileParts[0] ?? 'capture'} />}
    </>
  );
}

function Progress() {
  const at = rangeAzimuthProgress.value;
  if (!at && !rangeAzimuthStopped.value) return null;
  return (
    <div class="panel frame-bar">
      {at ? (
        <ProgressLine
          what="Range-azimuth map"
          text={`Range-azimuth map: cell ${count(at.done)} of ${count(at.total)}`}
          share={at.done / Math.max(at.total, 1)}
          mark="data-opening"
          cancel="cancel-map"
          onCancel={cancelRangeAzimuth}
        />
      ) : (
        <Stopped
          text="The range-azimuth map was stopped"
          mark="data-interrupted"
          action="resume-map"
          label="Go on"
          onResume={resumeRangeAzimuth}
        />
      )}
    </div>
  );
}

function Picture({ shown, name }: { shown: ShownMap; name: string | number }) {
  const { rangeM, azimuthDeg, levelsDb, frame, capture, from } = shown;
  const { span, colors, angle } = captureState.value;
  const limits = limitsBelow(rangeAzimuthTopDb.value, Number(span));
  const { frames } = capture.info;
  const image = useMemo(
    () => heatImage({ x: azimuthDeg, y: rangeM, values: levelsDb, limits, colors }),
    [shown, limits[0], limits[1], colors],
  );
  const content = useMemo((): PlotContent => {
    const [left, right] = cellExtent(azimuthDeg);
    return {
      x: [],
      series: [],
      extent: { x: [right, left], y: cellExtent(rangeM) },
      below: [image],
      above: [colorBar(limits, colors, 'dBFS')],
    };
  }, [image]);
  const title = api.methods().find((info) => info.name === angle)?.title ?? angle;
  const dropped = [
    shown.beyondLimit > 0 && ` ${count(shown.beyondLimit)} weaker cells are left out.`,
    shown.outside > 0 && ` ${count(shown.outside)} sources lie beside the map.`,
  ].filter(Boolean);
  return (
    <div data-range-azimuth={frame} aria-busy={rangeAzimuthWorking.value}>
      <PlotFrame
        title="Range-azimuth map"
        detail={`frame ${frame + 1} of ${frames}`}
        name="range-azimuth"
        height="tall"
        content={content}
        tools={
          <button
            type="button"
            slot="actions"
            aria-pressed={playing.value}
            data-action="play-map"
            disabled={frames < 2}
            onClick={togglePlaying}
          >
            {playing.value ? 'Pause' : 'Play'}
          </button>
        }
        keys="Space plays; left and right arrows step by a frame, with Shift by ten."
        axes={{ x: AZIMUTH, y: { label: 'Range (m)' }, right: COLOR_BAR_WIDTH, grid: false }}
        onKey={frameKey}
        readout={({ x, y }) => {
          const [column, row] = [nearestCell(x, azimuthDeg), nearestCell(y, rangeM)];
          const level = levelsDb[column * rangeM.length + row] ?? Number.NaN;
          return `Azimuth ${signed(azimuthDeg[column] ?? Number.NaN, 1)}°   Range ${fixed(rangeM[row] ?? Number.NaN, 2)} m   ${Number.isFinite(level) ? `Power ${fixed(level, 1)} dBFS` : 'nothing over the threshold'}`;
        }}
        csv={() =>
          toCsv(
            ['azimuth_deg', 'range_m', 'power_dbfs'],
            (function* table() {
              for (let i = 0; i < azimuthDeg.length; i++)
                for (let j = 0; j < rangeM.length; j++)
                  yield [azimuthDeg[i], rangeM[j], levelsDb[i * rangeM.length + j]];
            })(),
          )
        }
        fileParts={[name, `frame${frame + 1}`]}
        remarks={[
          `${title}, ${from === 'spectra' ? 'spectra' : 'targets'} of the ${count(shown.cells)} cells over the threshold.${dropped.join('')}`,
          ...(captureState.value.frame === 'all' ? ['It takes one frame at a time: this is the first.'] : []),
        ]}
        hint="Colours stay the same while frames play; other methods: Angle by."
      />
    </div>
  );
}
