/** Calibration by every chosen method, on workers: again when drive or options change, the latest wins. */
import { batch, computed, effect, signal } from '@preact/signals';
import type { CalibrationOptions, Drive, DriveCalibration, JointCalibrationOptions, MotionNetwork } from 'boresight';
import type { JobOptions } from 'boresight/worker';
import { aborted, describeError, type Problem, pool } from '../../../data.ts';
import { type Loaded, loaded, sensor } from '../drive/drive.ts';
import { motionOf, needsNetwork, network, networkNumber, ownNetwork } from '../motion/motion-network.ts';
import { WAYS, type Way } from '../motion/ways.ts';
import { calibrationOptions, mountingState, type Place, place } from '../state.ts';

export interface MethodResult {
  calibration?: DriveCalibration;
  /** Where motions are smoothed over frames: the angles that frames give without, deg. */
  aloneDeg?: Float32Array;
  problem?: Problem;
  milliseconds?: number;
}

/** Whether a method is still computing. */
export const isPending = ({ calibration, problem }: MethodResult): boolean => !calibration && !problem;

/** Of the present drive, radar and options only. */
export const results = signal<ReadonlyMap<Way, MethodResult>>(new Map());
export const progress = signal<{ done: number; total: number } | null>(null);
export const wasCancelled = signal(false);
/** Whether what is shown is about to be replaced. */
export const working = signal(false);

/** Where the radar is taken to be. */
export const where = computed<Place | null>(() => (sensor.value ? place(mountingState.value, sensor.value) : null));

/** Whose frames are shown: the chosen method, if it runs. */
export const shownMethod = computed<Way | null>(() => {
  const { shown } = mountingState.value;
  const methods = chosen.value;
  return methods.includes(shown) ? shown : (methods[0] ?? null);
});

export const shown = computed<DriveCalibration | null>(() => {
  const method = shownMethod.value;
  return (method && results.value.get(method)?.calibration) ?? null;
});

/** Whether all radars can be estimated together: there are several, each with a place. */
export const jointPossible = computed(() => {
  const sensors = loaded.value?.drive.sensors ?? [];
  return sensors.length > 1 && sensors.every(({ id, xM }) => xM !== null || id === sensor.value?.id);
});

/** The chosen ways that are possible. */
const chosen = computed(() => mountingState.value.methods.filter((way) => way !== 'joint' || jointPossible.value));

/** What all methods are asked by; null where there is no drive, or no place of the radar. */
export function asked(): Options | null {
  const open = loaded.value;
  const radar = sensor.value;
  const options = open && where.value && calibrationOptions(mountingState.value, where.value, open.drive.format);
  return radar && options ? { sensor: radar.id, ...options } : null;
}

const attempts = signal(0);
/** What the results are of; as text, so that effects run when it changes only. */
const job = computed(() => {
  const open = loaded.value;
  const options = asked();
  const own = needsNetwork(options?.motion) ? ownNetwork.value : null;
  const network = own && [own.name, own.bytes.length, networkNumber(own)].join();
  return open && options ? JSON.stringify({ network, ...options }) : '';
});
const methods = computed(() => chosen.value.join(','));

let running: AbortController | undefined;
let knownOf: { open: Loaded; job: string } | null = null;
const known = new Map<Way, MethodResult>();

export function cancel(): void {
  running?.abort();
}

export function restart(): void {
  attempts.value += 1;
}

export function start(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stop = effect(() => {
    void attempts.value;
    const open = loaded.value;
    const text = job.value;
    const wanted = WAYS.filter((method) => methods.value.split(',').includes(method));
    clearTimeout(timer);
    running?.abort();
    running = undefined;
    const opened = knownOf?.open !== open;
    batch(() => {
      progress.value = null;
      wasCancelled.value = false;
      working.value = false;
      if (!open || !text) {
        results.value = new Map();
        return;
      }
      if (knownOf?.open !== open || knownOf.job !== text) {
        known.clear();
        knownOf = { open, job: text };
      }
      results.value = new Map(wanted.map((method) => [method, known.get(method) ?? {}]));
    });
    const missing = wanted.filter((method) => !known.has(method));
    if (!open || !text || !missing.length) return;
    working.value = true;
    // Numbers are typed digit by digit.
    timer = setTimeout(() => void calibrate(open, text, missing), opened ? 0 : 250);
  });
  return () => {
    clearTimeout(timer);
    running?.abort();
    running = undefined;
    stop();
  };
}

