/** The drive that is open: the bundled one, files that were chosen or dropped, or a simulated one. */
import { computed, effect, signal } from '@preact/signals';
import type { Drive, DriveSensor, DriveTruth, ScanMotion, SimulateDriveOptions } from 'boresight';
import type { JobOptions } from 'boresight/worker';
import radarAddress from '../../../../../recordings/delphi/front_radar.csv.gz?url';
import licenceAddress from '../../../../../recordings/delphi/LICENSE?url';
import poseAddress from '../../../../../recordings/delphi/pose_10hz.csv.gz?url';
import { aborted, describeError, FileProblem, type Problem, pool } from '../../../data.ts';
import type { NamedFile } from '../../../ui/entries.ts';
import { type MountingState, mountingState, update } from '../state.ts';

export interface Loaded {
  /** For headings and file names. */
  name: string;
  source: MountingState['source'];
  files: { name: string; bytes: number }[];
  drive: Drive;
  /** The car's motion at each scan. */
  motion: ScanMotion;
  truth: DriveTruth | null;
  /** The angle stated by those who recorded it, by radar. */
  statedDeg: ReadonlyMap<number, number>;
  licence: string | null;
  /** The user's own files, as they can be read again. */
  own: readonly NamedFile[];
}

export const loaded = signal<Loaded | null>(null);
/** Files and licence of the drive that is open or, of the bundled one, will be. */
export const shownFiles = computed((): { files: { name: string; bytes?: number }[]; licence: string | null } => {
  if (loaded.value || mountingState.value.source !== 'delphi') return loaded.value ?? { files: [], licence: null };
  return { files: bundledFiles.map(([name]) => ({ name })), licence: licenceAddress };
});
/** What is being opened, and how far that is where it is known. */
export const opening = signal<{ what: string; share: number | null } | null>(null);
/** An opening was ended by the user. */
export const interrupted = signal(false);
export const driveProblem = signal<(Problem & { file?: string }) | null>(null);
/** Said where a link names files that only its maker has. */
export const filesWanted = computed(
  () => mountingState.value.source === 'files' && loaded.value === null && opening.value === null,
);

export const ownFiles = (): readonly NamedFile[] => loaded.peek()?.own ?? [];

/** Puts the user's own files away. */
export function closeOwn(): void {
  if (ownFiles().length) loaded.value = null;
}

/** The radar that is looked at. */
export const sensor = computed<DriveSensor | null>(() => {
  const sensors = loaded.value?.drive.sensors ?? [];
  return sensors.find(({ id }) => id === mountingState.value.sensor) ?? sensors[0] ?? null;
});

/** Scans of that radar: their numbers and times. */
export const scans = computed(() => {
  const drive = loaded.value?.drive;
  const id = sensor.value?.id;
  if (!drive || id === undefined) return { scan: new Uint32Array(), timeS: new Float64Array() };
  const all = drive.scans;
  const scan = Uint32Array.from(all.sensor.keys()).filter((i) => all.sensor[i] === id);
  return { scan, timeS: Float64Array.from(scan, (i) => all.timeS[i] as number) };
});

/** The latest opening wins, and ends the one before. */
let controller: AbortController | undefined;

/** Opens a drive; gives what kept it from being opened, or null. */
export async function open(
  what: string,
  work: (signal: AbortSignal, job: JobOptions) => Promise<Omit<Loaded, 'motion'>>,
  opened: () => void = () => {},
): Promise<unknown> {
  controller?.abort();
  const mine = new AbortController();
  controller = mine;
  opening.value = { what, share: null };
  interrupted.value = false;
  const onProgress = (done: number, total: number): void => {
    if (controller === mine && total > 1) opening.value = { what, share: done / total };
  };
  try {
    const next = await work(mine.signal, { signal: mine.signal, onProgress });
    const motion = await pool().scanMotion(next.drive, {}, { signal: mine.signal });
    mine.signal.throwIfAborted();
    opened();
    loaded.value = { ...next, motion };
    driveProblem.value = null;
    return null;
  } catch (error) {
    if (controller === mine && !aborted(error))
      driveProblem.value =
        error instanceof FileProblem
          ? { code: error.code, message: error.message, file: error.file }
          : describeError(error);
    return error;
  } finally {
    if (controller === mine) {
      controller = undefined;
      opening.value = null;
    }
  }
}

/** Ends an opening under way; what was open stays. */
export function cancelOpening(): void {
  controller?.abort();
  controller = undefined;
  interrupted.value = opening.value !== null;
  opening.value = null;
}

