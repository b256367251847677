/** Files that are open: the bundled capture, or what the user chose or dropped. */
import { signal } from '@preact/signals';
import type { BoardLog, CaptureInfo } from 'boresight';
import licenceAddress from '../../../../recordings/awr1642/LICENSE?url';
import cfgAddress from '../../../../recordings/awr1642/profile.cfg?url';
import binAddress from '../../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin?url';
import datAddress from '../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat?url';
import { api, describeError, FileProblem, type Problem } from '../../data.ts';
import { update } from './state.ts';

const KINDS = ['bin', 'cfg', 'dat'] as const;
type Kind = (typeof KINDS)[number];

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
  info: CaptureInfo;
  bundled: { licence: string } | null;
}

export const loaded = signal<Loaded | null>(null);
export const boardLog = signal<BoardLog | null>(null);
export const fileProblem = signal<(Problem & { file?: string }) | null>(null);

/** What a tab can hold beside its copies in workers. */
const LARGEST_BYTES = 512 * 1024 * 1024;

/** The latest opening wins, should two overlap. */
let opening = 0;

async function attempt(work: () => Promise<() => void>): Promise<void> {
  opening += 1;
  const mine = opening;
  try {
    const finish = await work();
    if (mine !== opening) return;
    finish();
    fileProblem.value = null;
  } catch (error) {
    if (mine !== opening) return;
    fileProblem.value =
      error instanceof FileProblem
        ? { code: error.code, message: error.message, file: error.file }
        : describeError(error);
  }
}

export function openBundled(): Promise<void> {
  return attempt(async () => {
    const [bin, cfg, dat] = await Promise.all([fetched(binAddress), fetched(cfgAddress), fetched(datAddress)]);
    const text = new TextDecoder().decode(cfg);
    const name = (address: string): string =>
      decodeURIComponent(address.split('/').pop() ?? '').replace(/-[\w-]{8}(?=\.\w+$)/, '');
    const next: Loaded = {
      files: [
        { kind: 'bin', name: name(binAddress), bytes: bin.length },
        { kind: 'cfg', name: name(cfgAddress), bytes: cfg.length },
        { kind: 'dat', name: name(datAddress), bytes: dat.length },
      ],
      bin,
      cfg: text,
      info: inspect(bin, text),
      bundled: { licence: licenceAddress },
    };
    const log = api.parseBoardLog(dat, text);
    return () => {
      loaded.value = next;
      boardLog.value = log;
    };
  });
}

async function fetched(address: string): Promise<Uint8Array> {
  const response = await fetch(address);
  if (!response.ok)
    throw new FileProblem('not-found', address, `could not be loaded: the server answered ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

/** Any of a .bin, a .cfg and a .dat; what is missing is kept from what is open. */
export function openFiles(files: readonly File[]): Promise<void> {
  return attempt(async () => {
    const given = new Map<Kind, File>();
    for (const file of files) {
      const kind = kindOf(file.name);
      if (!kind)
        throw new FileProblem('unknown-file', file.name, `a .bin, .cfg or .dat file is expected, not “${file.name}”`);
      if (given.has(kind))
        throw new FileProblem('ambiguous', file.name, `one .${kind} file is expected, and there are two`);
      if (file.size > LARGEST_BYTES) {
        throw new FileProblem(
          'too-large',
          file.name,
          `${Math.round(file.size / 2 ** 20)} MiB; at most ${LARGEST_BYTES / 2 ** 20} MiB are expected`,
        );
      }
      given.set(kind, file);
    }
    if (given.size === 0) return () => {};
    const before = loaded.peek();
    const cfgFile = given.get('cfg');
    const binFile = given.get('bin');
    const datFile = given.get('dat');
    const cfg = cfgFile ? await cfgFile.text() : before?.cfg;
    if (cfg === undefined)
      throw new FileProblem('missing', binFile?.name ?? '', 'the .cfg that the radar ran with is needed beside it');
    const bin = binFile ? new Uint8Array(await binFile.arrayBuffer()) : before?.bin;
    if (!bin) throw new FileProblem('missing', cfgFile?.name ?? '', 'a .bin with raw samples is needed beside it');
    const blame = binFile ?? cfgFile ?? datFile;
    try {
      const info = binFile || cfgFile ? inspect(bin, cfg) : before!.info;
      const log = datFile
        ? api.parseBoardLog(new Uint8Array(await datFile.arrayBuffer()), cfg)
        : binFile
          ? null
          : boardLog.peek();
      const entry = (kind: Kind, file: File | undefined): OpenFile | undefined =>
        file ? { kind, name: file.name, bytes: file.size } : before?.files.find((open) => open.kind === kind);
      const files = [
        entry('bin', binFile),
        entry('cfg', cfgFile),
        datFile || !binFile ? entry('dat', datFile) : undefined,
      ].filter((item) => item !== undefined);
      const next: Loaded = { files, bin, cfg, info, bundled: null };
      return () => {
        loaded.value = next;
        boardLog.value = log;
        if (binFile || cfgFile) update({ frame: 'all', cell: null, board: 'last' });
      };
    } catch (error) {
      const { code, message } = describeError(error);
      throw new FileProblem(code, blame?.name ?? '', message);
    }
  });
}

function kindOf(name: string): Kind | undefined {
  const extension = name.toLowerCase().split('.').pop();
  return KINDS.find((kind) => kind === extension);
}

/** Checks that the two go together. */
function inspect(bin: Uint8Array, cfg: string): CaptureInfo {
  const capture = new api.Capture(bin, cfg);
  try {
    return capture.info;
  } finally {
    capture.free();
  }
}
