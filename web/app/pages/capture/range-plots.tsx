/** Range profile and range-Doppler map: one range axis for both. */
import { signal } from '@preact/signals';
import type { BoardObject, Cell, FrameResult } from 'boresight';
import { useMemo } from 'preact/hooks';
import { fixed, signed } from '../../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage, nearestCell } from '../../../plots/heat.ts';
import { clipToPlot, type Layer, polyline, strokeTwice, verticalLines } from '../../../plots/layers.ts';
import type { View as Zoom } from '../../../plots/plot.ts';
import { toCsv } from '../../../plots/save.ts';
import { ACCENT_STYLE, faint, TRUTH_STYLE } from '../../../plots/theme.ts';
import { announce } from '../../state/announce.ts';
import { KeepButton } from '../../ui/comparison.tsx';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { compared, keptView } from './compare.ts';
import { captureState, update } from './state.ts';
import { colorLimits } from './view.ts';

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
  const limits = useMemo(() => colorLimits(view.rangeDopplerDb, Number(span)), [view, span]);
  const image = useMemo(
    () => heatImage({ x: view.rangeM, y: view.rateMps, values: view.rangeDopplerDb, limits, colors }),
    [view, limits[0], limits[1], colors],
  );
  const extent = useMemo(() => ({ x: cellExtent(view.rangeM), y: cellExtent(view.rateMps) }), [view]);
  const content = useMemo(
    () => ({
      x: view.rangeM,
      series: [],
      extent,
      below: [image],
      above: [detectionBoxes(view), selection(view, cell), colorBar(limits, colors, 'dBFS')],
    }),
    [view, image, cell.rangeBin, cell.dopplerBin],
  );
  const zoom: Zoom | null =
    rangeZoom.value || rateZoom.value ? { x: rangeZoom.value ?? extent.x, y: rateZoom.value ?? extent.y } : null;
  const level = (range: number, doppler: number): number =>
    view.rangeDopplerDb[range * view.rateMps.length + doppler] ?? Number.NaN;
  const select = (next: Cell): void => {
    const range = Math.min(Math.max(next.rangeBin, 0), view.rangeM.length - 1);
    const doppler = Math.min(Math.max(next.dopplerBin, 0), view.rateMps.length - 1);
    update({ cell: { rangeBin: range, dopplerBin: doppler } });
    announce(
      `Range ${fixed(view.rangeM[range] ?? 0, 2)} metres, rate ${signed(view.rateMps[doppler] ?? 0, 2)} metres per second, ${fixed(level(range, doppler), 1)} dB.`,
      300,
    );
  };
  const step = (by: number): void => {
    const rows = [...view.detections].sort((a, b) => b.powerDb - a.powerDb);
    if (!rows.length) return;
    const at = rows.findIndex((row) => row.rangeBin === cell.rangeBin && row.dopplerBin === cell.dopplerBin);
    const row = rows[(at + by + rows.length) % rows.length]!;
    select({ rangeBin: row.rangeBin, dopplerBin: row.dopplerBin });
  };
  const key = (event: KeyboardEvent): boolean => {
    const by = event.shiftKey ? 10 : 1;
    switch (event.key) {
      case 'ArrowLeft':
        select({ ...cell, rangeBin: cell.rangeBin - by });
        return true;
      case 'ArrowRight':
        select({ ...cell, rangeBin: cell.rangeBin + by });
        return true;
      case 'ArrowUp':
        select({ ...cell, dopplerBin: cell.dopplerBin + by });
        return true;
      case 'ArrowDown':
        select({ ...cell, dopplerBin: cell.dopplerBin - by });
        return true;
      case 'n':
        step(1);
        return true;
      case 'p':
        step(-1);
        return true;
      case 'Home':
        update({ cell: null });
        return true;
      default:
        return false;
    }
  };
  return (
    <PlotFrame
      title="Range-Doppler map"
      name="range-doppler"
      height="medium"
      content={content}
      view={zoom}
      keys="Arrows choose a cell, with Shift by ten; N and P go through the detections; Home takes the strongest."
      axes={{ x: RANGE_AXIS, y: { label: 'Range rate (m/s), + receding' }, right: COLOR_BAR_WIDTH, grid: false }}
      cursorKey="range"
      onClick={({ x, y }) =>
        select({ rangeBin: nearestCell(x, view.rangeM), dopplerBin: nearestCell(y, view.rateMps) })
      }
      onKey={key}
      onView={(next, zoomed) => {
        rangeZoom.value = zoomed && (next.x[0] > extent.x[0] || next.x[1] < extent.x[1]) ? next.x : null;
        rateZoom.value = zoomed && (next.y[0] > extent.y[0] || next.y[1] < extent.y[1]) ? next.y : null;
      }}
      readout={({ x, y }) => {
        const [range, doppler] = [nearestCell(x, view.rangeM), nearestCell(y, view.rateMps)];
        return `Range ${fixed(view.rangeM[range] ?? Number.NaN, 3)} m   Rate ${signed(view.rateMps[doppler] ?? Number.NaN, 3)} m/s   Power ${fixed(level(range, doppler), 1)} dBFS   bin ${range}, ${doppler}`;
      }}
      csv={() =>
        toCsv(
          ['range_m', 'rate_mps', 'power_dbfs'],
          (function* rows() {
            for (let i = 0; i < view.rangeM.length; i++) {
              for (let j = 0; j < view.rateMps.length; j++) yield [view.rangeM[i], view.rateMps[j], level(i, j)];
            }
          })(),
        )
      }
      fileParts={fileParts}
      remarks={[`${label}. Squares: detections; crosshair: the chosen cell.`]}
      hint="Click a cell, or use the arrow keys."
    />
  );
}

function detectionBoxes(view: FrameResult): Layer {
  return ({ ctx, plot, ratio, x, y }) => {
    clipToPlot(ctx, plot);
    const r = 5 * ratio;
    const boxes = (path: CanvasPath): void => {
      for (const row of view.detections)
        path.rect(x(row.rangeM) - r, y(view.rateMps[row.dopplerBin] ?? row.rateMps) - r, 2 * r, 2 * r);
    };
    const under = { color: 'rgba(0, 0, 0, 0.75)', width: 3.5 * ratio };
    strokeTwice(ctx, boxes, under, { color: '#ffffff', width: 1.5 * ratio });
  };
}

function selection(view: FrameResult, cell: Cell): Layer {
  return ({ ctx, plot, ratio, x, y }) => {
    clipToPlot(ctx, plot);
    const { left, top, width, height } = plot.bbox;
    const [px, py] = [x(view.rangeM[cell.rangeBin] ?? 0), y(view.rateMps[cell.dopplerBin] ?? 0)];
    const gap = 9 * ratio;
    ctx.beginPath();
    for (const [ax, ay, bx, by] of [
      [left, py, px - gap, py],
      [px + gap, py, left + width, py],
      [px, top, px, py - gap],
      [px, py + gap, px, top + height],
    ] as const) {
      ctx.moveTo(ax, ay);
      ctx.lineTo(bx, by);
    }
    ctx.globalAlpha = 0.75;
    ctx.setLineDash([5 * ratio, 4 * ratio]);
    ctx.strokeStyle = '#ffffff';
    ctx.lineWidth = ratio;
    ctx.stroke();
  };
}