const attempts = signal(0);

/** Takes up what was ended. */
export function openAgain(): void {
  attempts.value += 1;
}

/** A drive of one's own has its own radars and places. */
export const OWN = { sensor: null, xM: null, yM: null, nominal: null, minSpeed: null } as const;

/** Names and addresses of the bundled drive's files. */
export const bundledFiles = [
  ['front_radar.csv', radarAddress],
  ['pose_10hz.csv.gz', poseAddress],
] as const;

/** The radar's table out of the form in which it is sent. */
async function tableOf(sent: Uint8Array, signal: AbortSignal): Promise<Uint8Array> {
  const worker = new Worker(new URL('./compact-worker.ts', import.meta.url), { type: 'module' });
  try {
    return await new Promise((resolve, reject) => {
      signal.addEventListener('abort', () => reject(signal.reason));
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = ({ message }) => reject(new FileProblem('damaged', 'front_radar.csv', message));
      worker.postMessage(sent, [sent.buffer]);
    });
  } finally {
    worker.terminate();
  }
}

/** A bundled file. */
export async function fetched(name: string, address: string, signal: AbortSignal): Promise<Uint8Array> {
  const response = await fetch(address, { signal });
  if (response.ok) return new Uint8Array(await response.arrayBuffer());
  throw new FileProblem('not-found', name, `could not be loaded: the server answered ${response.status}`);
}

/** The files of the bundled drive. */
export function bundledDrive(signal: AbortSignal): Promise<{ name: string; bytes: Uint8Array }[]> {
  return Promise.all(
    bundledFiles.map(async ([name, address]) => {
      const bytes = await fetched(name, address, signal);
      return { name, bytes: address === radarAddress ? await tableOf(bytes, signal) : bytes };
    }),
  );
}

export function openBundled(): Promise<unknown> {
  return open('Loading the bundled drive', async (signal, job) => {
    const files = await bundledDrive(signal);
    const sizes = files.map(({ name, bytes }) => ({ name, bytes: bytes.length }));
    const drive = await pool().readDrive(files, {}, { ...job, transfer: true });
    return {
      name: 'bundled',
      source: 'delphi',
      files: sizes,
      drive,
      truth: null,
      statedDeg: new Map([[1, -1.96]]),
      licence: licenceAddress,
      own: [],
    };
  });
}

export function simulation(state: MountingState): SimulateDriveOptions {
  const { scenario, profile, seed, duration, moving, misalignment } = state;
  const misalignmentDeg = Object.fromEntries([1, 2, 3, 4].map((id) => [id, misalignment]));
  return {
    scenario,
    profile,
    seed,
    durationS: duration,
    misalignmentDeg,
    ...(moving === null ? {} : { movingShare: moving / 100 }),
  };
}

function openSimulated(options: SimulateDriveOptions): Promise<unknown> {
  return open('Simulating a drive', async (_, job) => {
    const { truth, ...drive } = await pool().simulateDrive(options, job);
    return {
      name: `${options.scenario}-seed${options.seed}`,
      source: 'simulated',
      files: [],
      drive,
      truth,
      statedDeg: new Map(truth.sensors.map(({ id, yawDeg }) => [id, yawDeg])),
      licence: null,
      own: [],
    };
  });
}

export function chooseSource(source: 'delphi' | 'simulated' | 'live'): void {
  update({ ...OWN, source });
}

/** Opens what the state names, again when it names something else. */
export function start(): () => void {
  const source = computed(() => mountingState.value.source);
  const options = computed(() => (source.value === 'simulated' ? JSON.stringify(simulation(mountingState.value)) : ''));
  let simulated = '';
  let timer: ReturnType<typeof setTimeout> | undefined;
  const stop = effect(() => {
    void attempts.value;
    const wanted = source.value;
    const text = options.value;
    clearTimeout(timer);
    const open = loaded.peek();
    if (wanted === 'delphi') {
      if (open?.source !== 'delphi') void openBundled();
    } else if (wanted === 'simulated') {
      if (open?.source === 'simulated' && simulated === text) return;
      // Numbers are typed digit by digit.
      timer = setTimeout(
        () => {
          simulated = text;
          void openSimulated(JSON.parse(text) as SimulateDriveOptions);
        },
        open ? 400 : 0,
      );
    } else {
      if (wanted === 'live') cancelOpening();
      if (wanted === 'live' || open?.source !== 'files') loaded.value = null;
    }
  });
  return () => {
    clearTimeout(timer);
    cancelOpening();
    interrupted.value = false;
    stop();
  };
}
