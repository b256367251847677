/**
 * Monte-Carlo runs: the scene of the page drawn many times at each of some values of one setting, and how far off each
 * method is on the mean, beside the bound. On workers, method by method, quick ones first.
 */
import { batch, computed, signal } from '@preact/signals';
import type { BatchEstimate, Method, SnapshotResult, Source } from 'boresight';
import { aborted, api, describeError, type Problem, pool } from '../../data.ts';
import { quickestFirst } from '../../methods.ts';
import { load } from '../../networks/load.ts';
import { assign } from './assign.ts';
import { boundOf, estimatorOptions, networkFor, simulationOf, whyNot } from './compute.ts';
import { type AngleState, angleState, arrayInput, LIMITS, type SWEPT } from './state.ts';

export type Swept = (typeof SWEPT)[number];

export interface Score {
  /** Root mean square error of azimuths found within a beam width, degrees. */
  rmseDeg: number;
  /** Of all targets of all runs. */
  found: number;
}

export interface Sweep {
  state: AngleState;
  swept: Swept;
  /** Values of the setting, ascending. */
  values: number[];
  /** Root mean square over targets and runs of the standard deviation at best, degrees. */
  boundDeg: number[];
  /** By value. */
  scores: ReadonlyMap<Method, readonly Score[]>;
  gateDeg: number;
}

const made = signal<Sweep | null>(null);

/** Everything that runs depend on, as text; a curve of each method stands by itself. */
const inputsOf = ({ methods: _, a: __, ...state }: AngleState): string => JSON.stringify(state);
const inputs = computed(() => inputsOf(angleState.value));
const ofPresent = computed(() => made.value !== null && inputsOf(made.value.state) === inputs.value);

/** The runs of the present settings; runs of others are not shown. */
export const sweep = computed(() => (ofPresent.value ? made.value : null));
/** Whether there are runs of other settings only. */
export const sweepIsOld = computed(() => made.value !== null && !ofPresent.value);
export const sweepProblem = signal<Problem | null>(null);
export const sweepProgress = signal<{ share: number; what: string } | null>(null);
export const sweepCancelled = signal(false);

export const UNITS: Readonly<Record<Swept, { title: string; unit: string }>> = {
  snr: { title: 'SNR', unit: 'dB' },
  separation: { title: 'Separation', unit: '°' },
  snapshots: { title: 'Snapshots', unit: '' },
};

const POINTS = 11;
/** Complex numbers drawn at a time: what a worker holds besides. */
const MOST_NUMBERS = 2 ** 21;
/** Bounds vary little from draw to draw. */
const MOST_BOUNDS = 40;

/** Where a sweep begins and ends: as asked, else what is worth seeing of the array. */
export function limitsOf({ sweep: swept, from, to, array }: AngleState): [from: number, to: number] {
  const { resolutionDeg } = api.array(arrayInput(array));
  const usual: Record<Swept, [number, number]> = {
    snr: [-10, 30],
    separation: [Number((resolutionDeg / 10).toPrecision(1)), Math.ceil(resolutionDeg * 1.5)],
    snapshots: [1, 1000],
  };
  return [from ?? usual[swept][0], to ?? usual[swept][1]];
}

/** Why there is nothing to sweep, in words. */
export function whyNoSweep(state: AngleState): string | null {
  const { sweep: swept, targets } = state;
  const [from, to] = limitsOf(state);
  if (targets.length === 0) return 'There is no target to be off from.';
  if (swept === 'separation' && targets.length < 2) return 'A separation takes two targets.';
  if (!(from < to)) return `The sweep must end above ${from}, where it begins.`;
  if (swept === 'snapshots' && from < 1) return 'There is at least one snapshot.';
  if (swept === 'separation' && from <= 0) return 'A separation is more than zero.';
  if (swept === 'snr' && to > 60) return 'SNRs are from −30 to 60 dB.';
  return null;
}

function valuesOf(state: AngleState): number[] {
  const [from, to] = limitsOf(state);
  const shares = Array.from({ length: POINTS }, (_, i) => i / (POINTS - 1));
  if (state.sweep === 'snapshots') {
    return [...new Set(shares.map((share) => Math.round(from * (to / from) ** share)))];
  }
  return shares.map((share) => from + share * (to - from));
}

/** The state at a value of what is varied: a separation is that of the first two targets, about their middle. */
function stateAt(state: AngleState, value: number): AngleState {
  if (state.sweep === 'snr') return { ...state, snr: value };
  if (state.sweep === 'snapshots') return { ...state, snapshots: value };
  const [a = 0, b = 0] = state.targets.map(({ azimuthDeg }) => azimuthDeg);
  const sign = a <= b ? 1 : -1;
  const [low, high] = LIMITS.azimuthDeg;
  const within = (azimuthDeg: number): number => Math.min(Math.max(azimuthDeg, low), high);
  const targets = state.targets.map((target, i) =>
    i < 2 ? { ...target, azimuthDeg: within((a + b) / 2 + (i === 0 ? -1 : 1) * sign * (value / 2)) } : target,
  );
  return { ...state, targets };
}

let running: AbortController | undefined;

export function cancelSweep(): void {
  running?.abort();
}

