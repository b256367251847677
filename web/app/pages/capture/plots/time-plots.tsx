/** Range-time waterfall and micro-Doppler: a column a frame, the shown frame marked, and a click that goes there. */
import { effect, signal, useSignal } from '@preact/signals';
import type { FrameResult } from 'boresight';
import { useMemo } from 'preact/hooks';
import { count, fixed, signed } from '../../../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage, nearestCell } from '../../../../plots/heat.ts';
import { horizontalLine } from '../../../../plots/layers.ts';
import type { Interval, PlotContent, View } from '../../../../plots/plot.ts';
import { toCsv } from '../../../../plots/save.ts';
import { announce } from '../../../state/announce.ts';
import { PlotFrame } from '../../../ui/plot-frame.tsx';
import { ProgressLine, Stopped } from '../../../ui/progress.tsx';
import { frameAt, frameKey, showFrame } from '../frames/playback.ts';
import { captureState, update } from '../state.ts';
import {
  cancelOverTime,
  type OverTime,
  overTime,
  overTimeProgress,
  overTimeStopped,
  resumeOverTime,
} from './over-time.ts';
import { colorLimits, shownCell } from './view.ts';

/** The stretch of time both plots are zoomed to. */
const timeZoom = signal<Interval | null>(null);

type Part = (string | number)[];

export function TimePlots({ view, fileParts }: { view: FrameResult; fileParts: Part }) {
  const shown = overTime.value;
  const parts = fileParts.slice(0, 1);
  return (
    <section class="stack" aria-label="Over time" data-over-time={shown ? `${shown.done}` : ''}>
      <Status />
      {shown && (
        <div class="two">
          <RangeTime shown={shown} view={view} fileParts={parts} />
          {shown.gateM && <MicroDoppler shown={shown} gateM={shown.gateM} view={view} fileParts={parts} />}
        </div>
      )}
    </section>
  );
}

/** How far it has come, and what of the capture is not in it. */
function Status() {
  const shown = overTime.value;
  const at = overTimeProgress.value;
  const columns = shown?.timeS.length ?? 0;
  const left = shown ? remarks(shown) : [];
  const bar = at && at.done < at.total;
  if (!bar && !overTimeStopped.value && !left.length) return null;
  return (
    <div class="panel frame-bar">
      {bar && (
        <ProgressLine
          what="Frames over time"
          text={`Over time: frame ${count(at.done)} of ${count(at.total)}`}
          share={at.done / at.total}
          mark="data-opening"
          cancel="cancel-over-time"
          onCancel={cancelOverTime}
        />
      )}
      {overTimeStopped.value && (
        <Stopped
          text={`Over time: stopped after ${count(shown?.done ?? 0)} of ${count(columns)} frames`}
          mark="data-interrupted"
          action="resume-over-time"
          label="Go on"
          onResume={resumeOverTime}
        />
      )}
      {left.length > 0 && (
        <p class="remark" data-over-time-left role="status">
          {left.join(' ')}
        </p>
      )}
    </div>
  );
}

/** Frames that are not in the plots, and why. */
function remarks({ capture, every, failed, timeS }: OverTime): string[] {
  const { frames, trailingBytes } = capture.info;
  const said: string[] = [];
  if (failed.length) {
    const some = failed.slice(0, 5).map(({ frame }) => frame + 1);
    said.push(
      `${count(failed.length)} of ${count(timeS.length)} frames could not be processed and are left blank (frame ${some.join(', ')}${failed.length > some.length ? ' …' : ''}): ${failed[0]?.problem.message}.`,
    );
  }
  if (every > 1)
    said.push(`One frame of ${every} is shown: ${count(frames - timeS.length)} of ${count(frames)} are left out.`);
  if (trailingBytes) said.push(`A last frame is cut short, ${count(trailingBytes)} bytes of it are not shown.`);
  return said;
}

interface Props {
  shown: OverTime;
  view: FrameResult;
  fileParts: Part;
}

function RangeTime({ shown, view, fileParts }: Props) {
  const { rangeM, rangeDb, gateM } = shown;
  return (
    <HeatOverTime
      title="Range over time"
      name="range-time"
      shown={shown}
      view={view}
      fileParts={fileParts}
      values={rangeDb}
      across={{
        values: rangeM,
        label: 'Range (m)',
        column: 'range_m',
        say: (range) => `Range ${fixed(range, 3)} m`,
      }}
      lines={gateM ? [gateM[0], gateM[1]] : []}
      remark="Power of each frame over range. Dotted lines: the range gate of the micro-Doppler."
    />
  );
}

