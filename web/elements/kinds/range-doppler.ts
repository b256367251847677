import type { Cell, Detection, FrameResult } from 'boresight';
import { fixed, signed } from '../../plots/format.ts';
import { COLOR_BAR_WIDTH, cellExtent, colorBar, heatImage, nearestCell } from '../../plots/heat.ts';
import type { Layer } from '../../plots/layers.ts';
import { chosenCell, detectionBoxes } from '../../plots/range-doppler.ts';
import { toCsv } from '../../plots/save.ts';
import { TRUTH_STYLE } from '../../plots/theme.ts';
import type { CursorPosition } from '../../plots/types.ts';
import type { Drawing } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';
import { COLOR_ATTRIBUTES, colorsOf, limitsOf } from './map.ts';

/** What a range-Doppler map is drawn from: a frame as a capture gives it, or one's own. */
export type RangeDopplerFrame = Pick<FrameResult, 'rangeM' | 'rateMps' | 'rangeDopplerDb'> & {
  detections?: readonly Pick<Detection, 'rangeM' | 'rateMps'>[];
};

const DETECTION = { ...TRUTH_STYLE, marker: 'square' as const };

/**
 * Power over range and range rate, with what was detected.
 *
 * @element boresight-range-doppler
 * @attr {'viridis' | 'cividis' | 'magma'} colors - of the map
 * @attr {number} high-db - level of the last colour; the highest there is, rounded up to 5 dB, by default
 * @attr {number} low-db - level of the first colour
 * @attr {boolean} selectable - clicks and arrows choose a cell, N and P go through the detections, Home chooses none
 * @attr {number} span-db - how far the first colour is below the last (60)
 * @fires boresight-cell - a cell was chosen (`detail`: rangeBin, dopplerBin) or none (`detail`: null), where `selectable`
 */
