/** How long networks and classical methods take here: the same cells one by one and in batches, on a worker. */
import { signal } from '@preact/signals';
import type { EstimateInput, EstimatorOptions, Method, NetworkInfo, NetworkMethod, Tensor } from 'boresight';
import { aborted, api, describeError, type Problem, pool } from '../../data.ts';
import { load } from '../../networks/load.ts';
import { type Card, type Model, sightOf } from '../../networks/models.ts';
import { arrayFor, snapshotScene, targetRange } from './attempt.ts';
import { measure, type Spread } from './measure.ts';
import { type RegionScene, radarOf, simulateRegion } from './region.ts';
import { networksState } from './state.ts';

export const BATCHES = [1, 32] as const;
export type Batch = (typeof BATCHES)[number];

export interface Timed {
  subject: string;
  title: string;
  /** Whose style it has. */
  method: string;
  network: boolean;
  batches: Map<Batch, Spread>;
}

export interface Timing {
  rows: Timed[];
  travelMs: number;
}

/** By what was timed. */
export const timings = signal<ReadonlyMap<string, Timing>>(new Map());
/** A network on the cells of an array. */
export const timingKey = ({ name, card }: Model): string => `${name} ${arrayFor(card, networksState.value.array)}`;
export const timing = signal<{ model: string; share: number; what: string } | null>(null);
export const timingProblem = signal<{ model: string; problem: Problem } | null>(null);

let running: AbortController | undefined;

export function cancelTiming(): void {
  running?.abort();
}

/** Of each subject and batch. */
const EFFORT = { budgetMs: 1500, fewest: 5, most: 200 };

interface Subject {
  id: string;
  title: string;
  method: string;
  network: boolean;
  run(batch: Batch, signal: AbortSignal): Promise<unknown>;
}

export async function timeModel(model: Model): Promise<void> {
  running?.abort();
  const controller = new AbortController();
  running = controller;
  const { signal } = controller;
  const current = (): boolean => running === controller;
  const say = (share: number, what: string): void => {
    if (current()) timing.value = { model: model.name, share, what };
  };
  timingProblem.value = null;
  const key = timingKey(model);
  try {
    say(0, 'Loading');
    const info = await load(model.name, signal);
    const subjects = { snapshot: ofSnapshots, covariance: ofCovariances, region: ofRegions }[sightOf(model.card)](
      model,
      info,
    );
    const travel = await measure(() => pool().version({ signal }), signal, { ...EFFORT, budgetMs: 200 });
    const rows: Timed[] = [];
    let step = 0;
    for (const { id, title, method, network, run } of subjects) {
      const batches = new Map<Batch, Spread>();
      for (const batch of BATCHES) {
        const what = `${title}, ${batch === 1 ? 'one at a time' : `batches of ${batch}`}`;
        batches.set(
          batch,
          await measure(
            () => run(batch, signal),
            signal,
            EFFORT,
            (share) => say((step + share) / (subjects.length * BATCHES.length), what),
          ),
        );
        step += 1;
      }
      rows.push({ subject: id, title, method, network, batches });
      if (current()) timings.value = new Map(timings.peek()).set(key, { rows: [...rows], travelMs: travel.median });
    }
  } catch (error) {
    if (current() && !aborted(error)) timingProblem.value = { model: model.name, problem: describeError(error) };
  } finally {
    if (current()) {
      timing.value = null;
      running = undefined;
    }
  }
}

const titleOf = (method: Method): string => api.methods().find(({ name }) => name === method)?.title ?? method;

/** A classical method has no batches: it takes one cell after the other. */
function classical(
  method: Method,
  cells: readonly EstimateInput[],
  options: Omit<EstimatorOptions, 'method'>,
): Subject {
  return {
    id: method,
    title: titleOf(method),
    method,
    network: false,
    run: (batch, signal) =>
      batch === 1
        ? pool().estimate(cells[0] as EstimateInput, { ...options, method }, { signal })
        : pool().estimateMany(cells.slice(0, batch), { ...options, method }, { signal }),
  };
}

