/**
 * From samples to images, on workers: cells of each radar's frame, estimates of each method, maps,
 * images. What was computed for the present input is kept, so that switching goes quickly; the newest
 * state wins.
 */
import { batch, computed, effect, signal } from '@preact/signals';
import type {
  ArrayGeometry,
  BatchEstimate,
  BirdsEyeView,
  FrameCells,
  Gate,
  ImageFrameOptions,
  ImageFrom,
  Method,
  RangeAzimuthMap,
  SidelobeMeasure,
  SimulatedStreet,
  Warning,
} from 'boresight';
import type { JobOptions } from 'boresight/worker';
import { aborted, api, describeError, type Problem, pool } from '../../data.ts';
import { quickestFirst, whyUnsuited } from '../../methods.ts';
import { modelFor, whyNoNetwork } from '../../networks/choose.ts';
import { load, readyNetworks } from '../../networks/load.ts';
import type { Model } from '../../networks/models.ts';
import {
  chainOptions,
  grid,
  gridProblem,
  type Input,
  input,
  type Point,
  type Radar,
  shownRadars,
  streetOptions,
} from './input.ts';
import { type BirdseyeState, birdseyeState } from './state.ts';

/** A radar's frame: what was detected, and the street's points it can see. */
export interface RadarFrame {
  radar: Radar;
  cells: FrameCells;
  visible: Point[] | null;
}

export interface MethodImage {
  /** Input, radars and settings of the image, as text. */
  inputs: string;
  /** Absent until it is computed. */
  view?: BirdsEyeView;
  peakDb?: number;
  radars?: readonly Radar[];
  measure?: SidelobeMeasure | undefined;
  /** Within which energy counts as the target's. */
  gate?: Gate;
  /** What the image was made of, for methods without spectra its targets. */
  from?: ImageFrom;
  cells?: number;
  sources?: number;
  unresolved?: number;
  outside?: number;
  warnings?: Warning[];
  /** Of the estimates alone, all radars together. */
  milliseconds?: number;
  problem?: Problem;
}

/** Whether there is no image yet. */
export const isPending = ({ view, problem }: MethodImage): boolean => !view && !problem;

export const images = signal<ReadonlyMap<Method, MethodImage>>(new Map());
export const frames = signal<readonly RadarFrame[]>([]);
export const frameProblem = signal<Problem | null>(null);
export const progress = signal<{
  share: number;
  what: string;
  text: string;
  /** The present method's work alone: others take as long as they take. */
  of: { what: string; share: number };
} | null>(null);
export const wasCancelled = signal(false);
/** Whether what is shown is about to be replaced. */
export const working = signal(false);

/** Methods that cannot work on these radars' single snapshots, with the reason. */
export const unavailable = computed<ReadonlyMap<Method, string>>(() => {
  const reasons = new Map<Method, string>();
  const geometries = geometriesOf(input.value?.radars ?? []);
  for (const info of api.methods()) {
    const problem = info.network ? whyNoNetwork(info.name, geometries) : null;
    if (problem) reasons.set(info.name, problem);
    else {
      const reason = geometries
        .map(({ positions }) => whyUnsuited({ method: info.name, array: { positions } }, 1))
        .find((one) => one !== null);
      if (reason) reasons.set(info.name, reason);
    }
  }
  return reasons;
});

export const geometriesOf = (radars: readonly Radar[]): ArrayGeometry[] => radars.map(({ array }) => api.array(array));

/** The network that a method would use on all radars. */
export function networkFor(method: Method): Model | undefined {
  return modelFor(method, geometriesOf(input.value?.radars ?? []), null, birdseyeState.value.networks);
}

