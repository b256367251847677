/** What an element of the gallery is shown with: calls of a pool, which are made here and written out as code. */
import type { Pool } from 'boresight/worker';
import { Expression } from '../../code/literal.ts';
import { type Leaf, leavesOf } from '../../schema-fields.ts';
import { choice } from '../../state/codec.ts';

type Values = Readonly<Record<string, unknown>>;
// Steps are plain data: what a call gives is known where it is used.
// biome-ignore lint/suspicious/noExplicitAny: as above
type Given = any;

/** A value that is made of what calls gave, as code and as what the code does. */
export class From extends Expression {
  readonly of: (values: Given) => unknown;

  constructor(text: string, of: (values: Given) => unknown) {
    super(text);
    this.of = of;
  }
}

export const from = (text: string, of: (values: Given) => unknown): From => new From(text, of);

/** A call of a pool's function; its answer has a name. */
export interface Step {
  name: string;
  call: keyof Pool;
  args: readonly unknown[];
}

export interface Sample {
  tag: string;
  title: string;
  /** The options that the form has, beside those of the element. */
  leaves: readonly Leaf[];
  /** Options that the sample has otherwise than by default. */
  usual?: Values;
  /** What is called with the options, the usual ones among them. */
  steps(options: Values): readonly Step[];
  /** The element's properties. */
  properties(options: Values): Values;
  /** The element's settings that the sample needs. */
  settings?: Readonly<Record<string, string>>;
  /** Python for a notebook, with a line of settings. */
  python: string;
  /** A bundled recording, which steps have as `files`, and the names of its files. */
  recording?: { of: 'capture' | 'drive' | 'board'; files: readonly string[] };
}

/** The options of a record, some of which a sample sets itself. */
export const formOf = (record: string, without: readonly string[] = []): Leaf[] =>
  leavesOf(record).filter(({ path }) => !without.includes(path));

/** A choice that no record has. */
export function choiceLeaf(path: string, label: string, help: string, values: () => readonly string[], first: string) {
  const option = { name: path, help, unit: '', choices: {} };
  return { path, label, group: '', field: { ...choice(first, values), option } } as unknown as Leaf;
}

/** Values with those that come from calls in their place. */
export function resolved(value: unknown, values: Values): unknown {
  if (value instanceof From) return value.of(values);
  if (Array.isArray(value)) return value.map((one) => resolved(one, values));
  if (typeof value !== 'object' || value === null || Object.getPrototypeOf(value) !== Object.prototype) return value;
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, resolved(one, values)]));
}
