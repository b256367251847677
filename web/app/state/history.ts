/** Undo and redo of a page's settings: what its address held before. */
import { computed, signal } from '@preact/signals';
import { type Page, route } from './route.ts';

interface Past {
  entries: readonly string[];
  at: number;
}

/** Changes nearer to each other are one: keys of a number, the steps of a drag. */
const TOGETHER_MS = 700;
const MOST = 100;
/** Parameters that say where one looks: they change while something plays. */
export const LOOKING = ['t', 'view', 'cell', 'frame'];

const pasts = signal<ReadonlyMap<Page, Past>>(new Map());
const past = computed<Past>(() => pasts.value.get(route.value.page) ?? { entries: [], at: -1 });

export const canUndo = computed(() => past.value.at > 0);
export const canRedo = computed(() => past.value.at < past.value.entries.length - 1);

const settings = (params: URLSearchParams): string => {
  const kept = new URLSearchParams(params);
  for (const key of LOOKING) kept.delete(key);
  return kept.toString();
};

let changedAt = 0;

/** Notes what a page's settings are now. */
export function note(page: Page, params: URLSearchParams): void {
  const now = performance.now();
  const { entries, at } = pasts.peek().get(page) ?? { entries: [], at: -1 };
  const before = entries[at];
  if (before !== undefined && settings(new URLSearchParams(before)) === settings(params)) return;
  const soon = at > 0 && now - changedAt < TOGETHER_MS;
  changedAt = now;
  const kept = [...entries.slice(0, soon ? at : at + 1), params.toString()].slice(-MOST);
  pasts.value = new Map(pasts.peek()).set(page, { entries: kept, at: kept.length - 1 });
}

/** The settings one step back (-1) or forward (1), which are then the present ones; null where there are none. */
export function step(by: -1 | 1): URLSearchParams | null {
  const { entries, at } = past.peek();
  const entry = entries[at + by];
  if (entry === undefined) return null;
  changedAt = 0;
  pasts.value = new Map(pasts.peek()).set(route.peek().page, { entries, at: at + by });
  return new URLSearchParams(entry);
}
