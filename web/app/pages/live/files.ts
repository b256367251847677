/** Recordings and configurations that are opened here. */
import datAddress from '../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat?url';
import { describeError, FileProblem } from '../../data.ts';
import { fetched } from '../mounting/drive/drive.ts';
import { loadBundledProfile, profile } from './profile.ts';
import { liveProblem, replay } from './session.ts';

export const BUNDLED = 'xwr16xx_crw_demo_visualizer_2018_1015v2.dat';
/** What the page has read for its pace; a longer one is replayed from its file. */
const MOST_READ = 64 * 2 ** 20;

/** The latest opening wins. */
let opening = 0;

async function attempt(work: (current: () => boolean) => Promise<void>): Promise<void> {
  opening += 1;
  const mine = opening;
  try {
    await work(() => mine === opening);
  } catch (error) {
    if (mine === opening) liveProblem.value = describeError(error);
  }
}

/** The bundled recording, with its configuration. */
export function replayBundled(): Promise<void> {
  return attempt(async (current) => {
    const { signal } = new AbortController();
    const [data] = await Promise.all([fetched(BUNDLED, datAddress, signal), loadBundledProfile()]);
    if (current()) replay({ name: BUNDLED, data });
  });
}

/** A .cfg goes into the field, a .dat is replayed. */
export function openFiles(files: readonly File[]): Promise<void> {
  return attempt(async (current) => {
    const of = (end: string): File[] => files.filter(({ name }) => name.toLowerCase().endsWith(end));
    const [cfg, dat] = [of('.cfg'), of('.dat')];
    const other = files.find((file) => !cfg.includes(file) && !dat.includes(file));
    if (other) throw new FileProblem('unknown-file', other.name, 'a .dat or .cfg file is expected here');
    for (const [, second] of [cfg, dat])
      if (second)
        throw new FileProblem('ambiguous', second.name, 'one file of its kind is expected, and there are two');
    const [text, file] = [await cfg[0]?.text(), dat[0]];
    const data = file && file.size <= MOST_READ ? new Uint8Array(await file.arrayBuffer()) : file;
    if (!current()) return;
    if (cfg[0] && text !== undefined) profile.value = { name: cfg[0].name, text };
    if (file && data) replay({ name: file.name, data });
  });
}