/** What every image depends on; as text, so that effects run when it changes only. */
const settings = computed(() => {
  const { refine, from, falseAlarm, grouping, sources, points, gate, frame } = birdseyeState.value;
  return JSON.stringify({
    input: input.value?.key,
    radars: shownRadars.value.map(({ name }) => name),
    grid: grid.value,
    refine,
    from,
    falseAlarm,
    grouping,
    sources,
    points,
    gate,
    frame,
  });
});
/** The methods that can run. */
const chosen = computed(() => birdseyeState.value.methods.filter((method) => !unavailable.value.has(method)));
const job = computed(() => JSON.stringify([settings.value, chosen.value, birdseyeState.value.networks]));

const attempts = signal(0);
let running: AbortController | undefined;

export function cancel(): void {
  running?.abort();
}

export function restart(): void {
  attempts.value += 1;
}

/** What is kept of an input, and what each part was made for. */
let kept: { input: string; street: Map<string, SimulatedStreet>; parts: Map<string, unknown> } = {
  input: '',
  street: new Map(),
  parts: new Map(),
};
/** Spectra of a few settings; older ones make room. */
const MOST_PARTS = 120;

async function once<T>(key: string, make: () => Promise<T>): Promise<T> {
  const { parts } = kept;
  const known = parts.get(key) as T | undefined;
  const made = known ?? (await make());
  // The latest stand last.
  parts.delete(key);
  parts.set(key, made);
  for (const [oldest] of parts) {
    if (parts.size <= MOST_PARTS) break;
    parts.delete(oldest);
  }
  return made;
}

export function start(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stop = effect(() => {
    void attempts.value;
    void job.value;
    void readyNetworks.value;
    const looked = input.value;
    clearTimeout(timer);
    running?.abort();
    running = undefined;
    batch(() => {
      progress.value = null;
      wasCancelled.value = false;
      frameProblem.value = null;
      working.value = false;
      if (kept.input !== looked?.key) {
        kept = { input: looked?.key ?? '', street: new Map(), parts: new Map() };
        images.value = new Map();
        frames.value = [];
      }
      const before = images.peek();
      images.value = new Map(
        chosen.peek().map((method): [Method, MethodImage] => {
          const inputs = JSON.stringify([settings.peek(), networkFor(method)?.name ?? null]);
          const known = before.get(method);
          return [method, known?.inputs === inputs && known.view ? known : { inputs }];
        }),
      );
    });
    if (!looked || gridProblem.value || !shownRadars.peek().length) return;
    const missing = [...images.peek()].filter(([, image]) => isPending(image)).map(([method]) => method);
    // Detections of an image that stays are those of the present settings.
    if (!missing.length && images.peek().size) return;
    working.value = true;
    const state = birdseyeState.peek();
    const radars = shownRadars.peek();
    // Numbers are typed digit by digit.
    timer = setTimeout(() => void run(looked, radars, missing, state), 100);
  });
  return () => {
    clearTimeout(timer);
    running?.abort();
    running = undefined;
    stop();
  };
}

async function run(
  looked: Input,
  radars: readonly Radar[],
  methods: readonly Method[],
  state: BirdseyeState,
): Promise<void> {
  const controller = new AbortController();
  running = controller;
  const { signal } = controller;
  const current = (): boolean => running === controller;
  /** A share of the work for each frame and each method's estimates of it. */
  const total = radars.length * (1 + methods.length);
  let done = 0;
  let what = '';
  /** What is yet to come after the present method, and where it began. */
  let [then, from] = ['', 0];
  const say = (part = 0): void => {
    if (!current()) return;
    progress.value = {
      share: Math.min((done + part) / Math.max(total, 1), 1),
      what,
      text: `${what}${then}`,
      of: { what, share: Math.min((done + part - from) / Math.max(radars.length, 1), 1) },
    };
  };
  try {
    what = looked.street ? 'Simulating the street' : 'Detecting';
    say();
    const made = await Promise.all(
      radars.map(async (radar) => {
        const frame = await frameOf(looked, radar, state, signal);
        done += 1;
        say();
        return frame;
      }),
    );
    if (!current()) return;
    frames.value = made;
    for (const [at, method] of quickestFirst(methods).entries()) {
      from = done;
      const more = methods.length - at - 1;
      then = more > 0 ? `, then ${more} more` : '';
      what = `Estimating by ${api.methods().find(({ name }) => name === method)?.title ?? method}`;
      const { inputs = '' } = images.peek().get(method) ?? {};
      let image: MethodImage;
      try {
        const steps = {
          step: () => {
            done += 1;
          },
          report: say,
        };
        image = { inputs, ...(await imageOf(looked, method, made, state, signal, steps)) };
      } catch (error) {
        if (signal.aborted) throw error;
        image = { inputs, problem: describeError(error) };
      }
      if (!current()) return;
      images.value = new Map(images.peek()).set(method, image);
    }
  } catch (error) {
    if (!current()) return;
    if (aborted(error)) wasCancelled.value = true;
    else frameProblem.value = describeError(error);
  }
  if (!current()) return;
  running = undefined;
  batch(() => {
    progress.value = null;
    working.value = false;
  });
}