function MicroDoppler({ shown, gateM, view, fileParts }: Props & { gateM: readonly [number, number] }) {
  const { rateMps, rateDb } = shown;
  const gate = gateM[0] === gateM[1] ? `${fixed(gateM[0], 2)} m` : `${fixed(gateM[0], 2)} to ${fixed(gateM[1], 2)} m`;
  return (
    <HeatOverTime
      title="Micro-Doppler"
      detail={gate}
      name="micro-doppler"
      shown={shown}
      view={view}
      fileParts={[...fileParts, gate]}
      values={rateDb}
      across={{
        values: rateMps,
        label: 'Range rate (m/s), + receding',
        column: 'rate_mps',
        say: (rate) => `Rate ${signed(rate, 3)} m/s`,
      }}
      lines={[]}
      remark={`Power within the range gate, ${gate}. Its time step is a frame.`}
    />
  );
}

function HeatOverTime({
  shown,
  view,
  values,
  across,
  lines,
  remark,
  fileParts,
  ...frame
}: Props & {
  title: string;
  detail?: string;
  name: string;
  values: Float32Array;
  /** The vertical axis. */
  across: { values: Float64Array; label: string; column: string; say(value: number): string };
  lines: readonly number[];
  remark: string;
}) {
  const { timeS, every } = shown;
  const { span, colors } = captureState.value;
  const interval = shown.capture.info.config.waveform.frameIntervalS;
  const limits = useMemo(() => colorLimits(values, Number(span)), [shown, values, span]);
  const image = useMemo(
    () => heatImage({ x: timeS, y: across.values, values, limits, colors }),
    [shown, values, limits[0], limits[1], colors],
  );
  const extent = useMemo((): View => ({ x: cellExtent(timeS), y: cellExtent(across.values) }), [timeS, across.values]);
  const content = useMemo(
    (): PlotContent => ({
      x: timeS,
      series: [],
      extent,
      below: [image],
      above: [
        ...lines.map((value) => horizontalLine(value, '', { color: () => '#ffffff' })),
        colorBar(limits, colors, 'dBFS'),
      ],
    }),
    [image, lines.join()],
  );
  const zoomY = useSignal<Interval | null>(null);
  const zoom: View | null =
    timeZoom.value || zoomY.value ? { x: timeZoom.value ?? extent.x, y: zoomY.value ?? extent.y } : null;
  const rows = across.values.length;
  const go = (timeAt: number): void => {
    showFrame(nearestCell(timeAt, timeS) * every);
    announce(`Frame ${frameAt() + 1}, ${fixed(frameAt() * interval, 3)} seconds.`, 300);
  };
  const moveGate = (by: number): void => {
    const cell = shownCell(view, captureState.peek().cell);
    const at = Math.min(Math.max(cell.rangeBin + by, 0), view.rangeM.length - 1);
    update({ cell: { ...cell, rangeBin: at } });
    announce(`Range ${fixed(view.rangeM[at] ?? 0, 2)} metres.`, 300);
  };
  return (
    <PlotFrame
      {...frame}
      height="medium"
      content={content}
      view={zoom}
      attach={(element) =>
        effect(() => {
          element.playhead = captureState.value.frame === 'all' ? Number.NaN : frameAt() * interval;
        })
      }
      keys="Space plays; left and right arrows step by a frame, with Shift by ten; up and down arrows move the range gate."
      axes={{ x: { label: 'Time (s)' }, y: { label: across.label }, right: COLOR_BAR_WIDTH, grid: false }}
      cursorKey="capture-time"
      onClick={({ x }) => go(x)}
      onView={(next, zoomed) => {
        const within = (part: Interval, all: Interval): boolean => zoomed && (part[0] > all[0] || part[1] < all[1]);
        timeZoom.value = within(next.x, extent.x) ? next.x : null;
        zoomY.value = within(next.y, extent.y) ? next.y : null;
      }}
      onKey={(event) => {
        if (event.key === 'ArrowUp' || event.key === 'ArrowDown') {
          moveGate((event.key === 'ArrowUp' ? 1 : -1) * (event.shiftKey ? 10 : 1));
          return true;
        }
        return frameKey(event);
      }}
      readout={({ x, y }) => {
        const [column, row] = [nearestCell(x, timeS), nearestCell(y, across.values)];
        const level = values[column * rows + row] ?? Number.NaN;
        return `Time ${fixed(timeS[column] ?? Number.NaN, 3)} s   Frame ${column * every + 1}   ${across.say(across.values[row] ?? Number.NaN)}   Power ${fixed(level, 1)} dBFS`;
      }}
      csv={() =>
        toCsv(
          ['frame', 'time_s', across.column, 'power_dbfs'],
          (function* table() {
            for (let i = 0; i < timeS.length; i++)
              for (let j = 0; j < rows; j++) yield [i * every + 1, timeS[i], across.values[j], values[i * rows + j]];
          })(),
        )
      }
      fileParts={fileParts}
      remarks={[remark]}
      hint="Click to go to a frame."
    />
  );
}
