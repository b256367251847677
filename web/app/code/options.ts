/** Options as the package takes them: without what is so by default, and as flags of the command line. */
import { described, type Schema } from '../options.ts';
import { numeral } from './literal.ts';
import { flagged } from './shell.ts';

/** Options of a record of the schema, with what the page hands over beside it. */
export type Options = Readonly<Record<string, unknown>>;

/** `Record`, or `Record.path` for a record within it. */
function recordAt(name: string): Schema {
  const [record = '', ...path] = name.split('.');
  return described(record, path.join('.'));
}

const isRecord = (value: unknown): value is Options =>
  typeof value === 'object' && value !== null && Object.getPrototypeOf(value) === Object.prototype;

function same(a: unknown, b: unknown): boolean {
  if (Array.isArray(a) && Array.isArray(b)) return a.length === b.length && a.every((one, i) => same(one, b[i]));
  return a === b;
}

/**
 * Options without those that are as the schema has them by default. `keep` names those that mean something else where they
 * are absent. What the schema does not know stays.
 */
export function withoutDefaults<T extends object>(name: string, options: T, keep: readonly string[] = []): Partial<T> {
  return without(recordAt(name), options as Options, keep) as Partial<T>;
}

function without({ properties = {}, required = [] }: Schema, options: Options, keep: readonly string[]): Options {
  const kept = Object.entries(options).flatMap(([key, value]): [string, unknown][] => {
    const schema = properties[key];
    if (value === undefined) return [];
    if (!schema || keep.includes(key) || required.includes(key)) return [[key, value]];
    if (schema.properties && isRecord(value)) {
      const inner = without(schema, value, []);
      return Object.keys(inner).length ? [[key, inner]] : [];
    }
    return schema.default !== undefined && same(value, schema.default) ? [] : [[key, value]];
  });
  return Object.fromEntries(kept);
}

const written = (value: unknown): string =>
  Array.isArray(value) ? value.map(written).join(',') : typeof value === 'number' ? numeral(value) : String(value);

/**
 * Words of the command line for options of a record that are not as they are by default; `keep` is given anyway. `prefix`
 * is what the flags of all begin with.
 */
export function flags(name: string, options: object, keep: readonly string[] = [], prefix = ''): string[] {
  const schema = recordAt(name);
  return flagsOf(schema, without(schema, options as Options, keep), prefix, name);
}

function flagsOf({ properties = {} }: Schema, options: Options, before: string, name: string): string[] {
  return Object.entries(options).flatMap(([key, value]) => {
    const schema = properties[key];
    const own = schema?.['x-flag'];
    if (!schema || own === undefined) throw new Error(`${name} have no ${key} on the command line`);
    const flag = before + own;
    if (schema.properties && isRecord(value)) return flagsOf(schema, value, `${flag}-`, `${name}.${key}`);
    if (typeof value === 'boolean')
      return value === (schema.default === true) ? [] : [value ? `--${flag}` : `--no-${flag}`];
    return flagged(flag, written(value));
  });
}

/** A record as `azimuth=12,power=-3`, of what is not so by default; `keep` is given anyway. */
export function pairs(name: string, options: object, keep: readonly string[] = []): string {
  const { properties = {} } = recordAt(name);
  const kept = withoutDefaults(name, options, keep);
  return Object.entries(kept)
    .map(([key, value]) => `${properties[key]?.['x-flag'] ?? key}=${written(value)}`)
    .join(',');
}
