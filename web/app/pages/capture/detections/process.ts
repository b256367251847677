/**
 * Processing of the open capture on workers: all frames when files or options change, the chosen cell when it moves.
 */
import { batch, computed, effect, signal } from '@preact/signals';
import type { AngleOptions, Cell, CellExplanation, ChainOptions, Estimate, FrameResult, Method } from 'boresight';
import { aborted, api, describeError, type Problem } from '../../../data.ts';
import { whyUnsuited } from '../../../methods.ts';
import { modelFor, whyNoNetwork } from '../../../networks/choose.ts';
import { load, readyNetworks } from '../../../networks/load.ts';
import type { Model } from '../../../networks/models.ts';
import { type Loaded, loaded } from '../files/files.ts';
import { estimateCell, explainCell, runChain } from '../files/source.ts';
import { shownCell } from '../plots/view.ts';
import { type CaptureState, captureState, cellAngle, chainOptions, settingsOf, sourceOption } from '../state.ts';

export interface CellResult {
  /** Capture, frame, cell and options of the estimate, as text. */
  inputs: string;
  /** Absent until it is computed. */
  estimate?: Estimate;
  problem?: Problem;
}

/** Whether a method is still computing. */
export const isPending = ({ estimate, problem }: CellResult): boolean => !estimate && !problem;

/** A result with what it is of. */
export interface Shown {
  capture: Loaded;
  /** Options of the chain, as text. */
  chain: string;
  /** Settings in words. */
  settings: string;
  /** One frame, or all of them combined. */
  frame: number | 'all';
  view: FrameResult;
}

/** What is shown: always of the open capture; gone when work on it was cancelled or failed. */
export const result = signal<Shown | null>(null);
/** Whether what is shown is about to be replaced. */
export const working = signal(false);
export const progress = signal<{ done: number; total: number } | null>(null);
export const wasCancelled = signal<{ done: number; total: number } | null>(null);
export const processProblem = signal<Problem | null>(null);
export const cellResults = signal<ReadonlyMap<Method, CellResult>>(new Map());
/** Why the chosen cell is a detection or none; null until that is known. */
export const explanation = signal<CellExplanation | null>(null);

/** Options as text: effects that depend on them run when they change, not with every cell. */
const options = computed(() => JSON.stringify(chainOptions(captureState.value)));
/** The same of what the cell's angles depend on beside it. */
const cellOptions = computed(() => JSON.stringify(cellAngle(captureState.value)));
const attempts = signal(0);

/** The same with the network its method needs, which is loaded first. */
export async function withNetwork(angle: AngleOptions, state = captureState.value): Promise<AngleOptions> {
  const model = angle.method && networkFor(angle.method, state);
  return model ? { ...angle, network: (await load(model.name)).id } : angle;
}

/** The network that a method would use on this capture. */
export function networkFor(method: Method, state = captureState.value): Model | undefined {
  const geometry = arrayOf(state);
  const sources = sourceOption(state);
  return geometry
    ? modelFor(method, [geometry], typeof sources === 'number' ? sources : null, state.networks)
    : undefined;
}

/** The configuration's array, or the one chosen; null where the platform is not known. */
const arrayOf = ({ array }: CaptureState) => (array === 'auto' ? (loaded.value?.info.array ?? null) : api.array(array));

/** That of the present settings. */
export const usedArray = computed(() => arrayOf(captureState.value));

/** Whether detections have elevations. */
export const seesElevation = (): boolean => {
  const extent = usedArray.value?.extent;
  return extent === 'area' || extent === 'line';
};

/** Methods that cannot work on a cell of this capture, with the reason. */
export const cellUnavailable = computed<ReadonlyMap<Method, string>>(() => {
  const reasons = new Map<Method, string>();
  const geometry = usedArray.value;
  const snapshots = cellSnapshots.value;
  if (!geometry) return reasons;
  for (const info of api.methods()) {
    const problem = info.network ? whyNoNetwork(info.name, [geometry]) : null;
    if (problem) reasons.set(info.name, problem);
    else {
      const reason = whyUnsuited({ method: info.name, array: { positions: geometry.positions } }, snapshots, {
        'few-snapshots': 'needs more snapshots: combine frames',
        'many-snapshots': 'takes a single snapshot: choose one frame',
      });
      if (reason) reasons.set(info.name, reason);
    }
  }
  return reasons;
});

/** One a frame: the cell's value at each element. */
const cellSnapshots = computed(() => (captureState.value.frame === 'all' ? (loaded.value?.info.frames ?? 1) : 1));

let running: AbortController | undefined;

export function cancel(): void {
  running?.abort();
}

export function restart(): void {
  attempts.value += 1;
}

/** Results of the open capture under the present options, by frame. */
const known = new Map<number | 'all', Shown>();
let knownFor = '';
let captures = 0;
const numbers = new WeakMap<Loaded, number>();

/** Which capture and options a result belongs to. */
function keyOf(capture: Loaded, chain: string): string {
  if (!numbers.has(capture)) numbers.set(capture, captures++);
  return `${numbers.get(capture)} ${chain}`;
}

/** Results hold their capture, and with it all of its samples. */
function forgetResults(): void {
  known.clear();
  knownFor = '';
}

/** The frame that is shown, kept within the capture. */
export function shownFrame(capture: Loaded, { frame } = captureState.value): number | 'all' {
  return frame === 'all' ? 'all' : Math.min(frame, capture.info.frames - 1);
}

