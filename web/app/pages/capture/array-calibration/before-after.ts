/** The chosen cell without and with the calibration, on frames it was made from and on others. */
import { batch, computed, effect, signal } from '@preact/signals';
import type { ArrayCalibration, Cell, ChainOptions, ComplexData, Estimate } from 'boresight';
import { peakSidelobeDb } from '../../../../plots/spectra.ts';
import { aborted, api, describeError, type Problem } from '../../../data.ts';
import { result, type Shown, usedArray } from '../detections/process.ts';
import { shownCell } from '../plots/view.ts';
import { captureState, chainOptions } from '../state.ts';
import { type Frames, made } from './calibrate.ts';
import { inEffect } from './in-effect.ts';

/** What the cell is seen as. */
export interface Side {
  beam: Estimate;
  /** Highest sidelobe of the beam over its peak; null where it has none. */
  sidelobeDb: number | null;
  /** Targets by Newtonized orthogonal matching pursuit, strongest first. */
  targetsDeg: readonly number[];
  /** Targets by minimum description length. */
  count: number;
}

export type FrameSet = 'used' | 'others' | 'all';

export interface BeforeAfter {
  cell: Cell;
  sets: readonly { frames: FrameSet; count: number; before: Side; after: Side }[];
}

export const beforeAfter = signal<BeforeAfter | null>(null);
export const beforeAfterProblem = signal<Problem | null>(null);
export const beforeAfterWorking = signal(false);

const options = computed(() => {
  const { calibration: _, ...chain } = chainOptions(captureState.value);
  return JSON.stringify(chain);
});

/** Of what was made here, its frames; of other calibrations none are known. */
const frames = computed<Frames | null>(() => {
  const own = made.value;
  return own && captureState.value.calibration === `own:${own.id}` ? own.frames : null;
});

/** Least array error that estimators take. */
const LEAST_DB = -100;

/** Cells come quickly while arrows are held down. */
const SETTLED_MS = 60;

export function startBeforeAfter(): () => void {
  let running: AbortController | undefined;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const cell = computed(() => {
    const shown = result.value;
    return shown && JSON.stringify(shownCell(shown.view, captureState.value.cell));
  });
  const stop = effect(() => {
    const shown = result.value;
    const calibration = inEffect.value;
    const [at, chain, split] = [cell.value, options.value, frames.value];
    running?.abort();
    clearTimeout(timer);
    if (!shown || !at || !calibration) {
      batch(() => {
        beforeAfter.value = null;
        beforeAfterProblem.value = null;
        beforeAfterWorking.value = false;
      });
      return;
    }
    const mine = new AbortController();
    running = mine;
    beforeAfterWorking.value = true;
    timer = setTimeout(() => {
      const job = { cell: JSON.parse(at) as Cell, chain: JSON.parse(chain) as ChainOptions, calibration, split };
      seen(shown, job, mine.signal).then(
        (both) => {
          if (running !== mine) return;
          batch(() => {
            beforeAfter.value = both;
            beforeAfterProblem.value = null;
            beforeAfterWorking.value = false;
          });
        },
        (error: unknown) => {
          if (running !== mine || aborted(error)) return;
          batch(() => {
            beforeAfter.value = null;
            beforeAfterProblem.value = describeError(error);
            beforeAfterWorking.value = false;
          });
        },
      );
    }, SETTLED_MS);
  });
  return () => {
    running?.abort();
    clearTimeout(timer);
    stop();
  };
}

async function seen(
  { capture }: Shown,
  {
    cell,
    chain,
    calibration,
    split,
  }: { cell: Cell; chain: ChainOptions; calibration: ArrayCalibration; split: Frames | null },
  signal: AbortSignal,
): Promise<BeforeAfter> {
  const of = (how: ArrayCalibration | 'none'): Promise<ComplexData> =>
    capture.kept.cellSnapshots(cell, { ...chain, calibration: how }, { signal });
  const [plain, corrected] = await Promise.all([of('none'), of(calibration)]);
  const { tx = [], rx = [] } = usedArray.peek() ?? {};
  const array = { tx, rx };
  // What a calibration leaves of a target is no other target.
  const chosen = captureState.peek().mismatch ?? undefined;
  const sets: readonly (readonly [FrameSet, readonly number[] | null])[] = split
    ? [['used', split.used], ...(split.others.length ? ([['others', split.others]] as const) : [])]
    : [['all', null]];
  return {
    cell,
    sets: sets.map(([name, numbers]) => {
      const [raw, right] = [plain, corrected].map((all) => (numbers ? columns(all, numbers) : all)) as [
        ComplexData,
        ComplexData,
      ];
      return {
        frames: name,
        count: raw.shape[1] ?? 1,
        before: side(raw, raw, { array }, chosen),
        after: side(raw, right, { array, calibration }, chosen ?? leftBy(calibration)),
      };
    }),
  };
}

/** What a calibration leaves of a target, as estimators take it. */
const leftBy = ({ residualDb }: ArrayCalibration): number | undefined =>
  residualDb === undefined ? undefined : Math.min(Math.max(residualDb, LEAST_DB), 0);

type Known = Pick<Parameters<typeof api.estimate>[1], 'array' | 'calibration'>;

/** Of snapshots as they are, and as the calibration makes them. */
function side(raw: ComplexData, right: ComplexData, known: Known, mismatch: number | undefined): Side {
  const mismatchDb = mismatch === undefined ? {} : { mismatchDb: mismatch };
  const beam = api.estimate({ snapshots: raw }, { ...known, method: 'bartlett', sources: 1 });
  const { sources } = api.estimate({ snapshots: raw }, { ...known, method: 'nomp', ...mismatchDb });
  return {
    beam,
    sidelobeDb: peakSidelobeDb(beam),
    targetsDeg: sources.map(({ azimuthDeg }) => azimuthDeg),
    count: api.countSources({ snapshots: right }, { criterion: 'mdl', ...mismatchDb }).count,
  };
}

/** Some snapshots of elements x snapshots. */
function columns({ data, shape }: ComplexData, which: readonly number[]): ComplexData {
  const [elements = 0, snapshots = 1] = shape;
  const part = new Float64Array(2 * elements * which.length);
  for (let element = 0; element < elements; element++)
    which.forEach((column, at) => {
      const from = 2 * (element * snapshots + column);
      part.set([data[from] ?? 0, data[from + 1] ?? 0], 2 * (element * which.length + at));
    });
  return { data: part, shape: [elements, which.length] };
}
