/**
 * A session as a file: a ZIP archive with the settings of the pages in `session.json` and the user's own files beside
 * it. Nothing is taken from an archive before all of it is known to be right.
 */
import { unzipSync, Zip, ZipPassThrough } from 'fflate';
import { FileProblem } from '../data.ts';
import { PAGES, type Page } from '../state/route.ts';
import { digest } from './digest.ts';

/** Raised when a reader of the version before would misread a session. */
export const VERSION = 1;
const FORMAT = 'boresight-session';
const INDEX = 'session.json';

/** What a tab can hold beside what it works on. */
export const LARGEST_BYTES = 1024 ** 3;
const LARGEST_INDEX = 1024 ** 2;
/** The folder of a drive, and some. */
const MOST_FILES = 20_100;

export interface SessionFile {
  page: Page;
  name: string;
  file: Blob;
}

export interface Session {
  /** The page that was shown. */
  page: Page;
  /** Of each page that was seen, what its address holds. */
  settings: ReadonlyMap<Page, string>;
  files: readonly SessionFile[];
}

interface Entry {
  page: Page;
  name: string;
  bytes: number;
  /** Missing where the browser gives no digest, which needs a secure address. */
  sha256?: string;
}

const pathOf = ({ page, name }: Pick<Entry, 'page' | 'name'>): string => `${page}/${name}`;

/** Files are stored as they are: captures hardly shrink, and the others are packed by themselves. */
export async function packSession(session: Session, version: string): Promise<Blob> {
  const total = session.files.reduce((sum, { file }) => sum + file.size, 0);
  if (total > LARGEST_BYTES) throw tooLarge('The session', total);
  const parts: Uint8Array<ArrayBuffer>[] = [];
  const zip = new Zip((error, part) => {
    if (error) throw error;
    parts.push(part as Uint8Array<ArrayBuffer>);
  });
  const add = (name: string, content: Uint8Array): void => {
    const entry = new ZipPassThrough(name);
    zip.add(entry);
    entry.push(content, true);
  };
  const files: Entry[] = [];
  for (const { page, name, file } of session.files) {
    const bytes = new Uint8Array(
      await file.arrayBuffer().catch(() => {
        throw new FileProblem('not-found', name, 'it can no longer be read from where it was opened; open it again');
      }),
    );
    add(pathOf({ page, name }), bytes);
    const sha256 = await digest(bytes);
    files.push({ page, name, bytes: bytes.length, ...(sha256 ? { sha256 } : {}) });
  }
  const index = {
    format: FORMAT,
    version: VERSION,
    made: `Boresight ${version}`,
    page: session.page,
    settings: Object.fromEntries(session.settings),
    files,
  };
  add(INDEX, new TextEncoder().encode(`${JSON.stringify(index, null, 2)}\n`));
  zip.end();
  return new Blob(parts, { type: 'application/zip' });
}

const tooLarge = (name: string, bytes: number): FileProblem =>
  new FileProblem(
    'too-large',
    name,
    `${Math.round(bytes / 2 ** 20)} MiB; at most ${LARGEST_BYTES / 2 ** 20} MiB are expected`,
  );

export async function unpackSession(file: File): Promise<Session> {
  const damaged = (what: string): FileProblem => new FileProblem('damaged', file.name, `the file is damaged: ${what}`);
  if (file.size > LARGEST_BYTES + LARGEST_INDEX + 1000 * MOST_FILES) throw tooLarge(file.name, file.size);
  const archive = new Uint8Array(await file.arrayBuffer());
  const extract = (wanted: (name: string, bytes: number) => boolean): Record<string, Uint8Array> => {
    try {
      return unzipSync(archive, {
        filter: ({ name, size, originalSize }) => wanted(name, Math.max(size, originalSize)),
      });
    } catch (error) {
      if (error instanceof FileProblem) throw error;
      throw new FileProblem(
        'no-session',
        file.name,
        'it is no session, or is cut off; a .boresight file that “Save session” made is expected',
      );
    }
  };
  let [total, count] = [0, 0];
  const first = extract((name, bytes) => {
    total += bytes;
    count += 1;
    if (total > LARGEST_BYTES + LARGEST_INDEX) throw tooLarge(file.name, total);
    if (count > MOST_FILES) throw new FileProblem('too-large', file.name, `more than ${MOST_FILES} files are in it`);
    if (name === INDEX && bytes > LARGEST_INDEX) throw damaged(`${INDEX} has ${bytes} bytes`);
    return name === INDEX;
  });
  const { page, settings, files } = readIndex(first[INDEX], file.name, damaged);
  const expected = new Map(files.map((entry) => [pathOf(entry), entry]));
  const found = extract((name) => expected.has(name));
  const taken: SessionFile[] = [];
  for (const [path, { page, name, bytes, sha256 }] of expected) {
    const content = found[path];
    if (content?.length !== bytes) throw damaged(`${name} is ${content ? 'cut off' : 'not in it'}`);
    const now = sha256 && (await digest(content));
    if (now && now !== sha256) throw damaged(`${name} is not what was saved`);
    taken.push({ page, name, file: new Blob([content as Uint8Array<ArrayBuffer>]) });
  }
  return { page, settings, files: taken };
}

type Loose = Record<string, unknown>;
const isObject = (value: unknown): value is Loose =>
  typeof value === 'object' && value !== null && !Array.isArray(value);
const isPage = (value: unknown): value is Page => PAGES.some((page) => page === value);
const isEntry = (value: unknown): value is Entry =>
  isObject(value) &&
  isPage(value.page) &&
  typeof value.name === 'string' &&
  value.name !== '' &&
  Number.isSafeInteger(value.bytes) &&
  (value.sha256 === undefined || typeof value.sha256 === 'string');

function readIndex(
  content: Uint8Array | undefined,
  name: string,
  damaged: (what: string) => FileProblem,
): { page: Page; settings: Map<Page, string>; files: Entry[] } {
  const foreign = new FileProblem('no-session', name, `it is another archive: it has no ${INDEX} of a session`);
  if (!content) throw foreign;
  let index: unknown;
  try {
    index = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(content));
  } catch {
    throw damaged(`${INDEX} cannot be read`);
  }
  if (!isObject(index) || index.format !== FORMAT) throw foreign;
  const { version, page, settings, files, made } = index;
  if (typeof version !== 'number' || !(version >= 1)) throw damaged('its version is missing');
  if (version > VERSION) {
    throw new FileProblem(
      'too-new',
      name,
      `${typeof made === 'string' ? made : 'a newer Boresight'} wrote it in form ${version}, and this page reads form ${VERSION}; reload the page or use a newer one`,
    );
  }
  if (!isPage(page) || !isObject(settings) || !Array.isArray(files) || !files.every(isEntry))
    throw damaged(`${INDEX} is incomplete`);
  const known = Object.entries(settings).filter(
    (entry): entry is [Page, string] => isPage(entry[0]) && typeof entry[1] === 'string',
  );
  if (known.length !== Object.keys(settings).length) throw damaged(`its settings are not of these pages`);
  return { page, settings: new Map(known), files };
}