export function start(): () => void {
  const frame = computed(() => (loaded.value ? shownFrame(loaded.value) : 'all'));
  const stops = [
    effect(() => {
      void attempts.value;
      const capture = loaded.value;
      const chain = options.value;
      const wanted = frame.value;
      if (capture) void processFrame(capture, chain, wanted);
      else {
        forgetResults();
        close();
      }
    }),
    effect(() => {
      const shown = result.value;
      const { cell, methods } = captureState.value;
      void cellOptions.value;
      void captureState.value.networks;
      void readyNetworks.value;
      if (shown) scheduleCell(shown, shownCell(shown.view, cell), methods);
      else forgetCell();
    }),
  ];
  return () => {
    running?.abort();
    clearTimeout(cellTimer);
    for (const stop of stops) stop();
  };
}

/** Nothing is open. */
function close(): void {
  running?.abort();
  running = undefined;
  batch(() => {
    result.value = null;
    progress.value = null;
    wasCancelled.value = null;
    processProblem.value = null;
    working.value = false;
  });
}

async function processFrame(capture: Loaded, chain: string, frame: number | 'all'): Promise<void> {
  running?.abort();
  const key = keyOf(capture, chain);
  if (key !== knownFor) {
    forgetResults();
    knownFor = key;
  }
  if (result.peek()?.capture !== capture) close();
  wasCancelled.value = null;
  const before = known.get(frame);
  if (before) {
    running = undefined;
    batch(() => {
      progress.value = null;
      processProblem.value = null;
      working.value = false;
      result.value = before;
    });
    return;
  }
  const controller = new AbortController();
  running = controller;
  working.value = true;
  const settings = settingsOf(captureState.peek());
  let last = { done: 0, total: frame === 'all' ? capture.info.frames : 1 };
  // A bar that only flashes tells nothing.
  const timer = setTimeout(() => {
    if (running === controller) progress.value = last;
  }, 120);
  const onProgress = (done: number, total: number): void => {
    last = { done, total };
    if (running === controller && progress.peek()) progress.value = last;
  };
  try {
    const options = JSON.parse(chain) as ChainOptions;
    const angle = await withNetwork(options.angle ?? {});
    if (running !== controller) return;
    const view = await runChain(capture, { ...options, angle }, frame, { signal: controller.signal, onProgress });
    if (running !== controller) return;
    const made = { capture, chain, settings, frame, view };
    known.set(frame, made);
    batch(() => {
      processProblem.value = null;
      result.value = made;
    });
  } catch (error) {
    if (running !== controller) return;
    batch(() => {
      result.value = null;
      if (aborted(error)) wasCancelled.value = last;
      else processProblem.value = describeError(error);
    });
  } finally {
    clearTimeout(timer);
    if (running === controller) {
      running = undefined;
      batch(() => {
        progress.value = null;
        working.value = false;
      });
    }
  }
}

let cellTimer: ReturnType<typeof setTimeout> | undefined;
let cellJob: AbortController | undefined;
/** The capture, frame and cell of the explanation, as text. */
let explained = '';

function forgetCell(): void {
  clearTimeout(cellTimer);
  cellJob?.abort();
  cellJob = undefined;
  explained = '';
  batch(() => {
    cellResults.value = new Map();
    explanation.value = null;
  });
}

/** Cells come quickly while arrows are held down; estimates follow when they settle. */
function scheduleCell(shown: Shown, cell: Cell, methods: readonly Method[]): void {
  clearTimeout(cellTimer);
  cellJob?.abort();
  const controller = new AbortController();
  cellJob = controller;
  const wanted = methods.filter((method) => !cellUnavailable.peek().has(method));
  const before = cellResults.peek();
  const place = JSON.stringify([keyOf(shown.capture, shown.chain), shown.frame, cell]);
  const next = new Map(
    wanted.map((method): [Method, CellResult] => {
      const inputs = JSON.stringify([place, cellOptions.peek(), networkFor(method)?.name ?? null]);
      const known = before.get(method);
      return [method, known?.inputs === inputs && known.estimate ? known : { inputs }];
    }),
  );
  batch(() => {
    if (explained !== place) explanation.value = null;
    cellResults.value = next;
  });
  cellTimer = setTimeout(() => {
    if (explained !== place) void explainOne(shown, cell, place, controller);
    for (const [method, result] of next)
      if (isPending(result)) void estimateOne(shown, cell, method, result.inputs, controller);
  }, 40);
}

async function explainOne(
  { capture, chain, frame }: Shown,
  cell: Cell,
  place: string,
  controller: AbortController,
): Promise<void> {
  let told: CellExplanation | null = null;
  try {
    told = await explainCell(capture, JSON.parse(chain) as ChainOptions, frame, cell, { signal: controller.signal });
  } catch {
    // What is wrong with the chain's options is said above the plots.
  }
  if (cellJob !== controller) return;
  explained = place;
  explanation.value = told;
}

async function estimateOne(
  { capture, chain, frame }: Shown,
  cell: Cell,
  method: Method,
  inputs: string,
  controller: AbortController,
): Promise<void> {
  let made: CellResult;
  try {
    const angle = await withNetwork({ ...(JSON.parse(cellOptions.peek()) as AngleOptions), method });
    if (cellJob !== controller) return;
    const estimate = await estimateCell(capture, JSON.parse(chain) as ChainOptions, frame, cell, angle, {
      signal: controller.signal,
    });
    made = { inputs, estimate };
  } catch (error) {
    if (controller.signal.aborted) return;
    made = { inputs, problem: describeError(error) };
  }
  if (cellJob === controller) cellResults.value = new Map(cellResults.peek()).set(method, made);
}
