/** Captures in code: where their files are, and how they are opened. */
import { isStudio, type Loaded } from '../pages/capture/files/files.ts';
import { inRepository, NEEDS } from './code.ts';
import { quoted } from './literal.ts';
import { flags } from './options.ts';
import type { Script } from './script.ts';
import { command, fileWord, shellWord } from './shell.ts';

const FOLDER = 'recordings/awr1642/';

interface Names {
  bin: string[];
  cfg: string;
  /** The board's file of mmWave Studio, where there is one. */
  setup: string | null;
  dat: string | null;
}

function namesOf({ files, bundled }: Loaded): Names {
  const path = (name: string): string => (bundled ? FOLDER + name : name);
  const named = (wanted: string): string[] => files.filter(({ kind }) => kind === wanted).map(({ name }) => path(name));
  const [cfg = '', setup = null, dat = null] = ['cfg', 'setup', 'dat'].map((kind) => named(kind)[0]);
  return { bin: named('bin'), cfg, setup, dat };
}

/** What a capture needs in words. */
export function captureNeeds(capture: Loaded): string {
  if (capture.bundled) return inRepository('the recording', FOLDER);
  const { bin, cfg, setup, dat } = namesOf(capture);
  return NEEDS.own([...bin, cfg, setup, dat].filter((name) => name !== null));
}

/** Opens a capture as `capture`, of samples `bin` and configuration `cfg`. */
export function openCapture(script: Script, capture: Loaded): void {
  const { bin, cfg, setup } = namesOf(capture);
  const { config } = capture.info;
  script.use('node:fs/promises', 'readFile').use('boresight', 'Capture');
  const { cascade, reading } = capture;
  if (cascade) {
    script.add('// A file of each chip of the cascade.');
    script.constant('parts', bin);
    script.add('const files = await Promise.all(parts.map(async (name) => ({ name, bytes: await readFile(name) })));');
  } else if (bin.length > 1) {
    script.add('// The recording is in several files.');
    script.constant('parts', bin);
    script.add('const bin = Buffer.concat(await Promise.all(parts.map((name) => readFile(name))));');
  } else script.add(`const bin = await readFile(${quoted(bin[0] ?? '')});`);
  const own = Object.keys(reading).length > 0;
  const read = (name: string): string => `await readFile(${quoted(name)}, 'utf8')`;
  let text = read(cfg);
  if (isStudio(cfg)) {
    script.use('boresight', 'initDrives', 'studioConfig').add('await initDrives();');
    text = `studioConfig(${[cfg, ...(setup === null ? [] : [setup])].map(read).join(', ')})`;
  }
  if (config.subFrames > 1) {
    script.use('boresight', 'subFrameConfig');
    text = `subFrameConfig(${text}, ${config.subFrame})`;
  }
  if (own) {
    script.constant('reading', reading);
    script.add(`const cfg = { text: ${text}, ...reading };`);
  } else script.add(`const cfg = ${text};`);
  if (cascade) {
    script.use('boresight', 'joinCascade');
    script.add('const { bytes: bin } = joinCascade(files, cfg);');
  }
  script.add('const capture = new Capture(bin, cfg);');
}

/** What stands before the commands on a capture, and how they name it. */
export function captureWords(capture: Loaded): { before: string[]; words: string[] } {
  const { bin, cfg, setup } = namesOf(capture);
  const { info } = capture;
  const joined = bin.length > 1 && !capture.cascade;
  const whole = joined ? 'capture.bin' : (bin[0] ?? '');
  // The command line looks for the board's file under the name that mmWave Studio gives it.
  const besides = cfg.replace(/(\.mmwave)?\.json$/, '.setup.json');
  return {
    before: [
      ...(joined ? [command(['cat', ...bin.map(fileWord)], ` > ${shellWord(whole)}`)] : []),
      ...(setup !== null && setup !== besides ? [command(['cp', fileWord(setup), fileWord(besides)])] : []),
    ],
    words: [
      ...[fileWord(whole), '--config', fileWord(cfg), ...flags('ReadingOptions', capture.reading)],
      ...(info.config.subFrames > 1 ? ['--subframe', String(info.config.subFrame)] : []),
    ],
  };
}

/** The board's own log, where there is one. */
export const boardLogName = (capture: Loaded): string | null => namesOf(capture).dat;
