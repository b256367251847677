/** Saving all pages' settings and the user's own files as one file, and opening it. */
import { signal } from '@preact/signals';
import { download, fileName } from '../../plots/save.ts';
import { api, describeError, FileProblem } from '../data.ts';
import * as networks from '../networks/load.ts';
import * as capture from '../pages/capture/files/open.ts';
import * as mounting from '../pages/mounting/drive/drive.ts';
import { openFiles as openDriveFiles } from '../pages/mounting/drive/own-files.ts';
import { goTo } from '../state/address.ts';
import { announce } from '../state/announce.ts';
import { lastParams, PAGES, type Page, route, setParams, TITLES } from '../state/route.ts';
import type { NamedFile } from '../ui/entries.ts';
import type { Session, SessionFile } from './format.ts';

/** What is done with a session now. */
export const working = signal<'saving' | 'opening' | null>(null);
export const sessionProblem = signal<string | null>(null);
/** A session that waits for the answer whether it may replace the user's own files. */
export const asking = signal<{ name: string; replaced: readonly string[]; session: Session } | null>(null);

interface Own {
  files(): readonly NamedFile[];
  close(): void;
  /** In place of what is open; what is wrong with them is thrown, or said on their page. */
  open(files: readonly NamedFile[]): Promise<void>;
}

/** The user's own files, by the page that opens them. */
const OWN: readonly (readonly [Page, Own])[] = [
  [
    'capture',
    {
      files: capture.ownFiles,
      close: capture.closeOwnFiles,
      open: (files) =>
        capture.openFiles(
          files.map(({ file }) => file),
          true,
        ),
    },
  ],
  ['mounting', { files: mounting.ownFiles, close: mounting.closeOwn, open: openDriveFiles }],
  // Networks stand beside each other.
  ['networks', { files: networks.ownFiles, close: () => {}, open: networks.openOwn }],
];

async function attempt(what: 'saving' | 'opening', work: () => Promise<void>): Promise<void> {
  if (working.peek()) return;
  working.value = what;
  sessionProblem.value = null;
  try {
    await work();
  } catch (error) {
    sessionProblem.value = `The session was not ${what === 'saving' ? 'saved' : 'opened'}. ${describeError(error).message}`;
  } finally {
    working.value = null;
  }
}

export function saveSession(): Promise<void> {
  return attempt('saving', async () => {
    const { packSession } = await import('./format.ts');
    const { page } = route.peek();
    const settings = new Map(
      PAGES.flatMap((one) => (lastParams(one) ? [[one, String(lastParams(one))] as const] : [])),
    );
    const files = OWN.flatMap(([one, own]): SessionFile[] =>
      own.files().map(({ name, file }) => ({ page: one, name, file })),
    );
    const packed = await packSession({ page, settings, files }, api.version());
    const date = new Date().toISOString().slice(0, 10);
    download(packed, fileName(['session', page, date], 'boresight'));
    announce('The session is saved.', 0);
  });
}

/** Opens a session at once where that replaces no file of the user's, else asks before. */
export function openSession(file: File): Promise<void> {
  return attempt('opening', async () => {
    const { unpackSession } = await import('./format.ts');
    const session = await unpackSession(file);
    const replaced = [...capture.ownFiles(), ...mounting.ownFiles()].map(({ name }) => name);
    if (replaced.length) asking.value = { name: file.name, replaced, session };
    else await apply(file.name, session);
  });
}

export function answer(open: boolean): void {
  const asked = asking.peek();
  asking.value = null;
  if (asked && open) void attempt('opening', () => apply(asked.name, asked.session));
}

async function apply(name: string, session: Session): Promise<void> {
  const given = new Map(OWN.map(([page]) => [page, session.files.filter((file) => file.page === page)]));
  for (const [page, own] of OWN) {
    const files = given.get(page) ?? [];
    if (!files.length) continue;
    await own.open(files.map(({ name, file }) => ({ name, file: new File([file], name) })));
    const open = new Set(own.files().map((file) => file.name));
    const refused = files.find((file) => !open.has(file.name));
    if (refused) throw new FileProblem('refused', refused.name, `it could not be opened on the page ${TITLES[page]}`);
  }
  for (const [page, own] of OWN) if (!given.get(page)?.length) own.close();
  for (const page of PAGES) if (!session.settings.has(page)) setParams(page, null);
  for (const [page, settings] of session.settings) goTo(page, new URLSearchParams(settings), page === session.page);
  if (!session.settings.has(session.page)) goTo(session.page, new URLSearchParams(), true);
  announce(`${name} is open.`, 0);
}

/** Sessions come alone. */
export function openDropped(files: readonly NamedFile[]): void {
  const [first] = files;
  if (first && files.length === 1) void openSession(first.file);
  else {
    const problem = new FileProblem('ambiguous', `${files.length} files`, 'a session comes alone; open it by itself');
    sessionProblem.value = describeError(problem).message;
  }
}
