/** Files that are open: the bundled capture, or what the user chose or dropped. */
import { batch, computed, effect, signal } from '@preact/signals';
import type { BoardLog, CaptureInfo, ConfigInput, ReadingOptions, Warning } from 'boresight';
import type { PoolCapture } from 'boresight/worker';
import licenceAddress from '../../../../../recordings/awr1642/LICENSE?url';
import cfgAddress from '../../../../../recordings/awr1642/profile.cfg?url';
import binAddress from '../../../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin?url';
import datAddress from '../../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat?url';
import { api, describeError, FileProblem, type Problem, pool } from '../../../data.ts';
import { CAPTURE_KINDS } from '../../../kinds.ts';
import type { NamedFile } from '../../../ui/entries.ts';
import { captureState, readingOptions, update } from '../state.ts';
import { SIMULATED, simulateCapture } from './simulated.ts';

/** The setup is what mmWave Studio says of the board, beside the configuration. */
const KINDS = [...CAPTURE_KINDS, 'setup'] as const;
type Kind = (typeof KINDS)[number];

export const isStudio = (name: string): boolean => /\.json$/i.test(name);
const isSetup = (name: string): boolean => /\.setup\.json$/i.test(name);

/** The files of a recording in order, as `recordingParts` finds them. */
interface Parts {
  files: readonly File[];
  cascade: boolean;
  missing: readonly string[];
}

export interface OpenFile {
  kind: Kind;
  name: string;
  bytes: number;
}

export interface Loaded {
  files: OpenFile[];
  /** Raw samples and the text of the configuration. */
  bin: Uint8Array;
  cfg: string;
  /** What overrides it in how samples are read, where anything does. */
  reading: Partial<ReadingOptions>;
  info: CaptureInfo;
  /** The same on the workers. */
  kept: PoolCapture;
  bundled: { licence: string } | null;
  /** Whether it was simulated in the page. */
  simulated: boolean;
  /** Of files missing between those of the recording, the names. */
  missingParts: Parts['missing'];
  /** What putting the files of a cascade together had to say; null of one chip. */
  cascade: readonly Warning[] | null;
}

/** Files of the user's own that are not enough for a capture yet. */
export interface Waiting {
  files: OpenFile[];
  missing: { kind: Kind; what: string }[];
}

export const loaded = signal<Loaded | null>(null);
export const waiting = signal<Waiting | null>(null);
export const boardLog = signal<BoardLog | null>(null);
export const fileProblem = signal<(Problem & { file?: string }) | null>(null);

/** Whether a link asks for files that only its maker has. */
export const filesWanted = computed(() => captureState.value.source === 'files' && !loaded.value && !waiting.value);

/** What a tab can hold beside its copies in workers. */
const LARGEST_BYTES = 512 * 1024 * 1024;

/** Of the bundled capture. */
export const bundledAddresses = [binAddress, cfgAddress, datAddress] as const;

const NEEDED = [
  { kind: 'bin', what: 'the .bin with the raw samples' },
  { kind: 'cfg', what: 'the .cfg that the radar ran with' },
] as const;

/** The user's own files, open or waiting for others: the bundled ones are never among them. */
let own: Own = {};

/** A recording may be in several files. */
type Own = Partial<Record<Exclude<Kind, 'bin'>, File>> & { bin?: Parts };

/** The latest opening wins, should two overlap. */
let opening = 0;

/** What an opening comes to: files of the user's own, and what is shown then. */
interface Opened {
  own: Own;
  loaded: Loaded | null;
  waiting: Waiting | null;
  log: BoardLog | null;
}

