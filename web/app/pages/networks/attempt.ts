/** A network tried on one simulated scene, beside classical methods and the truth. */
import { batch, computed, effect, signal } from '@preact/signals';
import type {
  Estimate,
  EstimateInput,
  EstimatorOptions,
  Method,
  NetworkInfo,
  NetworkMethod,
  SnapshotOptions,
} from 'boresight';
import { api, describeError, type Problem, pool } from '../../data.ts';
import { load, loadings, models } from '../../networks/load.ts';
import { type Card, elementsOf, type Model, type Sight, sightOf, targetsOf } from '../../networks/models.ts';
import { measure } from './measure.ts';
import { radarOf, simulateRegion } from './region.ts';
import { type NetworksState, networksState, SOURCE_RANGE, TARGET_RANGE } from './state.ts';

export interface Row {
  method: Method;
  title: string;
  estimate?: Estimate;
  problem?: Problem;
  /** Median of several calls. */
  milliseconds?: number;
  calls?: number;
}

export interface Count {
  rule: string;
  title: string;
  sources?: number;
  probability?: readonly number[];
  problem?: Problem;
}

export interface Attempt {
  model: string;
  sight: Sight;
  /** In the order of the targets' azimuths. */
  truth: { azimuthDeg: number; powerDb: number }[];
  /** Standard deviation of each target's azimuth at best, degrees. */
  bound?: Float64Array;
  fieldOfViewDeg: number;
  array: string;
  rows: Row[];
  /** Of a counting network. */
  counts: Count[];
  scene: string;
}

const made = signal<{ inputs: string; attempt: Attempt } | null>(null);
export const attemptProblem = signal<Problem | null>(null);
export const trying = signal(false);

export const selected = computed<Model | undefined>(() =>
  models.value.find(({ name }) => name === networksState.value.model),
);

/** Everything that an attempt depends on, as text. */
const inputsOf = (model: Model, { targets, snr, seed, refine, range, array }: Scene): string =>
  JSON.stringify([model.name, targets, snr, seed, refine, range, array]);
const inputs = computed(() => selected.value && inputsOf(selected.value, networksState.value));

/** The attempt on the present scene, of the chosen network; attempts on other scenes are not shown. */
export const attempt = computed(() => (made.value?.inputs === inputs.value ? (made.value?.attempt ?? null) : null));

/** How many targets a network can be tried on. */
export function targetRange(card: Card): readonly [number, number] {
  if (sightOf(card) === 'snapshot') return TARGET_RANGE;
  if (sightOf(card) === 'covariance') return SOURCE_RANGE;
  const fixed = targetsOf(card);
  return card.network === 'counting' ? [0, 2] : fixed === null ? [1, 2] : [fixed, fixed];
}

/** The number of targets of the present scene. */
export function targetsIn({ targets }: Pick<NetworksState, 'targets'>, card: Card): number {
  const [fewest, most] = targetRange(card);
  return Math.min(Math.max(targets, fewest), most);
}

let running: AbortController | undefined;

export function stop(): void {
  running?.abort();
}

/** What was cancelled or failed may be loaded since. */
const loaded = computed(() => loadings.value.get(selected.value?.name ?? '')?.status === 'ready');

/** Runs the scene of the state while it is wanted; the newest wins. */
export function start(): () => void {
  const finish = effect(() => {
    const { targets, snr, seed, refine, run, range, array } = networksState.value;
    const model = selected.value;
    void loaded.value;
    running?.abort();
    if (!run || !model) return;
    const controller = new AbortController();
    running = controller;
    queueMicrotask(() => void attemptOn(model, { targets, snr, seed, refine, range, array }, controller));
  });
  return () => {
    running?.abort();
    finish();
  };
}

export type Scene = Pick<NetworksState, 'targets' | 'snr' | 'seed' | 'refine' | 'range' | 'array'>;

async function attemptOn(model: Model, scene: Scene, controller: AbortController): Promise<void> {
  trying.value = true;
  const inputs = inputsOf(model, scene);
  try {
    const info = await load(model.name, controller.signal);
    const whole = await (sightOf(model.card) === 'region' ? onRegion : onSnapshots)(model, info, scene, {
      signal: controller.signal,
      show: (part) => {
        if (running === controller) made.value = { inputs, attempt: part };
      },
    });
    if (running !== controller) return;
    batch(() => {
      made.value = { inputs, attempt: whole };
      attemptProblem.value = null;
    });
  } catch (error) {
    if (running === controller && !controller.signal.aborted) attemptProblem.value = describeError(error);
  } finally {
    if (running === controller) trying.value = false;
  }
}