function ofSnapshots(model: Model, info: NetworkInfo): Subject[] {
  const most = BATCHES[BATCHES.length - 1] as number;
  const array = arrayFor(model.card, networksState.value.array);
  const {
    data,
    shape: [, elements],
  } = api.simulateSnapshots({ array, targets: { count: [6, 6] }, snrDb: 15, scenes: most, seed: 1 });
  const size = 2 * elements;
  const cells = Array.from(
    { length: most },
    (_, i): EstimateInput => ({ snapshots: { data: data.slice(i * size, (i + 1) * size), shape: [elements, 1] } }),
  );
  const [snapshots, positions] = info.inputs;
  const places: Tensor = { data: Float32Array.from(api.array(array).positions.flat()), shape: [elements, 3] };
  const options = { array, gridPoints: 2048 };
  return [
    {
      id: 'network',
      title: model.title,
      method: model.card.network,
      network: true,
      run: (batch, signal) =>
        pool().runNetwork(
          info.id,
          {
            [snapshots?.name ?? 'snapshots']: {
              data: Float32Array.from(data.subarray(0, batch * size)),
              shape: [batch, elements, 2],
            },
            ...(positions ? { [positions.name]: places } : {}),
          },
          { signal },
        ),
    },
    classical('iaa', cells, options),
    classical('nomp', cells, options),
  ];
}

/** Networks with the covariance and its image in their time, as classical methods have it in theirs. */
function ofCovariances(model: Model, info: NetworkInfo): Subject[] {
  const most = BATCHES[BATCHES.length - 1] as number;
  const array = arrayFor(model.card, networksState.value.array);
  const targets = 2;
  const { snapshots, powerDb, beside, ...told } = snapshotScene(model.card, targets);
  const cells = Array.from({ length: most }, (_, seed): EstimateInput => {
    const drawn = api.simulateSnapshots({
      array,
      targets: { count: [targets, targets], powerDb },
      snapshots,
      snrDb: 0,
      seed: seed + 1,
    });
    const [, elements, count] = drawn.shape;
    return { snapshots: { data: drawn.data, shape: [elements, count] } };
  });
  const options = { array, gridPoints: 2048, ...told };
  const method = model.card.network as NetworkMethod;
  const network = { ...options, fieldOfViewDeg: 60, method, network: info.id };
  return [
    {
      id: 'network',
      title: model.title,
      method,
      network: true,
      run: (batch, signal) =>
        batch === 1
          ? pool().estimate(cells[0] as EstimateInput, network, { signal })
          : pool().estimateMany(cells.slice(0, batch), network, { signal }),
    },
    ...beside.map((name) => classical(name, cells, options)),
  ];
}

function ofRegions(model: Model, info: NetworkInfo): Subject[] {
  const [, targets] = targetRange(model.card);
  const radar = radarOf(model.card);
  const scenes = Array.from({ length: BATCHES[BATCHES.length - 1] as number }, (_, seed) =>
    simulateRegion(radar, targets, 10, seed + 1, false),
  );
  const [input] = info.inputs;
  const features = featuresOf(model.card);
  const tensors = new Map(
    BATCHES.map((batch) => [
      batch,
      {
        data: Float32Array.from(scenes.slice(0, batch).flatMap((scene) => [...features(scene)])),
        shape: shapeOf(input?.axes ?? [], batch),
      },
    ]),
  );
  const cells = scenes.map(({ covariance, vectors }): EstimateInput => ({ covariance, snapshotCount: vectors }));
  const options = { array: radar.array, fieldOfViewDeg: 15, sources: targets };
  return [
    {
      id: 'network',
      title: model.title,
      method: model.card.network,
      network: true,
      run: (batch, signal) =>
        pool().runNetwork(info.id, { [input?.name ?? '']: tensors.get(batch) as Tensor }, { signal }),
    },
    classical('music', cells, options),
    classical('maximum-likelihood', cells, options),
    {
      ...classical(
        'iaa',
        scenes.map(({ snapshots }): EstimateInput => ({ snapshots })),
        options,
      ),
      title: `${titleOf('iaa')}, strongest bin`,
    },
    {
      ...classical(
        'nomp',
        scenes.map(({ snapshots }): EstimateInput => ({ snapshots })),
        options,
      ),
      title: `${titleOf('nomp')}, strongest bin`,
    },
  ];
}

const featuresOf =
  ({ network }: Card) =>
  ({ channels, features }: RegionScene): Float32Array =>
    network === 'cnn3d' ? channels : features;

/** A batch's shape: names stand for the batch. */
const shapeOf = (axes: readonly (number | string)[], batch: number): number[] =>
  axes.map((axis) => (typeof axis === 'number' ? axis : batch));