async function attempt(work: () => Promise<Opened | null>, sameFiles = false): Promise<void> {
  opening += 1;
  const mine = opening;
  try {
    const next = await work();
    const before = loaded.peek();
    const linked = filesWanted.peek();
    if (mine !== opening) {
      if (next?.loaded?.kept !== before?.kept) next?.loaded?.kept.free();
      return;
    }
    batch(() => {
      fileProblem.value = null;
      if (!next) return;
      own = next.own;
      waiting.value = next.waiting;
      loaded.value = next.loaded;
      boardLog.value = next.log;
      const other = before?.kept !== next.loaded?.kept;
      update({ source: sourceOf(next.loaded) });
      if (other && !sameFiles && sourceOf(next.loaded) === 'files' && next.loaded && !linked)
        update({ frame: 'all', cell: null, board: 'last' });
      if (other) before?.kept.free();
    });
  } catch (error) {
    if (mine !== opening) return;
    fileProblem.value =
      error instanceof FileProblem
        ? { code: error.code, message: error.message, file: error.file }
        : describeError(error);
  }
}

/** Of the capture that is open. */
export const fileNames = (): string =>
  loaded
    .peek()
    ?.files.map(({ name }) => name)
    .join(', ') ?? 'no files';

/** The user's own, open or waiting for others. */
export const ownFiles = (): NamedFile[] => listed(own).map(({ file }) => ({ name: file.name, file }));

/** Every file of these with its kind, those of a split recording in their order. */
const listed = (of: Own): { kind: Kind; file: File }[] =>
  KINDS.flatMap((kind) => {
    const files = kind === 'bin' ? (of.bin?.files ?? []) : of[kind] ? [of[kind]] : [];
    return files.map((file) => ({ kind, file }));
  });

/** Puts the user's own files away. */
export function closeOwn(): void {
  if (!ownFiles().length) return;
  opening += 1;
  own = {};
  const before = loaded.peek();
  batch(() => {
    loaded.value = null;
    waiting.value = null;
    boardLog.value = null;
    fileProblem.value = null;
  });
  before?.kept.free();
}

/** What differs from the configuration in how samples are read. */
function readingNow(): Partial<ReadingOptions> {
  const { iqOrder, lanes } = readingOptions(captureState.peek());
  return { ...(iqOrder !== 'configured' && { iqOrder }), ...(lanes !== 'configured' && { lanes }) };
}

/** A configuration, read as it is asked for. */
export const configuredAs = (text: string, reading: Partial<ReadingOptions>): ConfigInput =>
  Object.keys(reading).length ? { text, ...reading } : text;

/** Reads what is open once more, in another way. */
function reread(): Promise<void> {
  const open = loaded.peek();
  if (!open || JSON.stringify(open.reading) === JSON.stringify(readingNow())) return Promise.resolve();
  return attempt(async () => {
    const reading = readingNow();
    const kept = await pool().loadCapture(open.bin, configuredAs(open.cfg, reading));
    return { own, loaded: { ...open, reading, kept, info: kept.info }, waiting: null, log: boardLog.peek() };
  }, true);
}

/** Opens what the state names when it names something else. */
export function startFiles(): () => void {
  const source = computed(() => captureState.value.source);
  const reading = computed(() => JSON.stringify(readingOptions(captureState.value)));
  const stop = effect(() => {
    void reading.value;
    void reread();
  });
  // The opening that the latest change of source started.
  let started = -1;
  const stopOpening = effect(() => {
    const wanted = source.value;
    const open = loaded.peek();
    if (sourceOf(open) === wanted) {
      // Switched back before the other source was open: its result must not replace this one.
      if (opening === started) opening += 1;
      return;
    }
    if (wanted === 'bundled') void openBundled();
    else if (wanted === 'simulated') void openSimulated();
    else {
      opening += 1;
      loaded.value = null;
      boardLog.value = null;
      open?.kept.free();
    }
    started = opening;
  });
  return () => {
    stop();
    stopOpening();
  };
}

