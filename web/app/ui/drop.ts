/** Files dropped anywhere go to the page that opens their kind. */
import { type ReadonlySignal, signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { describeError } from '../data.ts';
import { ARRAY_CALIBRATIONS, BOARDS, CAPTURES, DRIVES, NETWORKS, SESSIONS } from '../kinds.ts';
import { openDropped } from '../session/session.ts';
import { type Page, pageAddress, route } from '../state/route.ts';
import { droppedFiles, type NamedFile } from './entries.ts';

type Take = (files: readonly NamedFile[]) => void;

/** `address`: what of a page's state keeps it from opening something by itself. */
const KINDS: readonly { page: Page; names: RegExp; what: string; address?: Record<string, string> }[] = [
  {
    page: 'capture',
    names: CAPTURES,
    what: 'captures (.bin with .cfg or .mmwave.json, and .dat)',
    address: { source: 'files' },
  },
  { page: 'capture', names: ARRAY_CALIBRATIONS, what: 'calibrations of arrays (.calibration.json)' },
  {
    page: 'mounting',
    names: DRIVES,
    what: 'drives (.csv, .csv.gz, .h5, .mcap, .pcd, or a folder of them)',
    address: { source: 'files' },
  },
  { page: 'networks', names: NETWORKS, what: 'networks (.onnx)' },
  { page: 'live', names: BOARDS, what: 'recordings of boards (.dat)' },
];

const over = signal(false);
/** Why dropped files went nowhere. */
export const dropProblem = signal<string | null>(null);

let taker: { page: Page; take: Take } | null = null;
/** Files on their way to a page that is not there yet. */
let waiting: { page: Page; files: readonly NamedFile[] } | null = null;

/** The page that is shown takes what it can make something of, and what nobody can: it has words for that. */
function hand(files: readonly NamedFile[]): void {
  if (files.some(({ name }) => SESSIONS.test(name))) {
    openDropped(files);
    return;
  }
  const kinds = KINDS.filter(({ names }) => files.some(({ name }) => names.test(name)));
  const here = route.peek().page;
  const kind = kinds.find(({ page }) => page === here) ?? kinds[0];
  const page = kind?.page ?? taker?.page;
  if (!page) {
    const kinds = [...KINDS.map(({ what }) => what), 'sessions (.boresight)'].join(', ');
    dropProblem.value = `${files[0]?.name ?? 'The folder'}: no page opens this. What can be opened: ${kinds}.`;
  } else if (taker?.page === page) taker.take(files);
  else {
    waiting = { page, files };
    location.hash = pageAddress(page, new URLSearchParams(kind?.address));
  }
}

/** Watches for files; a browser would leave the demo for one that nobody takes. */
export function watchDrops(): () => void {
  const holdsFiles = (event: DragEvent): boolean => event.dataTransfer?.types.includes('Files') ?? false;
  const drag = (event: DragEvent): void => {
    if (!holdsFiles(event)) return;
    event.preventDefault();
    over.value = true;
  };
  const leave = (event: DragEvent): void => {
    if (event.relatedTarget === null) over.value = false;
  };
  const drop = (event: DragEvent): void => {
    if (!holdsFiles(event) || !event.dataTransfer) return;
    event.preventDefault();
    over.value = false;
    dropProblem.value = null;
    droppedFiles(event.dataTransfer).then(hand, (error: unknown) => {
      dropProblem.value = describeError(error).message;
    });
  };
  addEventListener('dragover', drag);
  addEventListener('dragleave', leave);
  addEventListener('drop', drop);
  return () => {
    removeEventListener('dragover', drag);
    removeEventListener('dragleave', leave);
    removeEventListener('drop', drop);
  };
}

/** Whether files are held over the page; `take` gets what is dropped for it. */
export function useFileDrop(page: Page, take: Take): ReadonlySignal<boolean> {
  useEffect(() => {
    const mine = { page, take };
    taker = mine;
    const brought = waiting;
    waiting = null;
    if (brought?.page === page) take(brought.files);
    return () => {
      if (taker === mine) taker = null;
    };
  }, []);
  return over;
}