/** Of all ways, for one radar. */
export type Options = Omit<CalibrationOptions, 'method'> & { sensor: number };

/** The options of a way: its motion may be another than the one asked for. */
export function optionsOf(way: Way, { motion, ...options }: Options): Options {
  const own = way === 'joint' && !needsNetwork(motion) ? undefined : motionOf(way, motion);
  return own === undefined ? options : { ...options, motion: own };
}

/** The same with the network where its motion needs one. */
export async function withNetwork(way: Way, asked: Options): Promise<Options & MotionNetwork> {
  const options = optionsOf(way, asked);
  return needsNetwork(options.motion) ? { ...options, network: await network() } : options;
}

/** Of all radars of a drive together, one of them as asked for. */
export function jointOptions(drive: Pick<Drive, 'sensors'>, options: Options & MotionNetwork): JointCalibrationOptions {
  const { sensor, xM, yM, nominalDeg, ...common } = options;
  const mine = { sensor, xM, ...(yM === undefined ? {} : { yM }), ...(nominalDeg === undefined ? {} : { nominalDeg }) };
  return { ...common, sensors: drive.sensors.map(({ id }) => (id === sensor ? mine : id)) };
}

type Found = Required<Pick<MethodResult, 'calibration'>> & Pick<MethodResult, 'aloneDeg'>;

async function calibrateBy(way: Way, drive: Drive, asked: Options, job: JobOptions): Promise<Found> {
  const options = await withNetwork(way, asked);
  if (way !== 'joint') {
    const by = (motion: Options['motion'], weights: boolean, job: JobOptions): Promise<DriveCalibration> =>
      pool().calibrateDrive(drive, { ...options, ...(motion && { motion }), method: way, weights }, job);
    const found = by(options.motion, true, job);
    if (options.motion !== 'deepego-plus') return { calibration: await found };
    const { onProgress: _, ...quietly } = job;
    const [calibration, alone] = await Promise.all([found, by('deepego', false, quietly)]);
    return { calibration, aloneDeg: alone.frames.angleDeg };
  }
  const all = await pool().jointCalibration(drive, { ...jointOptions(drive, options), weights: true }, job);
  return { calibration: all.find((one) => one.sensor === options.sensor) as DriveCalibration };
}

async function calibrate(open: Loaded, text: string, missing: readonly Way[]): Promise<void> {
  const controller = new AbortController();
  running = controller;
  const { network: _, ...options } = JSON.parse(text) as Options & { network: string | null };
  const shares = new Map(missing.map((method) => [method, 0]));
  const say = (): void => {
    if (running === controller)
      progress.value = { done: [...shares.values()].reduce((sum, share) => sum + share, 0), total: missing.length };
  };
  say();
  await Promise.all(
    missing.map(async (method) => {
      const started = performance.now();
      try {
        const found = await calibrateBy(method, open.drive, options, {
          signal: controller.signal,
          onProgress: (done, total) => {
            shares.set(method, total > 0 ? done / total : 1);
            say();
          },
        });
        keep(method, { ...found, milliseconds: performance.now() - started });
      } catch (error) {
        if (!aborted(error)) keep(method, { problem: describeError(error) });
      }
      shares.set(method, 1);
      say();
    }),
  );
  if (running !== controller) return;
  running = undefined;
  batch(() => {
    progress.value = null;
    working.value = false;
    wasCancelled.value = controller.signal.aborted;
  });

  function keep(method: Way, result: MethodResult): void {
    if (running !== controller) return;
    known.set(method, result);
    results.value = new Map(results.peek()).set(method, result);
  }
}