export function openBundled(): Promise<void> {
  return attempt(async () => {
    const [bin, cfg, dat] = await Promise.all([fetched(binAddress), fetched(cfgAddress), fetched(datAddress)]);
    const text = new TextDecoder().decode(cfg);
    const name = (address: string): string =>
      decodeURIComponent(address.split('/').pop() ?? '').replace(/-[\w-]{8}(?=\.\w+$)/, '');
    const log = api.parseBoardLog(dat, text);
    const reading = readingNow();
    const kept = await pool().loadCapture(bin, configuredAs(text, reading));
    const next: Loaded = {
      files: [
        { kind: 'bin', name: name(binAddress), bytes: bin.length },
        { kind: 'cfg', name: name(cfgAddress), bytes: cfg.length },
        { kind: 'dat', name: name(datAddress), bytes: dat.length },
      ],
      bin,
      cfg: text,
      reading,
      info: kept.info,
      kept,
      bundled: { licence: licenceAddress },
      simulated: false,
      missingParts: [],
      cascade: null,
    };
    return { own: {}, loaded: next, waiting: null, log };
  });
}

/** Where a capture comes from, as the state names it. */
const sourceOf = (capture: Loaded | null) =>
  capture?.bundled ? 'bundled' : capture?.simulated ? 'simulated' : 'files';

export function openSimulated(): Promise<void> {
  return attempt(async () => {
    const { bin, cfg } = await simulateCapture();
    const reading = readingNow();
    const kept = await pool().loadCapture(bin, configuredAs(cfg, reading));
    const next: Loaded = {
      files: [
        { kind: 'bin', name: SIMULATED.bin, bytes: bin.length },
        { kind: 'cfg', name: SIMULATED.cfg, bytes: cfg.length },
      ],
      bin,
      cfg,
      reading,
      info: kept.info,
      kept,
      bundled: null,
      simulated: true,
      missingParts: [],
      cascade: null,
    };
    return { own: {}, loaded: next, waiting: null, log: null };
  });
}

