/** Fields of all options of a record, one by one, for a form that is made of the schema alone. */
import { $defs } from 'boresight/schema.json';
import { type OfOption, type Schema, schemaField } from './options.ts';
import type { Field } from './state/codec.ts';

/** An option that has one value. */
export interface Leaf {
  /** With dots: `iaa.iterations`. */
  path: string;
  label: string;
  /** What the record within which it stands is called; empty for the record itself. */
  group: string;
  field: Field<unknown> & OfOption;
}

/** `field-of-view` as a label. */
const words = (flag: string): string => {
  const text = flag.replaceAll('-', ' ');
  return text.charAt(0).toUpperCase() + text.slice(1);
};

const SIMPLE = ['number', 'integer', 'boolean'];

/** The options of a record that are numbers, choices or switches; lists and names of files are left out. */
export function leavesOf(record: string): Leaf[] {
  const walk = (schema: Schema, before: string, group: string): Leaf[] =>
    Object.entries(schema.properties ?? {}).flatMap(([key, one]): Leaf[] => {
      const path = before + key;
      const label = words(one['x-flag'] ?? key);
      if (one.properties) return walk(one, `${path}.`, label);
      if (!one.oneOf && !SIMPLE.includes(one.type ?? '')) return [];
      return [{ path, label, group, field: schemaField(record, path) }];
    });
  const schema = ($defs as Record<string, Schema>)[record];
  if (!schema) throw new Error(`there are no ${record}`);
  return walk(schema, '', '');
}

/** Values by their paths as the record has them. */
export function nested(values: ReadonlyMap<string, unknown>): Record<string, unknown> {
  const made: Record<string, unknown> = {};
  for (const [path, value] of values) {
    const keys = path.split('.');
    const last = keys.pop() as string;
    let at = made;
    for (const key of keys) {
      at[key] ??= {};
      at = at[key] as Record<string, unknown>;
    }
    at[last] = value;
  }
  return made;
}