export async function runSweep(state: AngleState): Promise<void> {
  running?.abort();
  const controller = new AbortController();
  running = controller;
  const { signal: stop } = controller;
  const current = (): boolean => running === controller;
  batch(() => {
    sweepProblem.value = null;
    sweepCancelled.value = false;
    sweepProgress.value = { share: 0, what: 'Drawing scenes' };
  });
  try {
    const geometry = api.array(arrayInput(state.array));
    const values = valuesOf(state);
    const methods = quickestFirst(state.methods)
      .flatMap((name) => api.methods().filter((info) => info.name === name))
      .filter((info) => values.some((value) => whyNot(info, geometry, stateAt(state, value)) === null));
    const planned: Sweep = {
      state,
      swept: state.sweep,
      values,
      boundDeg: [],
      scores: new Map(),
      gateDeg: Math.max(geometry.resolutionDeg, 1),
    };
    const total = values.length * (methods.length + 1);
    let done = 0;
    const scores = new Map<Method, Score[]>(methods.map(({ name }) => [name, []]));
    for (const value of values) {
      const at = stateAt(state, value);
      const say = (what: string, part: number): void => {
        if (current()) sweepProgress.value = { share: (done + part) / total, what };
      };
      const place = `${UNITS[state.sweep].title} ${Number(value.toPrecision(3))}`;
      say(`${place}: drawing`, 0);
      const drawn = await draw(at, stop);
      planned.boundDeg.push(meanBound(at, drawn));
      done += 1;
      for (const info of methods) {
        const suits = whyNot(info, geometry, at) === null;
        const score = suits
          ? await scoreOf(info.name, at, drawn, planned.gateDeg, stop, (part) => say(`${place}: ${info.title}`, part))
          : { rmseDeg: Number.NaN, found: Number.NaN };
        scores.get(info.name)?.push(score);
        done += 1;
      }
      if (!current()) return;
      // What is there already is shown.
      made.value = {
        ...planned,
        values: values.slice(0, planned.boundDeg.length),
        boundDeg: [...planned.boundDeg],
        scores: new Map([...scores].map(([name, list]) => [name, [...list]])),
      };
    }
  } catch (error) {
    if (!current()) return;
    if (aborted(error)) sweepCancelled.value = true;
    else sweepProblem.value = describeError(error);
  } finally {
    if (current()) {
      running = undefined;
      sweepProgress.value = null;
    }
  }
}

/** All scenes of a value, in parts that fit into memory. */
async function draw(state: AngleState, stop: AbortSignal): Promise<SnapshotResult[]> {
  const { positions } = api.array(arrayInput(state.array));
  const most = Math.max(Math.floor(MOST_NUMBERS / (positions.length * state.snapshots)), 1);
  const parts: SnapshotResult[] = [];
  for (let first = 0; first < state.runs; first += most) {
    const scenes = Math.min(most, state.runs - first);
    // Scenes of a call are drawn from its seed one after the other; another call takes another seed.
    const options = { ...simulationOf(state), scenes, seed: state.seed + parts.length };
    parts.push(await pool().simulateSnapshots(options, { signal: stop }));
  }
  return parts;
}

function meanBound(state: AngleState, drawn: readonly SnapshotResult[]): number {
  const some = drawn.flatMap(({ truth }) => truth).slice(0, MOST_BOUNDS);
  const squares = some.flatMap((truth) => {
    try {
      return [...boundOf(state, truth)].map((sigma) => sigma ** 2);
    } catch {
      return [Number.NaN];
    }
  });
  return Math.sqrt(squares.reduce((sum, square) => sum + square, 0) / squares.length);
}

async function scoreOf(
  method: Method,
  state: AngleState,
  drawn: readonly SnapshotResult[],
  gateDeg: number,
  stop: AbortSignal,
  report: (share: number) => void,
): Promise<Score> {
  const model = networkFor(method, api.array(arrayInput(state.array)), state);
  const network = model && (await load(model.name, stop)).id;
  const options = { ...estimatorOptions(method, state), ...(network ? { network } : {}) };
  const targets = state.targets.map(({ azimuthDeg }) => azimuthDeg);
  let [squares, found, runs] = [0, 0, 0];
  for (const [k, { data, shape }] of drawn.entries()) {
    const estimate = await pool().estimateBatch({ snapshots: { data, shape } }, options, {
      signal: stop,
      onProgress: (done, total) => report((k + done / Math.max(total, 1)) / drawn.length),
    });
    for (const sources of sourcesByCell(estimate)) {
      assign(targets, sources, gateDeg).matched.forEach((at, i) => {
        if (at === undefined) return;
        found += 1;
        squares += ((sources[at]?.azimuthDeg ?? 0) - (targets[i] ?? 0)) ** 2;
      });
    }
    runs += shape[0];
  }
  return { rmseDeg: Math.sqrt(squares / found), found: found / (runs * targets.length) };
}

function sourcesByCell({ cells, cell, azimuthDeg, powerDb, elevationDeg }: BatchEstimate): Source[][] {
  const all: Source[][] = Array.from({ length: cells }, () => []);
  cell.forEach((at, i) => {
    all[at]?.push({
      azimuthDeg: azimuthDeg[i] as number,
      elevationDeg: elevationDeg[i] as number,
      powerDb: powerDb[i] as number,
    });
  });
  return all;
}