interface Wanted {
  method: Method;
  title: string;
  run(): Promise<Estimate>;
}

interface Job {
  signal: AbortSignal;
  /** Takes what is there already. */
  show(part: Attempt): void;
}

/** Calls of each method that are timed. */
export const EFFORT = { budgetMs: 100, fewest: 3, most: 25, warm: 1 };

/** One method at a time, so that none slows another. */
async function rowsOf(wanted: readonly Wanted[], made: Attempt, { signal, show }: Job): Promise<Row[]> {
  const rows: Row[] = [];
  for (const { method, title, run } of wanted) {
    try {
      const first = await run();
      signal.throwIfAborted();
      show({ ...made, rows: [...rows, { method, title, estimate: first }] });
      const { median, calls } = await measure(run, signal, EFFORT);
      rows.push({ method, title, estimate: first, milliseconds: median, calls });
    } catch (error) {
      if (signal.aborted) throw error;
      rows.push({ method, title, problem: describeError(error) });
    }
  }
  return rows;
}

const title = (method: Method): string => api.methods().find(({ name }) => name === method)?.title ?? method;

function classical(
  method: Method,
  input: EstimateInput,
  options: Omit<EstimatorOptions, 'method'>,
  signal: AbortSignal,
  name = title(method),
): Wanted {
  return { method, title: name, run: () => pool().estimate(input, { ...options, method }, { signal }) };
}

/**
 * The array of a network of snapshots: the one chosen, where it takes any, or the one it was trained on, or, of a user's
 * own, one of as many elements.
 */
export function arrayFor(card: Card, chosen: string): string {
  const [array, elements] = [card.data?.array, elementsOf(card)];
  if (elements === null) return chosen;
  return typeof array === 'string' ? array : elements === 48 ? 'lrr48' : `ula${elements}`;
}

/** Snapshots that the covariance of a scene is the mean of. */
export const COVARIANCE_SNAPSHOTS = 200;

/** What a scene of snapshots is: one with many targets, or many with few, of whose number methods are told. */
export function snapshotScene(card: Card, targets: number) {
  return sightOf(card) === 'covariance'
    ? ({
        snapshots: COVARIANCE_SNAPSHOTS,
        powerDb: [0, 0],
        beside: ['music', 'root-music', 'capon'],
        sources: targets,
      } as const)
    : ({ snapshots: 1, powerDb: [-13, 0], beside: ['iaa', 'nomp', 'bartlett'] } as const);
}

/** What the package is asked for a scene of snapshots; the network is told its field of view as well. */
export function snapshotCalls(card: Card, scene: Scene) {
  const targets = targetsIn(scene, card);
  const array = arrayFor(card, scene.array);
  const { snapshots, powerDb, beside, ...told } = snapshotScene(card, targets);
  const fieldOfViewDeg = typeof card.data?.fieldOfViewDeg === 'number' ? card.data.fieldOfViewDeg : 60;
  const simulation: SnapshotOptions = {
    array,
    targets: { count: [targets, targets], fieldOfViewDeg, powerDb },
    snapshots,
    snrDb: scene.snr,
    seed: scene.seed,
  };
  const options = { array, gridPoints: 2048, ...told, ...(scene.refine ? { refine: true } : {}) };
  return { targets, array, fieldOfViewDeg, simulation, options, beside };
}

async function onSnapshots(model: Model, info: NetworkInfo, scene: Scene, job: Job): Promise<Attempt> {
  const { signal } = job;
  const { card, name } = model;
  const method = card.network as NetworkMethod;
  const { snr: snrDb, seed, refine } = scene;
  const { targets, array, fieldOfViewDeg, simulation, options, beside } = snapshotCalls(card, scene);
  const { snapshots = 1 } = simulation;
  const drawn = api.simulateSnapshots(simulation);
  const truth = [...(drawn.truth[0] ?? [])].sort((a, b) => a.azimuthDeg - b.azimuthDeg);
  const [, elements, count] = drawn.shape;
  const input: EstimateInput = { snapshots: { data: drawn.data, shape: [elements, count] } };
  const made: Attempt = {
    model: name,
    sight: sightOf(card),
    truth,
    fieldOfViewDeg,
    array,
    rows: [],
    counts: [],
    ...(truth.length
      ? {
          bound: api.cramerRaoBound({
            array,
            snapshots,
            kind: 'deterministic',
            targets: truth.map(({ azimuthDeg, powerDb, phaseDeg }) => ({
              azimuthDeg,
              snrDb: snrDb + powerDb,
              ...(phaseDeg === undefined ? {} : { phaseDeg }),
            })),
          }).azimuthDeg,
        }
      : {}),
    scene: `${array}, ${targets} ${targets === 1 ? 'target' : 'targets'}${snapshots > 1 ? `, ${snapshots} snapshots` : ''}, ${snrDb} dB, seed ${seed}${refine ? ', refined' : ''}`,
  };
  made.rows = await rowsOf(
    [
      {
        method,
        title: model.title,
        run: () => pool().estimate(input, { ...options, method, network: info.id, fieldOfViewDeg }, { signal }),
      },
      ...beside.map((method) => classical(method, input, options, signal)),
    ],
    made,
    job,
  );
  return made;
}

