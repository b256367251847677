/** What the columns of a table were said to hold, kept in this browser for the next table with the same columns. */
import { FIELDS, type GroupName } from './fields.ts';
import type { Choice, Choices } from './guess.ts';
import type { Table } from './table.ts';

const KEY = 'boresight-columns';
/** Kinds of tables, the latest first. */
const MOST = 30;

type Picks = Choice['picks'];
interface Kind {
  columns: readonly string[];
  /** A group is missing where the table gave none of it. */
  groups: Partial<Record<GroupName, Picks>>;
}

const GROUPS = Object.keys(FIELDS) as GroupName[];
const same = (a: readonly string[], b: readonly string[]): boolean =>
  a.length === b.length && a.every((name, i) => name === b[i]);

function read(): Kind[] {
  try {
    const kinds: unknown = JSON.parse(localStorage.getItem(KEY) ?? '[]');
    return Array.isArray(kinds) ? kinds.filter((kind) => Array.isArray(kind?.columns) && kind.groups) : [];
  } catch {
    return [];
  }
}

/** The choices made for tables of the same columns, or null where one of them was never seen. */
export function recall(tables: readonly Table[]): Choices | null {
  const kinds = read();
  const found = tables.map((table) => kinds.find(({ columns }) => same(columns, table.columns)));
  if (found.includes(undefined)) return null;
  const of = (group: GroupName): Choice => {
    const at = found.findIndex((kind) => kind?.groups[group]);
    return { table: tables[at]?.name ?? null, picks: found[at]?.groups[group] ?? {} };
  };
  const choices = { detections: of('detections'), motion: of('motion') };
  return choices.detections.table === null ? null : choices;
}

export function remember(tables: readonly Table[], choices: Choices): void {
  const now = tables.map(({ name, columns }): Kind => {
    const mine = GROUPS.filter((group) => choices[group].table === name);
    return { columns, groups: Object.fromEntries(mine.map((group) => [group, choices[group].picks])) };
  });
  const before = read().filter(({ columns }) => !now.some((kind) => same(kind.columns, columns)));
  try {
    localStorage.setItem(KEY, JSON.stringify([...now, ...before].slice(0, MOST)));
  } catch {
    // It is asked again the next time.
  }
}
