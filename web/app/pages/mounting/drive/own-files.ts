/** Drives out of the user's own files. */
import { signal } from '@preact/signals';
import type { Drive } from 'boresight';
import type { JobOptions } from 'boresight/worker';
import type { ComponentType } from 'preact';
import { aborted, api, describeError, FileProblem, pool } from '../../../data.ts';
import { DRIVES, RECORDINGS, TABLES } from '../../../kinds.ts';
import type { NamedFile } from '../../../ui/entries.ts';
import { update } from '../state.ts';
import { driveProblem, filesWanted, OWN, open } from './drive.ts';

/** What stands beside an HDF5 file, beside point clouds, and beside frames of View-of-Delft. */
const BESIDE =
  /(^|\/)(scenes|sensors|sequences|sensor|calibrated_sensor|sample_data|ego_pose|ego_motion_chassis|\d{4,9})\.json$/i;
/** What a tab can hold beside its copies in workers. */
const LARGEST_BYTES = 1024 ** 3;

/** Tables as the user gave them last. */
export const tables = signal<readonly NamedFile[]>([]);

/** Comes when the first table has columns of its own. */
export const columnsDialog = signal<ComponentType | null>(null);

/** Ends asking for the columns of files given before. */
let stopAsking = (): void => {};

/** A header without the columns that are needed. */
function lacksColumns(error: unknown): boolean {
  const cause = error instanceof FileProblem ? error.cause : null;
  if (!(cause instanceof api.BoresightError)) return false;
  const { code, details } = cause;
  return code === 'no-drive-log' || (code === 'malformed-table' && details.what.startsWith('line 1:'));
}

/** Opens files; of tables with columns of their own it is asked what these hold. */
export async function openFiles(all: readonly NamedFile[]): Promise<void> {
  const given = all.filter(({ name }) => TABLES.test(name));
  tables.value = given;
  stopAsking();
  const error = await openDrive(all);
  if (lacksColumns(error)) await ask(given, false);
}

/** Asks what the columns of the tables given last hold. */
export const changeColumns = (): Promise<void> => ask(tables.peek(), true);

async function ask(given: readonly NamedFile[], again: boolean): Promise<void> {
  if (given.length === 0) return;
  const before = driveProblem.peek();
  try {
    const [{ askColumns, cancelColumns }, { ColumnsDialog }] = await Promise.all([
      import('../columns/mapping.ts'),
      import('../columns/dialog.tsx'),
    ]);
    columnsDialog.value = ColumnsDialog;
    stopAsking = cancelColumns;
    const openThem = async (files: readonly NamedFile[]): Promise<string | null> => {
      const error = await openDrive(files, given);
      if (!error) return null;
      // What is wrong with them is said where it can be mended.
      driveProblem.value = before;
      return describeError(error).message;
    };
    await askColumns(given, openThem, again);
  } catch (error) {
    if (!aborted(error)) driveProblem.value = describeError(error);
  }
}

/** The name of a drive: that of its folder, else of its first file. */
function nameOf(all: readonly NamedFile[]): string {
  const path = (all[0] as NamedFile).name.split('/');
  return path.at(-2) ?? (path.at(-1) as string).replace(DRIVES, '');
}

/** The parts of a recording in their order: `_2` before `_10`. */
const byName = (a: NamedFile, b: NamedFile): number => a.name.localeCompare(b.name, 'en', { numeric: true });

async function readWhole(kept: readonly NamedFile[], signal: AbortSignal, job: JobOptions): Promise<Drive> {
  const files = await Promise.all(
    kept.map(async ({ name, file }) => ({ name, bytes: new Uint8Array(await file.arrayBuffer()) })),
  );
  signal.throwIfAborted();
  return pool().readDrive(files, {}, { ...job, transfer: true });
}

/** `given`: the files that those were made of, if others. */
async function openDrive(all: readonly NamedFile[], given?: readonly NamedFile[]): Promise<unknown> {
  // A link to files comes with where their radar is.
  const linked = filesWanted.peek();
  return open(
    'Reading the files',
    async (signal, job) => {
      const drives = all.filter(({ name }) => DRIVES.test(name));
      const first = all[0];
      if (!first)
        throw new FileProblem(
          'no-drive-log',
          'The folder',
          'it is empty; a .csv, .csv.gz, .h5, .mcap or .pcd with a drive is expected',
        );
      if (drives.length === 0) {
        const what = all.length === 1 ? first.name : `${all.length} files`;
        throw new FileProblem(
          'no-drive-log',
          what,
          'no drive is in it; .csv or .csv.gz tables, the radar_data.h5 of a RadarScenes sequence, an .mcap recording, or .pcd files are expected',
        );
      }
      const sequences = drives.filter(({ name }) => /\.(h5|hdf5)$/i.test(name)).length;
      if (sequences > 1)
        throw new FileProblem(
          'ambiguous',
          `${all.length} files`,
          `${sequences} sequences are in them; one is expected: open the folder of that alone`,
        );
      const recording = drives.filter(({ name }) => RECORDINGS.test(name)).sort(byName);
      const kept = recording.length ? recording : [...drives, ...all.filter(({ name }) => BESIDE.test(name))];
      const size = kept.reduce((sum, { file }) => sum + file.size, 0);
      const what = kept.length === 1 ? (kept[0] as NamedFile).name : `${kept.length} files`;
      // Of recordings no more than a piece is held.
      if (size > LARGEST_BYTES && recording.length === 0) {
        throw new FileProblem(
          'too-large',
          what,
          `${Math.round(size / 2 ** 20)} MiB; at most ${LARGEST_BYTES / 2 ** 20} MiB are expected: choose one sequence`,
        );
      }
      try {
        const drive = recording.length
          ? await pool().readDriveStream(
              recording.map(({ file }) => file),
              {},
              job,
            )
          : await readWhole(kept, signal, job);
        return {
          name: nameOf(given ?? drives),
          source: 'files',
          files: (given ?? kept).map(({ name, file }) => ({ name, bytes: file.size })),
          drive,
          truth: null,
          statedDeg: new Map(),
          licence: null,
          own: kept,
        };
      } catch (error) {
        if (aborted(error)) throw error;
        const { code, message } = describeError(error);
        throw new FileProblem(code, what, message, { cause: error });
      }
    },
    () => update({ ...(linked ? {} : OWN), source: 'files' }),
  );
}
