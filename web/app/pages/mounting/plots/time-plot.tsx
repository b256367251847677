/** A plot over driving time: one zoom and one cursor for all, the playhead, and a click that goes there. */

import { effect, signal, useSignal } from '@preact/signals';
import type { OwnDrawing } from '../../../../elements/kinds/plot.ts';
import { frameKeys } from '../../../../plots/frame-keys.ts';
import type { AxisOptions, Interval, View } from '../../../../plots/plot.ts';
import { type ElementProps, PlotFrame } from '../../../ui/plot-frame.tsx';
import { loaded, scans, sensor } from '../drive/drive.ts';
import { playing, step, time, togglePlaying } from '../drive/playhead.ts';

/** Begin of the drive on its own clock, s. */
export function startTime(): number {
  return scans.value.timeS[0] ?? 0;
}

export function timeExtent(): [number, number] {
  const { timeS } = scans.value;
  return [0, Math.max((timeS.at(-1) ?? 1) - startTime(), 0.1)];
}

export function sinceStart(timeS: Float64Array): Float64Array {
  const start = startTime();
  return timeS.map((value) => value - start);
}

/** The stretch of time all these plots are zoomed to. */
const zoom = signal<Interval | null>(null);

type Props = Omit<ElementProps & OwnDrawing, 'axes' | 'fileParts'> & { y: AxisOptions };

export function TimePlot({ y, ...props }: Props) {
  const zoomY = useSignal<Interval | null>(null);
  const { extent } = props.content;
  const view: View | null =
    zoom.value || zoomY.value ? { x: zoom.value ?? extent.x, y: zoomY.value ?? extent.y } : null;
  return (
    <PlotFrame
      {...props}
      view={view}
      fileParts={fileParts()}
      attach={(element) =>
        effect(() => {
          element.playhead = time.value - startTime();
        })
      }
      keys="Space plays; arrows step by a frame, with Shift by ten."
      hint="Click to go to a time."
      axes={{ x: { label: 'Driving time (s)' }, y }}
      cursorKey="drive-time"
      onClick={(position) => {
        playing.value = false;
        time.value = position.x + startTime();
      }}
      onView={(next, zoomed) => {
        const within = (part: Interval, all: Interval): boolean => zoomed && (part[0] > all[0] || part[1] < all[1]);
        zoom.value = within(next.x, extent.x) ? next.x : null;
        zoomY.value = within(next.y, extent.y) ? next.y : null;
      }}
      onKey={frameKey}
    />
  );
}

/** Keys that all plots of the page share. */
export const frameKey = frameKeys(togglePlaying, step);

/** What names the drive in a file's name. */
export function fileParts(): (string | number)[] {
  return [loaded.value?.name ?? 'drive', `radar${sensor.value?.id ?? ''}`];
}