/** What a radar's cells depend on beside the input. */
const detectionKey = (looked: Input, radar: Radar, { falseAlarm, grouping, frame }: BirdseyeState): string =>
  `${radar.name} ${falseAlarm} ${grouping} ${looked.capture ? frame : ''}`;

async function frameOf(looked: Input, radar: Radar, state: BirdseyeState, signal: AbortSignal): Promise<RadarFrame> {
  const chain = chainOptions(radar, state);
  const key = detectionKey(looked, radar, state);
  if (looked.capture) {
    const { kept, info } = looked.capture;
    const at = Math.min(state.frame, info.frames - 1);
    const { waveform: _, ...options } = chain;
    const cells = await once(`cells ${key}`, () => kept.frameCells(at, options, { signal }));
    return { radar, cells, visible: null };
  }
  const { street } = kept;
  const simulated =
    street.get(radar.name) ?? (await pool().simulateStreet({ ...streetOptions(state), radar: radar.name }, { signal }));
  street.set(radar.name, simulated);
  const cells = await once(`cells ${key}`, () => pool().frameCells(simulated.cube, chain, { signal }));
  const visible = simulated.targets.map(({ target }) => looked.street?.targets[target] as Point);
  return { radar, cells, visible };
}

interface Steps {
  step(): void;
  report(part?: number): void;
}

/** What a method's image of a radar's cells is made by, beside the radar itself. */
export function imageOptions(
  method: Method,
  { fieldOfViewDeg }: Pick<Radar, 'fieldOfViewDeg'>,
  { from, sources, points, refine }: BirdseyeState,
): Omit<ImageFrameOptions, 'waveform' | 'array'> {
  const { spectrum = false, sourceCount = false } = api.methods().find(({ name }) => name === method) ?? {};
  return {
    from: spectrum ? from : 'targets',
    // One snapshot does not tell how many there are.
    angle: {
      method,
      ...(sourceCount ? { sources: Number(sources) } : {}),
      gridPoints: Number(points),
      ...(refine ? { refine } : {}),
      fieldOfViewDeg,
    },
    grid: { fieldOfViewDeg },
  };
}

