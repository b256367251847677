/** Range profile and range-Doppler map: one range axis for both. */
import { signal } from '@preact/signals';
import type { BoardObject, Cell, CellExplanation, FrameResult } from 'boresight';
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../../elements/base/define.ts';
import { RangeDopplerElement } from '../../../../elements/kinds/range-doppler.ts';
import { fixed, signed } from '../../../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent } from '../../../../plots/heat.ts';
import { type Layer, polyline, verticalLines } from '../../../../plots/layers.ts';
import type { View as Zoom } from '../../../../plots/plot.ts';
import { toCsv } from '../../../../plots/save.ts';
import { ACCENT_STYLE, faint, type SeriesStyle, TRUTH_STYLE } from '../../../../plots/theme.ts';
import { KeepButton } from '../../../ui/comparison.tsx';
import { ElementFrame, PlotFrame } from '../../../ui/plot-frame.tsx';
import { compared, keptView } from '../compare/compare.ts';
import { explanation } from '../detections/process.ts';
import { captureState, update } from '../state.ts';

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

/** Power at the cell's Doppler bin, and its threshold. */
const BIN_STYLE: SeriesStyle = { color: { light: '#00896a', dark: '#2fcf9f' } };
const THRESHOLD_STYLE: SeriesStyle = { color: { light: '#b3261e', dark: '#ff8a80' }, dash: [6, 3] };

/** The explanation of this cell, once it is known. */
const toldOf = ({ rangeBin, dopplerBin }: Cell): CellExplanation | null => {
  const told = explanation.value;
  return told?.rangeBin === rangeBin && told.dopplerBin === dopplerBin ? told : null;
};

const RANGE_AXIS = { label: 'Range (m)' };

export function RangeProfile({ view, cell, board, label, fileParts }: Props) {
  const a = keptView.value;
  const { dopplerBin } = cell;
  const known = explanation.value;
  const threshold = known?.dopplerBin === dopplerBin && known.profileThresholdDb.length === view.rangeM.length;
  const thresholdDb = threshold ? known.profileThresholdDb : null;
  const binDb = useMemo(
    () => view.rangeM.map((_, range) => view.rangeDopplerDb[range * view.rateMps.length + dopplerBin] ?? Number.NaN),
    [view, dopplerBin],
  );
  const extentY = useMemo((): [number, number] => {
    let low = Number.POSITIVE_INFINITY;
    let high = Number.NEGATIVE_INFINITY;
    for (const value of [...view.rangeProfileDb, ...binDb, ...(thresholdDb ?? []), ...(a?.rangeProfileDb ?? [])]) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return Number.isFinite(low) ? [Math.floor(low / 10) * 10, Math.ceil((high + 4) / 10) * 10] : [-100, 0];
  }, [view, a, binDb, thresholdDb]);
  const extentX = useMemo(() => cellExtent(view.rangeM), [view]);
  const content = useMemo(
    () => ({
      x: view.rangeM,
      series: [{ id: 'profile', label: 'Profile', y: view.rangeProfileDb, style: { color: ACCENT_STYLE.color } }],
      extent: { x: extentX, y: extentY },
      above: [
        ...(a ? [polyline(a.rangeM, a.rangeProfileDb, FAINT)] : []),
        polyline(view.rangeM, binDb, BIN_STYLE),
        ...(thresholdDb ? [polyline(view.rangeM, thresholdDb, THRESHOLD_STYLE)] : []),
        verticalLines([{ x: view.rangeM[cell.rangeBin] ?? Number.NaN }]),
        verticalLines(
          board.map(({ rangeM }) => ({ x: rangeM })),
          { dash: [2, 4], color: (t) => t.muted },
        ),
        detectionTicks(view),
      ],
    }),
    [view, board, a, binDb, thresholdDb, cell.rangeBin],
  );
  const rate = `${signed(view.rateMps[dopplerBin] ?? Number.NaN, 2)} m/s`;
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
      legend={[
        { id: 'b', label: a ? 'B' : 'All rates', style: { color: ACCENT_STYLE.color }, line: true },
        ...(a ? [{ id: 'a', label: 'A', style: FAINT, line: true }] : []),
        { id: 'bin', label: `At ${rate}`, style: BIN_STYLE, line: true },
        ...(thresholdDb ? [{ id: 'threshold', label: 'Its threshold', style: THRESHOLD_STYLE, line: true }] : []),
      ]}
      axes={{ x: RANGE_AXIS, y: { label: 'Power (dBFS)' }, right: COLOR_BAR_WIDTH }}
      cursorKey="range"
      onView={(next, zoomed) => {
        rangeZoom.value = zoomed ? next.x : null;
      }}
      onClick={({ index }) => {
        if (index !== null) update({ cell: { rangeBin: index, dopplerBin: cell.dopplerBin } });
      }}
      readout={({ x, index }) =>
        `Range ${fixed(x, 3)} m   Power ${fixed(view.rangeProfileDb[index ?? -1] ?? Number.NaN, 1)} dBFS   at ${rate} ${fixed(binDb[index ?? -1] ?? Number.NaN, 1)}${thresholdDb ? `, threshold ${fixed(thresholdDb[index ?? -1] ?? Number.NaN, 1)}` : ''} dBFS`
      }
      csv={() =>
        toCsv(
          ['range_m', 'power_dbfs', 'bin_power_dbfs', 'bin_threshold_dbfs'],
          Array.from(view.rangeM, (range, i) => [range, view.rangeProfileDb[i], binDb[i], thresholdDb?.[i]]),
        )
      }
      fileParts={fileParts}
      remarks={[
        `${label}. Triangles: detections; dotted lines: ranges the board reported; vertical line: the chosen cell.`,
      ]}
    />
  );
}

/** What would make it otherwise. */
const CONTROLS: Readonly<Record<CellExplanation['verdict'], string>> = {
  'below-threshold':
    'A higher false-alarm rate lowers the threshold; the kind of threshold and its training cells move it.',
  grouped: 'Without “Keep local peaks only” it is a detection of its own.',
  'outside-range':
    '“From range” and “To range” keep it out; without them, ranges next to the antennas and at the end of the band.',
  'other-band': 'The waveform decides how many bands there are.',
  'outside-rate': '“Remove static clutter” and the Doppler window bear on rates.',
  'beyond-limit': 'A lower false-alarm rate leaves fewer.',
  'without-angle': '“Angle by” chooses the method.',
  'outside-direction': '“Sector ±” or a limit of elevation or height keeps it out.',
  kept: '',
};

/** Why the chosen cell is a detection or none. */
export function CellWhy({ view, cell }: Pick<Props, 'view' | 'cell'>) {
  const told = toldOf(cell);
  const place = `${fixed(view.rangeM[cell.rangeBin] ?? Number.NaN, 2)} m, ${signed(view.rateMps[cell.dopplerBin] ?? Number.NaN, 2)} m/s`;
  return (
    <p class="remark" role="status" data-cell-verdict={told?.verdict}>
      <b>Cell at {place}.</b> {told ? `${told.message} ${CONTROLS[told.verdict]}` : ''}
    </p>
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
