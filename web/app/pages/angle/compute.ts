/**
 * Everything computed from the state: geometry, snapshots, bounds, and each method's estimate.
 * Quick methods run within the frame that shows them; slow ones on workers, latest state first.
 */
import { batch, computed, effect, signal } from '@preact/signals';
import type {
  ArrayGeometry,
  BoundOptions,
  Estimate,
  EstimatorOptions,
  Method,
  MethodInfo,
  SnapshotOptions,
  SnapshotResult,
} from 'boresight';
import { cut, highest } from '../../../plots/spectra.ts';
import { api, describeError, type Problem, pool } from '../../data.ts';
import { whyUnsuited } from '../../methods.ts';
import { modelFor, whyNoNetwork } from '../../networks/choose.ts';
import { load, readyNetworks } from '../../networks/load.ts';
import type { Model } from '../../networks/models.ts';
import { type AngleState, angleState, arrayInput } from './state.ts';

export interface MethodResult {
  /** Scene and options of the estimate, as text. */
  inputs: string;
  /** Absent until it is computed. */
  estimate?: Estimate;
  problem?: Problem;
  /** Of the estimate alone where it ran here; with the way to the worker and back where it ran there. */
  milliseconds?: number;
  where?: 'page' | 'worker';
}

/** Whether a method is still computing. */
export const isPending = ({ estimate, problem }: MethodResult): boolean => !estimate && !problem;

export interface Scene {
  state: AngleState;
  geometry: ArrayGeometry;
  snapshots: SnapshotResult;
  /** Standard deviation bound of each target, degrees; absent with the reason in `boundProblem`. */
  bound?: Float64Array;
  boundKind: 'deterministic' | 'stochastic';
  boundProblem?: Problem;
}

/** A scene with the results computed from it, and from no other. */
export interface Answers {
  scene: Scene;
  results: ReadonlyMap<Method, MethodResult>;
}

/** Scene and results are replaced together, so that no estimate meets the truth of another scene. */
export const answers = signal<Answers | null>(null);
export const scene = computed(() => answers.value?.scene ?? null);
export const results = computed<ReadonlyMap<Method, MethodResult>>(() => answers.value?.results ?? new Map());
export const sceneProblem = signal<Problem | null>(null);
export const unavailable = signal<ReadonlyMap<Method, string>>(new Map());

/** Above this a method moves to a worker; well below it, back. */
const FRAME_BUDGET_MS = 8;
/** What is left of the time on a worker without the way there and back, roughly, for short calls. */
const TRAVEL_SHARE = 0.5;
const SLOW_AT_FIRST: readonly Method[] = ['nomp', 'atomic-norm', 'maximum-likelihood', 'sparse-bayesian', 'iaa'];
/** One slow call proves nothing. */
const FEWEST_TIMES = 3;
const recent = new Map<Method, number[]>(
  SLOW_AT_FIRST.map((method) => [method, new Array<number>(FEWEST_TIMES).fill(FRAME_BUDGET_MS * 2)]),
);

export function start(): () => void {
  let frame = 0;
  const stop = effect(() => {
    void angleState.value;
    void readyNetworks.value;
    cancelAnimationFrame(frame);
    frame = requestAnimationFrame(() => recompute(angleState.peek()));
  });
  return () => {
    cancelAnimationFrame(frame);
    stop();
  };
}

/** Why a method cannot run here, in words; null where it can. */
export function whyNot(info: MethodInfo, geometry: ArrayGeometry, state: AngleState): string | null {
  const { snapshots } = state;
  const problem = info.network ? whyNoNetwork(info.name, [geometry]) : null;
  if (problem) return problem;
  const reason = whyUnsuited(arrayOptions(info.name, state), snapshots);
  if (reason) return reason;
  if (info.sourceCount && state.sources === 'known' && state.targets.length === 0) return 'needs at least one target';
  return null;
}

/** The number of sources that methods are told, or null where they count. */
const known = (state: AngleState): number | null => (state.sources === 'known' ? state.targets.length : null);

/** The network that a method of the present state would use. */
export function networkFor(method: Method, geometry: ArrayGeometry, state: AngleState): Model | undefined {
  return modelFor(method, [geometry], known(state), state.networks);
}

/** The options that say whether a method suits the array. */
function arrayOptions(method: Method, state: AngleState): EstimatorOptions {
  return {
    method,
    array: arrayInput(state.array),
    ...(state.average ? { forwardBackward: true } : {}),
    ...(state.smoothing === null ? {} : { smoothing: state.smoothing }),
  };
}

