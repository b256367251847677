/** Tables whose columns the user says, and what was said of them. */
import { signal } from '@preact/signals';
import { aborted, describeError } from '../../../data.ts';
import type { NamedFile } from '../../../ui/entries.ts';
import { FIELDS, type Field, type GroupName } from './fields.ts';
import { type Choice, type Choices, guess, guessAll, lacking, type Pick, pick } from './guess.ts';
import { recall, remember } from './known.ts';
import { look, rewrite, type Table } from './table.ts';

/** A log has few tables; a folder may hold many others. */
const MOST_TABLES = 12;

export interface Mapping {
  tables: readonly Table[];
  choices: Choices;
  /** Why the tables could not be opened as they were said to be. */
  problem: string | null;
  busy: boolean;
}

/** What is asked now. */
export const mapping = signal<Mapping | null>(null);

type Open = (files: readonly NamedFile[]) => Promise<string | null>;
let open: Open = async () => null;
let controller: AbortController | undefined;

async function opened(tables: readonly Table[], choices: Choices, signal: AbortSignal): Promise<string | null> {
  const table = ({ table: name }: Choice): Table | undefined => tables.find((one) => one.name === name);
  const [detections, motion] = [table(choices.detections), table(choices.motion)];
  const files: NamedFile[] = [];
  if (detections) files.push(await rewrite('detections', detections, choices.detections, false, signal));
  if (motion) files.push(await rewrite('motion', motion, choices.motion, motion === detections, signal));
  return open(files);
}

/**
 * Asks what the columns of tables are, unless that was said before of such tables. `openThem` opens general tables, and
 * tells what is wrong with them.
 */
export async function askColumns(files: readonly NamedFile[], openThem: Open, again: boolean): Promise<void> {
  controller?.abort();
  controller = new AbortController();
  const { signal } = controller;
  const tables = await Promise.all(files.slice(0, MOST_TABLES).map(look));
  if (signal.aborted) return;
  open = openThem;
  const known = recall(tables);
  let problem: string | null = null;
  if (known && !again) {
    problem = await opened(tables, known, signal);
    if (problem === null) return;
  }
  if (!signal.aborted) mapping.value = { tables, choices: known ?? guessAll(tables), problem, busy: false };
}

export function cancelColumns(): void {
  controller?.abort();
  mapping.value = null;
}

export async function openAsSaid(): Promise<void> {
  const asked = mapping.peek();
  if (!asked || asked.busy || lacking(asked.choices).length) return;
  controller = new AbortController();
  const { signal } = controller;
  mapping.value = { ...asked, problem: null, busy: true };
  let problem: string | null;
  try {
    problem = await opened(asked.tables, asked.choices, signal);
  } catch (error) {
    if (aborted(error)) return;
    problem = describeError(error).message;
  }
  if (signal.aborted) return;
  if (problem === null) {
    remember(asked.tables, asked.choices);
    mapping.value = null;
  } else mapping.value = { ...asked, problem, busy: false };
}

function choose(group: GroupName, choice: Choice): void {
  const asked = mapping.peek();
  if (asked) mapping.value = { ...asked, problem: null, choices: { ...asked.choices, [group]: choice } };
}

export function chooseTable(group: GroupName, name: string): void {
  const table = mapping.peek()?.tables.find((one) => one.name === name);
  choose(group, table ? guess(group, table) : { table: null, picks: {} });
}

export function chooseColumn(group: GroupName, field: Field, column: string): void {
  const asked = mapping.peek();
  const choice = asked?.choices[group];
  const table = asked?.tables.find((one) => one.name === choice?.table);
  if (!choice || !table) return;
  const { [field.name]: _, ...others } = choice.picks;
  choose(group, { ...choice, picks: column ? { ...others, [field.name]: pick(field, table, column) } : others });
}

export function changePick(group: GroupName, field: Field, change: Partial<Pick>): void {
  const choice = mapping.peek()?.choices[group];
  const before = choice?.picks[field.name];
  if (choice && before)
    choose(group, { ...choice, picks: { ...choice.picks, [field.name]: { ...before, ...change } } });
}

export const GROUPS = Object.keys(FIELDS) as GroupName[];