async function fetched(address: string): Promise<Uint8Array> {
  const response = await fetch(address);
  if (!response.ok)
    throw new FileProblem('not-found', address, `could not be loaded: the server answered ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

/**
 * Any of a .bin, in one file or several, a .cfg and a .dat, with what is open or waits of the user's own unless they are to
 * stand alone; without both of the first two it waits.
 */
export function openFiles(files: readonly File[], alone = false): Promise<void> {
  return attempt(async () => {
    const given = chosen(files);
    if (Object.keys(given).length === 0) return null;
    const next = alone ? given : { ...own, ...given };
    // A log belongs to its capture; one that waits has none yet.
    if (given.bin && !given.dat && own.bin) delete next.dat;
    // What mmWave Studio says of a board goes with its configuration; one that waits has none yet.
    if (given.cfg && !given.setup && own.cfg) delete next.setup;
    const blame = given.bin?.files[0] ?? given.cfg ?? given.dat ?? given.setup;
    try {
      const { bin, cfg, dat, setup } = next;
      const before = own.bin ? loaded.peek() : null;
      const known = before && cfg === own.cfg && setup === own.setup;
      const text = ofSubFrame(known ? before.cfg : await configText(cfg, setup));
      const opened = listed(next).map(({ kind, file }): OpenFile => ({ kind, name: file.name, bytes: file.size }));
      if (!bin || text === undefined) {
        if (text !== undefined) api.parseConfig(text);
        const missing = NEEDED.filter(({ kind }) => !next[kind]);
        return { own: next, loaded: null, waiting: { files: opened, missing }, log: null };
      }
      const log = dat ? api.parseBoardLog(new Uint8Array(await dat.arrayBuffer()), text) : null;
      const still = before && bin === own.bin && (!bin.cascade || before.cfg === text) ? before : null;
      const { bytes: samples, warnings: cascade } = still
        ? { bytes: still.bin, warnings: still.cascade }
        : await samplesOf(bin, text);
      const reading = readingNow();
      const same = still?.cfg === text && JSON.stringify(still.reading) === JSON.stringify(reading);
      const kept = still && same ? still.kept : await pool().loadCapture(samples, configuredAs(text, reading));
      const { info } = kept;
      const missingParts = bin.missing;
      const complete = {
        files: opened,
        bin: samples,
        cfg: text,
        reading,
        info,
        kept,
        bundled: null,
        simulated: false,
        missingParts,
        cascade,
      };
      return { own: next, loaded: complete, waiting: null, log };
    } catch (error) {
      if (error instanceof FileProblem) throw error;
      const { code, message } = describeError(error);
      throw new FileProblem(code, blame?.name ?? '', message);
    }
  });
}

/** The samples of a recording, of one file or several. */
async function samplesOf(
  { files, cascade }: Parts,
  text: string,
): Promise<{ bytes: Uint8Array; warnings: readonly Warning[] | null }> {
  if (!cascade) return { bytes: new Uint8Array(await new Blob([...files]).arrayBuffer()), warnings: null };
  const read = async (file: File) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
  return pool().joinCascade(await Promise.all(files.map(read)), text);
}

/** The same files again, for another sub-frame of theirs. */
export const reopenFiles = (): Promise<void> => openFiles(ownFiles().map(({ file }) => file));

/** The configuration with the sub-frame that the state names, where it has several. */
function ofSubFrame(text: string | undefined): string | undefined {
  if (text === undefined) return undefined;
  const { subFrame, subFrames } = api.parseConfig(text);
  const wanted = Math.min(Number(captureState.peek().subFrame), subFrames - 1);
  return subFrame === wanted ? text : api.subFrameConfig(text, wanted);
}

/** The configuration as the text of a .cfg. */
async function configText(cfg: File | undefined, setup: File | undefined): Promise<string | undefined> {
  if (cfg && setup && !isStudio(cfg.name))
    throw new FileProblem('ambiguous', setup.name, `a .mmwave.json is expected with it, not “${cfg.name}”`);
  if (!cfg || !isStudio(cfg.name)) return cfg?.text();
  const [mmwave, board] = [await cfg.text(), await setup?.text()];
  return pool().studioConfig(mmwave, board).catch(failBecauseOf(cfg));
}

/** The files of one recording in order of time. */
function inOrder(samples: readonly File[]): Parts {
  try {
    const { order, ...rest } = api.recordingParts(samples.map(({ name }) => name));
    return { files: order.map((at) => samples[at] as File), ...rest };
  } catch (error) {
    if (!(error instanceof api.BoresightError)) throw error;
    // What was given is the name of the file that does not fit.
    const { given, expected } = error.details;
    throw new FileProblem(error.code, given ?? '', `expected ${expected}`);
  }
}

/** Says which file an error is about. */
const failBecauseOf =
  (file: File) =>
  (error: unknown): never => {
    const { code, message } = describeError(error);
    throw new FileProblem(code, file.name, message);
  };

/** One file of a kind at most but of samples, none too large. */
function chosen(files: readonly File[]): Own {
  const given: Own = {};
  const samples: File[] = [];
  for (const file of files) {
    const kind = kindOf(file.name);
    if (!kind)
      throw new FileProblem(
        'unknown-file',
        file.name,
        `a .bin, .cfg, .dat or .mmwave.json file is expected, not “${file.name}”`,
      );
    if (kind === 'bin') samples.push(file);
    else if (given[kind])
      throw new FileProblem(
        'ambiguous',
        file.name,
        `one ${kind === 'cfg' ? 'configuration (.cfg or .mmwave.json)' : `.${kind} file`} is expected, and there are two`,
      );
    else given[kind] = within(file, file.size);
  }
  if (samples.length > 0) {
    given.bin = inOrder(samples);
    const bytes = samples.reduce((sum, { size }) => sum + size, 0);
    within(given.bin.files[0] as File, bytes);
  }
  return given;
}

function within(file: File, bytes: number): File {
  if (bytes <= LARGEST_BYTES) return file;
  throw new FileProblem(
    'too-large',
    file.name,
    `${Math.round(bytes / 2 ** 20)} MiB; at most ${LARGEST_BYTES / 2 ** 20} MiB are expected`,
  );
}

function kindOf(name: string): Kind | undefined {
  if (isSetup(name)) return 'setup';
  if (isStudio(name)) return 'cfg';
  const extension = name.toLowerCase().split('.').pop();
  return CAPTURE_KINDS.find((kind) => kind === extension);
}