export function estimatorOptions(method: Method, state: AngleState): EstimatorOptions {
  return {
    ...arrayOptions(method, state),
    // Of noise alone there is a spectrum, too; methods that must be told of a source do not run.
    sources: state.sources === 'known' ? Math.max(state.targets.length, 1) : state.sources,
    gridPoints: state.grid,
    ...(state.refine ? { refine: true } : {}),
    ...(state.sources === 'known' ? { maxPeaks: Math.max(state.targets.length, 1) } : {}),
  };
}

function imperfections(state: AngleState) {
  const { gain, phase, position, coupling, seed } = state;
  if (!gain && !phase && !position && coupling === 'off') return {};
  return {
    imperfections: {
      gainDb: gain,
      phaseDeg: phase,
      position,
      seed,
      ...(coupling === 'off' ? {} : { couplingDb: Number(coupling) }),
    },
  };
}

/** One snapshot shows nothing of how powers fluctuate: its targets have the powers they are given, and drawn phases. */
function fluctuationOf({ snapshots, fluctuation }: AngleState): AngleState['fluctuation'] {
  return snapshots === 1 && fluctuation === 'complex-normal' ? 'random-phase' : fluctuation;
}

/** What the simulation is told of a state. */
export function simulationOf(state: AngleState): SnapshotOptions {
  return {
    array: arrayInput(state.array),
    targets: state.targets,
    snrDb: state.snr,
    snapshots: state.snapshots,
    fluctuation: fluctuationOf(state),
    seed: state.seed,
    ...imperfections(state),
  };
}

function simulate(state: AngleState): Scene {
  const geometry = api.array(arrayInput(state.array));
  const snapshots = api.simulateSnapshots(simulationOf(state));
  const made: Scene = { state, geometry, snapshots, boundKind: boundKind(state) };
  try {
    made.bound = boundOf(state, snapshots.truth[0]);
  } catch (error) {
    made.boundProblem = describeError(error);
  }
  return made;
}

const boundKind = ({ snapshots, fluctuation }: AngleState): Scene['boundKind'] =>
  snapshots > 1 && fluctuation === 'complex-normal' ? 'stochastic' : 'deterministic';

/**
 * The bound for the signals drawn. Coherent targets repeat one snapshot N times, which is one
 * snapshot of N times the power, with the phases that were drawn.
 */
export function boundOptions(state: AngleState, truth: SnapshotResult['truth'][number] | undefined): BoundOptions {
  const fixed = state.snapshots === 1 || state.fluctuation === 'coherent';
  const repeats = fixed ? 10 * Math.log10(state.snapshots) : 0;
  return {
    array: arrayInput(state.array),
    snapshots: fixed ? 1 : state.snapshots,
    kind: boundKind(state),
    targets: state.targets.map((target, i) => {
      const phaseDeg = truth?.[i]?.phaseDeg;
      return {
        azimuthDeg: target.azimuthDeg,
        snrDb: state.snr + target.powerDb + repeats,
        ...(fixed && phaseDeg !== undefined ? { phaseDeg } : {}),
      };
    }),
  };
}

export const boundOf = (state: AngleState, truth: SnapshotResult['truth'][number] | undefined): Float64Array =>
  state.targets.length ? api.cramerRaoBound(boundOptions(state, truth)).azimuthDeg : new Float64Array(0);

/** Elements x snapshots of the only scene. */
function input({ snapshots }: Scene) {
  const [, elements, count] = snapshots.shape;
  return { snapshots: { data: snapshots.data, shape: [elements, count] } };
}

/** Everything that a method's estimate depends on, as text. */
const inputsOf = (method: Method, { state, geometry }: Scene): string =>
  JSON.stringify([
    simulationOf(state),
    estimatorOptions(method, state),
    networkFor(method, geometry, state)?.name ?? null,
  ]);

const waiting = new Map<Method, Scene>();
const running = new Set<Method>();

function recompute(state: AngleState): void {
  let made: Scene;
  try {
    made = simulate(state);
  } catch (error) {
    sceneProblem.value = describeError(error);
    return;
  }
  const next = new Map<Method, MethodResult>();
  const reasons = new Map<Method, string>();
  for (const info of api.methods()) {
    const reason = whyNot(info, made.geometry, state);
    if (reason) reasons.set(info.name, reason);
    if (reason || !state.methods.includes(info.name)) continue;
    const inputs = inputsOf(info.name, made);
    const before = results.peek().get(info.name);
    waiting.delete(info.name);
    if (before?.inputs === inputs && before.estimate) {
      next.set(info.name, before);
    } else if (info.network || typicalMs(info.name) > FRAME_BUDGET_MS) {
      next.set(info.name, { inputs });
      waiting.set(info.name, made);
    } else {
      next.set(info.name, { inputs, ...runHere(info.name, made) });
    }
  }
  batch(() => {
    sceneProblem.value = null;
    answers.value = { scene: made, results: next };
    unavailable.value = reasons;
  });
  for (const method of waiting.keys()) void runThere(method);
}