export class RangeDopplerElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, ...COLOR_ATTRIBUTES, 'selectable'];
  }

  #frame: RangeDopplerFrame | null = null;
  #cell: Cell | null = null;
  /** The map in the colours of `key`, which takes time. */
  #heat: { key: string; layer: Layer } | null = null;

  /** The frame shown; another one, or the same after its numbers changed, is drawn when it is set. */
  get frame(): RangeDopplerFrame | null {
    return this.#frame;
  }

  set frame(given: RangeDopplerFrame | null) {
    this.#frame = given || null;
    this.#heat = null;
    this.changed();
  }

  /** The cell that a crosshair marks. */
  get cell(): Cell | null {
    return this.#cell;
  }

  set cell(given: Cell | null) {
    this.#cell = given || null;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    const y = { label: 'Range rate (m/s), + receding' };
    return { x: { label: 'Range (m)' }, y, right: COLOR_BAR_WIDTH, grid: false };
  }

  /** @internal */
  protected override keyHelp(): string {
    return this.hasAttribute('selectable')
      ? 'Arrows choose a cell, with Shift by ten; N and P go through the detections; Home takes the strongest.'
      : '';
  }

  /** @internal */
  protected override pick({ x, y }: CursorPosition): void {
    const frame = this.#frame;
    if (frame && this.hasAttribute('selectable'))
      this.#choose({ rangeBin: nearestCell(x, frame.rangeM), dopplerBin: nearestCell(y, frame.rateMps) });
  }

  /** @internal */
  protected override key({ key, shiftKey }: KeyboardEvent): boolean {
    const frame = this.#frame;
    if (!frame || !this.hasAttribute('selectable')) return false;
    const by = shiftKey ? 10 : 1;
    const { rangeBin, dopplerBin } = this.#cell ?? { rangeBin: 0, dopplerBin: frame.rateMps.length >> 1 };
    if (key === 'ArrowLeft') this.#choose({ rangeBin: rangeBin - by, dopplerBin });
    else if (key === 'ArrowRight') this.#choose({ rangeBin: rangeBin + by, dopplerBin });
    else if (key === 'ArrowUp') this.#choose({ rangeBin, dopplerBin: dopplerBin + by });
    else if (key === 'ArrowDown') this.#choose({ rangeBin, dopplerBin: dopplerBin - by });
    else if (key === 'n' || key === 'p') this.#step(key === 'n' ? 1 : -1);
    else if (key === 'Home') this.tell('boresight-cell', null);
    else return false;
    return true;
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const frame = this.#frame;
    if (!frame) return null;
    const { rangeM, rateMps, rangeDopplerDb, detections = [] } = frame;
    const colors = colorsOf(this.getAttribute('colors'));
    const limits = limitsOf(rangeDopplerDb, (name, absent) => this.numberOf(name, absent), 60);
    const key = JSON.stringify([limits, colors]);
    if (this.#heat?.key !== key)
      this.#heat = { key, layer: heatImage({ x: rangeM, y: rateMps, values: rangeDopplerDb, limits, colors }) };
    const at = this.#cell;
    const chosen = at && { x: rangeM[at.rangeBin] ?? 0, y: rateMps[at.dopplerBin] ?? 0 };
    return {
      content: {
        x: rangeM,
        series: [],
        below: [this.#heat.layer],
        above: [
          detectionBoxes(detections.map((one) => ({ x: one.rangeM, y: rateOnMap(one, frame) }))),
          ...(chosen ? [chosenCell(chosen.x, chosen.y)] : []),
          colorBar(limits, colors, 'dBFS'),
        ],
        extent: { x: cellExtent(rangeM), y: cellExtent(rateMps) },
      },
      legend: detections.length ? [{ label: 'Detection', style: DETECTION, line: false, hollow: true }] : [],
      alternative: [
        `${rangeM.length} ranges to ${fixed(rangeM[rangeM.length - 1] ?? 0, 1)} m, ${rateMps.length} range rates; levels from ${fixed(limits[0], 0)} to ${fixed(limits[1], 0)} dBFS.`,
        ...detections
          .slice(0, 10)
          .map(({ rangeM: range, rateMps: rate }) => `Detection at ${fixed(range, 2)} m, ${signed(rate, 2)} m/s.`),
      ].join('\n'),
      readout: ({ x, y }) => {
        const [range, doppler] = [nearestCell(x, rangeM), nearestCell(y, rateMps)];
        return `Range ${fixed(rangeM[range] ?? Number.NaN, 3)} m   Rate ${signed(rateMps[doppler] ?? Number.NaN, 3)} m/s   Power ${fixed(levelOf(frame, range, doppler), 1)} dBFS   bin ${range}, ${doppler}`;
      },
      csv: () =>
        toCsv(
          ['range_m', 'rate_mps', 'power_dbfs'],
          (function* rows() {
            for (let i = 0; i < rangeM.length; i++) {
              for (let j = 0; j < rateMps.length; j++) yield [rangeM[i], rateMps[j], levelOf(frame, i, j)];
            }
          })(),
        ),
    };
  }

  /** Marks a cell, and tells it. */
  #choose({ rangeBin, dopplerBin }: Cell): void {
    const frame = this.#frame;
    if (!frame) return;
    const { rangeM, rateMps } = frame;
    const within = (bin: number, count: number): number => Math.min(Math.max(bin, 0), count - 1);
    const cell = { rangeBin: within(rangeBin, rangeM.length), dopplerBin: within(dopplerBin, rateMps.length) };
    this.cell = cell;
    this.announce(
      `Range ${fixed(rangeM[cell.rangeBin] ?? 0, 2)} metres, rate ${signed(rateMps[cell.dopplerBin] ?? 0, 2)} metres per second, ${fixed(levelOf(frame, cell.rangeBin, cell.dopplerBin), 1)} dB.`,
    );
    this.tell('boresight-cell', cell);
  }

  /** Goes on among the detections, the strongest first. */
  #step(by: number): void {
    const frame = this.#frame;
    const level = ({ rangeBin, dopplerBin }: Cell): number => (frame ? levelOf(frame, rangeBin, dopplerBin) : 0);
    const cells = (frame?.detections ?? [])
      .map((one) => cellOf(one, frame as RangeDopplerFrame))
      .sort((a, b) => level(b) - level(a));
    const at = cells.findIndex(
      ({ rangeBin, dopplerBin }) => rangeBin === this.#cell?.rangeBin && dopplerBin === this.#cell?.dopplerBin,
    );
    const next = cells[(Math.max(at, by < 0 ? 0 : -1) + by + cells.length) % cells.length];
    if (next) this.#choose(next);
  }
}

const levelOf = ({ rangeDopplerDb, rateMps }: RangeDopplerFrame, range: number, doppler: number): number =>
  rangeDopplerDb[range * rateMps.length + doppler] ?? Number.NaN;

/**
 * Where a detection is on the axis of range rates. Rates beyond the axis appear folded by its span; a detection whose
 * cell lies elsewhere, in another band of a Doppler division, is marked at its cell.
 */
function rateOnMap(one: Pick<Detection, 'rangeM' | 'rateMps'> & Partial<Cell>, frame: RangeDopplerFrame): number {
  const { rateMps } = frame;
  const [first = 0, second = 0] = rateMps;
  const step = second - first;
  const cell = rateMps[cellOf(one, frame).dopplerBin] ?? one.rateMps;
  if (!(step > 0)) return cell;
  const span = step * rateMps.length;
  const folded = one.rateMps - span * Math.round((one.rateMps - cell) / span);
  return Math.abs(folded - cell) <= step ? folded : cell;
}

/** The cell of a detection: as it says, or the nearest. */
const cellOf = (
  { rangeM, rateMps, ...known }: Pick<Detection, 'rangeM' | 'rateMps'> & Partial<Cell>,
  frame: RangeDopplerFrame,
): Cell => ({
  rangeBin: known.rangeBin ?? nearestCell(rangeM, frame.rangeM),
  dopplerBin: known.dopplerBin ?? nearestCell(rateMps, frame.rateMps),
});