/** What a number of targets is counted by, beside the network. */
export const COUNT_RULES = [
  { criterion: 'largest-root', title: 'Largest root', forwardBackward: false },
  { criterion: 'mdl', title: 'MDL', forwardBackward: false },
  { criterion: 'mdl', title: 'MDL, forward-backward', forwardBackward: true },
  { criterion: 'aic', title: 'AIC', forwardBackward: false },
] as const;

/** What of a region a method takes: the covariance of all its bins, or the strongest bin's snapshots. */
export type RegionInput = 'covariance' | 'snapshots';

/** What the package is asked for a region, of the network and of the methods beside it. */
export function regionCalls(array: string, targets: number, refine: boolean) {
  const options = {
    array,
    fieldOfViewDeg: 15,
    sources: targets,
    maxPeaks: targets,
    ...(refine ? { refine } : {}),
  };
  const smooth = { ...options, smoothing: 6, forwardBackward: true };
  const beside: readonly { method: Method; of: RegionInput; name: string; options: typeof options }[] = [
    { method: 'maximum-likelihood', of: 'covariance', name: '', options },
    { method: 'music', of: 'covariance', name: '', options },
    { method: 'root-music', of: 'covariance', name: ', smoothed', options: smooth },
    { method: 'iaa', of: 'snapshots', name: ', strongest bin', options },
  ];
  return { ofNetwork: { array, sources: targets, fieldOfViewDeg: 10 }, beside };
}

async function onRegion(model: Model, info: NetworkInfo, scene: Scene, job: Job): Promise<Attempt> {
  const { signal } = job;
  const { card, name } = model;
  const { snr, seed, range, refine } = scene;
  const targets = targetsIn(scene, card);
  const radar = radarOf(card);
  const { array } = radar;
  const { azimuthDeg, region, covariance, vectors, snapshots } = simulateRegion(
    radar,
    targets,
    snr,
    seed,
    range === 'together',
  );
  const input: EstimateInput = { covariance, snapshotCount: vectors };
  const made: Attempt = {
    model: name,
    sight: 'region',
    truth: azimuthDeg.map((azimuth) => ({ azimuthDeg: azimuth, powerDb: 0 })),
    fieldOfViewDeg: 15,
    array,
    rows: [],
    counts: [],
    scene: `${targets} ${targets === 1 ? 'target' : 'targets'}${targets === 2 ? (range === 'together' ? ' at one range' : ' at ranges of their own') : ''}, ${snr} dB, seed ${seed}`,
  };
  if (card.network === 'counting') {
    const answer = await pool().countWithNetwork(info.id, input, { signal });
    return {
      ...made,
      counts: [
        { rule: 'network', title: model.title, sources: answer.sources, probability: [...answer.probability] },
        ...COUNT_RULES.map(
          ({ criterion, title, forwardBackward }): Count => ({
            rule: `${criterion}${forwardBackward ? '-reversed' : ''}`,
            title,
            sources: api.countSources(input, { criterion, forwardBackward }).count,
          }),
        ),
      ],
    };
  }
  const method = card.network;
  const { ofNetwork, beside } = regionCalls(array, targets, refine);
  const inputs: Record<RegionInput, EstimateInput> = { covariance: input, snapshots: { snapshots } };
  made.rows = await rowsOf(
    [
      {
        method,
        title: model.title,
        run: () => pool().estimateRegion(region, { ...ofNetwork, method, network: info.id }, { signal }),
      },
      ...beside.map(({ method, of, name, options }) =>
        classical(method, inputs[of], options, signal, `${title(method)}${name}`),
      ),
    ],
    made,
    job,
  );
  return made;
}