/** Another state's scene and what its methods make of it, each told as soon as it is there. */
export async function computeApart(state: AngleState, tell: (answers: Answers) => void): Promise<void> {
  const made = simulate(state);
  const found = new Map<Method, MethodResult>();
  tell({ scene: made, results: found });
  const methods = api
    .methods()
    .filter((info) => state.methods.includes(info.name) && !whyNot(info, made.geometry, state));
  await Promise.all(
    methods.map(async ({ name }) => {
      found.set(name, { inputs: inputsOf(name, made), ...(await onWorker(name, made)) });
      tell({ scene: made, results: new Map(found) });
    }),
  );
}

type Answer = Omit<MethodResult, 'inputs'>;

const warm = new Set<Method>();

function runHere(method: Method, made: Scene): Answer {
  try {
    const run = (): Answer => {
      const started = performance.now();
      const estimate = api.estimate(input(made), estimatorOptions(method, made.state));
      return { estimate, milliseconds: performance.now() - started, where: 'page' };
    };
    // A method's first call pays for compiling it; the time that is shown and learnt is the second's.
    if (!warm.has(method)) run();
    warm.add(method);
    const result = run();
    learn(method, result.milliseconds ?? 0);
    return result;
  } catch (error) {
    return { problem: describeError(error) };
  }
}

/** Calls under way on the workers; more would wait there, and their times would say nothing. */
let busy = 0;
const queue: (() => void)[] = [];
const warmThere = new Set<string>();

async function onWorker(method: Method, made: Scene): Promise<Answer> {
  const model = networkFor(method, made.geometry, made.state);
  const network =
    model &&
    (await load(model.name).then(
      ({ id }) => id,
      (error: unknown) => ({ problem: describeError(error) }),
    ));
  if (typeof network === 'object') return { problem: network.problem };
  if (busy >= pool().workers) await new Promise<void>((free) => queue.push(free));
  busy += 1;
  try {
    const run = async (): Promise<Answer> => {
      const started = performance.now();
      const options = estimatorOptions(method, made.state);
      const estimate = await pool().estimate(input(made), network ? { ...options, network } : options);
      return { estimate, milliseconds: performance.now() - started, where: 'worker' };
    };
    // The first call starts a worker and compiles the method.
    if (!warmThere.has(network ?? method)) await run();
    warmThere.add(network ?? method);
    const result = await run();
    learn(method, (result.milliseconds ?? 0) * TRAVEL_SHARE);
    return result;
  } catch (error) {
    return { problem: describeError(error) };
  } finally {
    busy -= 1;
    queue.shift()?.();
  }
}

/** One call a method at a time; when it returns, the newest state goes next. */
async function runThere(method: Method): Promise<void> {
  if (running.has(method)) return;
  running.add(method);
  try {
    for (let made = waiting.get(method); made; made = waiting.get(method)) {
      waiting.delete(method);
      const inputs = inputsOf(method, made);
      const result = await onWorker(method, made);
      // The method may have been deselected, or the scene or its options replaced.
      const now = answers.peek();
      const expected = now?.results.get(method);
      if (!now || !expected || !isPending(expected) || expected.inputs !== inputs) continue;
      answers.value = { ...now, results: new Map(now.results).set(method, { inputs, ...result }) };
    }
  } finally {
    running.delete(method);
  }
}

/** Other work on the machine only ever adds to a time: the least of the last few is the method's own. */
function learn(method: Method, milliseconds: number): void {
  recent.set(method, [...(recent.get(method) ?? []).slice(-4), milliseconds]);
}

function typicalMs(method: Method): number {
  const times = recent.get(method) ?? [];
  return times.length < FEWEST_TIMES ? 0 : Math.min(...times);
}

/** Response of the array to a wave from boresight, through the same estimator. */
export function beamPattern(array: string, gridPoints = 2048): { azimuthDeg: Float64Array; valuesDb: Float64Array } {
  const input = arrayInput(array);
  const { data, shape } = api.simulateSnapshots({
    array: input,
    targets: [{ azimuthDeg: 0, powerDb: 0, phaseDeg: 0 }],
    snrDb: 200,
    seed: 0,
  });
  const spectrum = api.estimate(
    { snapshots: { data, shape: [shape[1], shape[2]] } },
    { method: 'bartlett', array: input, gridPoints, maxPeaks: 1 },
  ).spectrum;
  if (!spectrum) return { azimuthDeg: new Float64Array(0), valuesDb: new Float64Array(0) };
  const row = cut(spectrum.elevationDeg);
  const size = spectrum.azimuthDeg.length;
  const values = spectrum.valuesDb.subarray(row * size, (row + 1) * size);
  const peak = highest(values);
  return { azimuthDeg: spectrum.azimuthDeg, valuesDb: values.map((value) => value - peak) };
}