async function imageOf(
  looked: Input,
  method: Method,
  made: readonly RadarFrame[],
  state: BirdseyeState,
  signal: AbortSignal,
  { step, report }: Steps,
): Promise<Omit<MethodImage, 'inputs'>> {
  const { points, gate, refine } = state;
  const {
    spectrum: hasSpectrum = false,
    sourceCount = false,
    network: isNetwork = false,
  } = api.methods().find(({ name }) => name === method) ?? {};
  const model = isNetwork ? networkFor(method) : undefined;
  const network = model && (await load(model.name, signal)).id;
  const parts: {
    frame: RadarFrame;
    estimate: BatchEstimate;
    milliseconds: number;
    map: RangeAzimuthMap;
    from: ImageFrom;
  }[] = [];
  for (const one of made) {
    const { radar, cells } = one;
    const key = `${method} ${network ?? ''} ${refine} ${points} ${sourceCount ? state.sources : ''} ${detectionKey(looked, radar, state)}`;
    const job: JobOptions = { signal, onProgress: (done, total) => report(total > 0 ? done / total : 0) };
    const plan = api.imagePlan({ waveform: radar.waveform, array: radar.array, ...imageOptions(method, radar, state) });
    const { estimate, milliseconds } = await once(`estimates ${key}`, async () => {
      const started = performance.now();
      // Spectra come along for the time when they are asked for.
      const estimate = await pool().estimateBatch(
        { snapshots: cells.snapshots },
        { ...plan.estimator, ...(network === undefined ? {} : { network }), spectra: hasSpectrum },
        job,
      );
      return { estimate, milliseconds: performance.now() - started };
    });
    const { from, grid } = plan;
    const map = await once(`map ${key} ${from}`, () =>
      pool().rangeAzimuthMap({ cells, estimates: estimate, from, grid }, { signal }),
    );
    parts.push({ frame: one, estimate, milliseconds, map, from });
    step();
    report();
  }
  const { view, peakDb, measure, gate: within } = await imageOfMaps(looked, parts, gate, signal);
  const warnings = new Map<string, Warning>();
  for (const { estimate } of parts) for (const warning of estimate.warnings) warnings.set(warning.code, warning);
  const sum = (value: (part: (typeof parts)[number]) => number): number =>
    parts.reduce((total, part) => total + value(part), 0);
  return {
    view,
    peakDb,
    measure,
    gate: within,
    radars: made.map(({ radar }) => radar),
    from: parts[0]?.from ?? state.from,
    cells: sum(({ estimate }) => estimate.cells),
    sources: sum(({ estimate }) => estimate.cell.length),
    unresolved: sum(({ estimate }) => estimate.unresolved),
    outside: sum(({ map }) => map.outside.count),
    warnings: [...warnings.values()],
    milliseconds: sum((part) => part.milliseconds),
  };
}

async function imageOfMaps(
  looked: Input,
  parts: readonly { frame: RadarFrame; map: RangeAzimuthMap }[],
  gateM: number | null,
  signal: AbortSignal,
): Promise<Required<Pick<MethodImage, 'view' | 'peakDb' | 'gate'>> & Pick<MethodImage, 'measure'>> {
  const view = await pool().birdsEyeView(
    { radars: parts.map(({ frame, map }) => ({ map, mounting: frame.radar.mounting })), grid: grid.peek() },
    { signal },
  );
  let peak = 0;
  for (const power of view.power) peak = Math.max(peak, power);
  const targets = uniquePoints(parts.flatMap(({ frame }) => frame.visible ?? []));
  const gate = gateOf(parts, gateM);
  const measure = looked.street ? await pool().sidelobeMeasure(view, targets, gate, { signal }) : undefined;
  return { view, peakDb: 10 * Math.log10(peak), measure, gate };
}

/**
 * What a radar cannot resolve, unless the user says: the main lobes of a Hann window and of the array, to their first
 * nulls, and a cell of the map.
 */
function gateOf([part]: readonly { frame: RadarFrame; map: RangeAzimuthMap }[], gateM: number | null): Gate {
  if (gateM !== null || !part) return { gateM: gateM ?? 1 };
  const { waveform, array } = part.frame.radar;
  const [first = 0, second = 0] = part.map.azimuthDeg.map((azimuth) => Math.sin((azimuth * Math.PI) / 180));
  return {
    rangeM: 2 * api.waveformSummary(waveform).rangeResolutionM,
    sine: Math.sin((api.array(array).resolutionDeg * Math.PI) / 180) + second - first,
  };
}

/** A point that several radars see counts once. */
function uniquePoints(points: readonly Point[]): Point[] {
  return [...new Set(points)];
}
