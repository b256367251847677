/** Range profile and range-Doppler map: one range axis for both. */
import { signal } from '@preact/signals';
import type { BoardObject, Cell, FrameResult } from 'boresight';
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../elements/define.ts';
import { RangeDopplerElement } from '../../../elements/range-doppler.ts';
import { fixed } from '../../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent } from '../../../plots/heat.ts';
import { type Layer, polyline, verticalLines } from '../../../plots/layers.ts';
import type { View as Zoom } from '../../../plots/plot.ts';
import { toCsv } from '../../../plots/save.ts';
import { ACCENT_STYLE, faint, TRUTH_STYLE } from '../../../plots/theme.ts';
import { KeepButton } from '../../ui/comparison.tsx';
import { ElementFrame, PlotFrame } from '../../ui/plot-frame.tsx';
import { compared, keptView } from './compare.ts';
import { captureState, update } from './state.ts';

defineElement('boresight-range-doppler', RangeDopplerElement);

/** The range interval both plots are zoomed to. */
const rangeZoom = signal<readonly [number, number] | null>(null);
const rateZoom = signal<readonly [number, number] | null>(null);

interface Props {
  view: FrameResult;
  cell: Cell;
  board: readonly BoardObject[];
  label: string;
  fileParts: readonly (string | number)[];
}

/** A's profile. */
const FAINT = faint({ color: TRUTH_STYLE.color });

const RANGE_AXIS = { label: 'Range (m)' };

export function RangeProfile({ view, cell, board, label, fileParts }: Props) {
  const a = keptView.value;
  const extentY = useMemo((): [number, number] => {
    let low = Number.POSITIVE_INFINITY;
    let high = Number.NEGATIVE_INFINITY;
    for (const value of [...view.rangeProfileDb, ...(a?.rangeProfileDb ?? [])]) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return Number.isFinite(low) ? [Math.floor(low / 10) * 10, Math.ceil((high + 4) / 10) * 10] : [-100, 0];
  }, [view, a]);
  const extentX = useMemo(() => cellExtent(view.rangeM), [view]);
  const content = useMemo(
    () => ({
      x: view.rangeM,
      series: [{ id: 'profile', label: 'Profile', y: view.rangeProfileDb, style: { color: ACCENT_STYLE.color } }],
      extent: { x: extentX, y: extentY },
      above: [
        ...(a ? [polyline(a.rangeM, a.rangeProfileDb, FAINT)] : []),
        verticalLines(
          board.map(({ rangeM }) => ({ x: rangeM })),
          { dash: [2, 4], color: (t) => t.muted },
        ),
        detectionTicks(view),
      ],
    }),
    [view, board, a],
  );
  const zoom = rangeZoom.value;
  const shown: Zoom | null = zoom ? { x: zoom, y: extentY } : null;
  return (
    <PlotFrame
      title="Range profile"
      name="range-profile"
      height="short"
      content={content}
      view={shown}
      tools={<KeepButton of={compared} />}
      {...(a
        ? {
            legend: [
              { id: 'b', label: 'B', style: { color: ACCENT_STYLE.color }, line: true },
              { id: 'a', label: 'A', style: FAINT, line: true },
            ],
          }
        : {})}
      axes={{ x: RANGE_AXIS, y: { label: 'Power (dBFS)' }, right: COLOR_BAR_WIDTH }}
      cursorKey="range"
      onView={(next, zoomed) => {
        rangeZoom.value = zoomed ? next.x : null;
      }}
      onClick={({ index }) => {
        if (index !== null) update({ cell: { rangeBin: index, dopplerBin: cell.dopplerBin } });
      }}
      readout={({ x, index }) =>
        `Range ${fixed(x, 3)} m   Power ${fixed(view.rangeProfileDb[index ?? -1] ?? Number.NaN, 1)} dBFS`
      }
      csv={() =>
        toCsv(
          ['range_m', 'power_dbfs'],
          Array.from(view.rangeM, (range, i) => [range, view.rangeProfileDb[i]]),
        )
      }
      fileParts={fileParts}
      remarks={[`${label}. Triangles: detections; dotted lines: ranges the board reported.`]}
    />
  );
}

/** Small triangles at the top of the plot. */
function detectionTicks(view: FrameResult): Layer {
  return ({ ctx, plot, theme, ratio, x }) => {
    const { left, top, width } = plot.bbox;
    ctx.fillStyle = theme.text;
    for (const { rangeM } of view.detections) {
      const at = x(rangeM);
      if (at < left || at > left + width) continue;
      ctx.beginPath();
      ctx.moveTo(at - 4 * ratio, top);
      ctx.lineTo(at + 4 * ratio, top);
      ctx.lineTo(at, top + 7 * ratio);
      ctx.fill();
    }
  };
}

export function RangeDopplerMap({ view, cell, label, fileParts }: Props) {
  const { span, colors } = captureState.value;
  const extent = useMemo(() => ({ x: cellExtent(view.rangeM), y: cellExtent(view.rateMps) }), [view]);
  const zoom: Zoom | null =
    rangeZoom.value || rateZoom.value ? { x: rangeZoom.value ?? extent.x, y: rateZoom.value ?? extent.y } : null;
  const shownCell = useMemo(() => cell, [cell.rangeBin, cell.dopplerBin]);
  return (
    <ElementFrame
      tag="boresight-range-doppler"
      own={{
        frame: view,
        cell: shownCell,
        colors,
        'span-db': span,
        selectable: true,
        'onboresight-cell': ({ detail }: CustomEvent<Cell | null>) => update({ cell: detail }),
      }}
      title="Range-Doppler map"
      name="range-doppler"
      height="medium"
      listed="none"
      view={zoom}
      cursorKey="range"
      onView={(next, zoomed) => {
        rangeZoom.value = zoomed && (next.x[0] > extent.x[0] || next.x[1] < extent.x[1]) ? next.x : null;
        rateZoom.value = zoomed && (next.y[0] > extent.y[0] || next.y[1] < extent.y[1]) ? next.y : null;
      }}
      fileParts={fileParts}
      remarks={[`${label}. Squares: detections; crosshair: the chosen cell.`]}
      hint="Click a cell, or use the arrow keys."
    />
  );
}
