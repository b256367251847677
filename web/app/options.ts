/** The options of the package as fields of a page's state: what the schema says of them is said nowhere else. */
import type {
  ArrayCalibrationOptions,
  CalibrationOptions,
  DetectionOptions,
  ReadingOptions,
  RegionChainOptions,
  SharedEstimatorOptions,
  SimulateDriveOptions,
  StreetOptions,
} from 'boresight';
import { $defs } from 'boresight/schema.json';
import { type ChoiceField, choice, type Field, flag, type NumberField, numberIn, optional } from './state/codec.ts';

interface Records {
  ArrayCalibrationOptions: ArrayCalibrationOptions;
  CalibrationOptions: CalibrationOptions;
  DetectionOptions: DetectionOptions;
  ReadingOptions: ReadingOptions;
  RegionChainOptions: RegionChainOptions;
  SharedEstimatorOptions: SharedEstimatorOptions;
  SimulateDriveOptions: SimulateDriveOptions;
  StreetOptions: StreetOptions;
}

/** Names with dots: `cfar.rank`, and `cfar.guardCells.0` for a number of an array. */
type Path<T> = {
  [K in keyof T & (string | number)]: NonNullable<T[K]> extends infer V
    ? V extends readonly [unknown, unknown]
      ? `${K}.0` | `${K}.1`
      : V extends string | number | bigint | boolean | readonly unknown[]
        ? `${K}`
        : `${K}.${Path<V>}`
    : never;
}[keyof T & (string | number)];

type At<T, P extends string> = P extends `${infer K}.${infer Rest}`
  ? At<NonNullable<T[K & keyof T]>, Rest>
  : P extends keyof T
    ? NonNullable<T[P]>
    : number;

/** What the schema says of an option. */
export interface Option {
  /** With the record it belongs to. */
  name: string;
  help: string;
  unit: string;
  /** What each choice is. */
  choices: Readonly<Record<string, string>>;
}

export interface OfOption {
  option: Option;
}

type FieldOf<V> = OfOption &
  ([V] extends [boolean] ? Field<boolean> : [V] extends [string] ? ChoiceField<V> : NumberField);
type MaybeOf<V> = Omit<FieldOf<V>, keyof Field<V>> & Field<V | null>;

/** What a page has otherwise, for a reason of its own. */
interface Own<V> {
  fallback?: V;
  min?: V & number;
  max?: V & number;
}

export interface Schema {
  description?: string;
  type?: string;
  minimum?: number;
  exclusiveMinimum?: number;
  maximum?: number;
  default?: unknown;
  'x-unit'?: string;
  /** What the option is called on the command line. */
  'x-flag'?: string;
  oneOf?: { const: string; description: string }[];
  properties?: Record<string, Schema>;
  required?: readonly string[];
  items?: Schema;
  additionalProperties?: Schema | false;
}

/** A number of an array is described where the array is. */
function inner(outer: Schema, key: string): Schema | undefined {
  if (outer.properties) return outer.properties[key];
  const { default: list, items, additionalProperties, ...rest } = outer;
  const one = items ?? additionalProperties;
  return one ? { ...rest, ...one, default: Array.isArray(list) ? list[Number(key)] : undefined } : undefined;
}

/** What the schema says of a record, or of what a path leads to from it. */
export function described(record: string, path = ''): Schema {
  let at: Schema | undefined = ($defs as Record<string, Schema>)[record];
  for (const key of path.split('.').filter(Boolean)) at &&= inner(at, key);
  if (!at) throw new Error(`${record} have no ${path}`);
  return at;
}

/** The options of a record. */
export function optionsOf<N extends keyof Records>(record: N) {
  type R = Records[N];

  function optionAt(path: string): { schema: Schema; option: Option } {
    const schema = described(record, path);
    const choices = Object.fromEntries((schema.oneOf ?? []).map((one) => [one.const, one.description]));
    return {
      schema,
      option: {
        name: `${record}.${path}`,
        help: (schema.description ?? '').replaceAll('`', ''),
        unit: (schema['x-unit'] ?? '').replace('deg', '°'),
        choices,
      },
    };
  }

  function make(path: string, own: Own<unknown>, fallback: unknown): object {
    const { schema, option } = optionAt(path);
    if (schema.oneOf) return { ...choice(fallback as string, Object.keys(option.choices)), option };
    if (schema.type === 'boolean') return { ...flag(fallback as boolean), option };
    const above = schema.exclusiveMinimum !== undefined && own.min === undefined;
    const range = {
      min: own.min ?? schema.exclusiveMinimum ?? schema.minimum ?? Number.NEGATIVE_INFINITY,
      max: own.max ?? schema.maximum ?? Number.POSITIVE_INFINITY,
      above,
      integer: schema.type === 'integer',
    };
    return { ...numberIn(fallback as number, range), option };
  }

  return {
    /** An option with its default. */
    field<P extends Path<R>>(path: P, own: Own<At<R, P>> = {}): FieldOf<At<R, P>> {
      const fallback = own.fallback ?? described(record, path).default;
      if (fallback === undefined) throw new Error(`${record}.${path} has no default`);
      return make(path, own, fallback) as FieldOf<At<R, P>>;
    },

    /** An option that may be left to what follows from others. */
    maybe<P extends Path<R>>(path: P, own: Own<At<R, P>> = {}): MaybeOf<At<R, P>> {
      const field = optional(make(path, own, null) as OfOption & Field<unknown>);
      const help = field.option.help.replace('if absent', 'if empty');
      return { ...field, option: { ...field.option, help } } as unknown as MaybeOf<At<R, P>>;
    },

    /** A choice that may be left to what follows from others, which has a name in the address. */
    or<P extends Path<R>, const T extends string>(path: P, none: T): OfOption & ChoiceField<T | (At<R, P> & string)> {
      const { option } = optionAt(path);
      const values = Object.keys(option.choices) as (At<R, P> & string)[];
      return { ...choice<T | (At<R, P> & string)>(none, [none, ...values]), option };
    },

    /** Some values of an option, as they are written in the address. */
    picks<const T extends string>(path: Path<R>, values: readonly T[], fallback?: T): OfOption & ChoiceField<T> {
      const { schema, option } = optionAt(path);
      const usual = values.find((value) => value === schema.default || Number(value) === schema.default);
      const first = fallback ?? usual;
      if (first === undefined) throw new Error(`the default of ${option.name} is not among ${values}`);
      return { ...choice<T>(first, values), option };
    },
  };
}

/** An option as a field, by the names of record and option alone; null where it has no default. */
export function schemaField(record: string, path: string): Field<unknown> & OfOption {
  const options = optionsOf(record as 'CalibrationOptions');
  const known = path as 'minInliers';
  const has = described(record, path).default !== undefined;
  return (has ? options.field(known) : options.maybe(known)) as unknown as Field<unknown> & OfOption;
}

/** A share that the page has in percent. */
export function percent(share: MaybeOf<number>): MaybeOf<number> {
  const of = (value: number): number => Number((value * 100).toPrecision(12));
  const range = { ...share.range, min: of(share.range.min), max: of(share.range.max) };
  return { ...optional(numberIn(0, range)), option: { ...share.option, unit: '%' } };
}
