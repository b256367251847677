/** Page state to and from URL parameters. What cannot be read falls back to its default. */
import { type Range, within } from './range.ts';

export interface Field<T> {
  fallback: T;
  /** Undefined for what is no valid value. */
  read(text: string): T | undefined;
  write(value: T): string;
}

export interface NumberField extends Field<number> {
  range: Range;
}

export interface ChoiceField<T extends string> extends Field<T> {
  values(): readonly T[];
}

export function numberIn(fallback: number, range: Range): NumberField {
  return {
    fallback,
    range,
    read: (text) => {
      const value = Number(text);
      return text.trim() !== '' && within(value, range) ? value : undefined;
    },
    write: (value) => String(value),
  };
}

export const number = (fallback: number, [min, max]: readonly [number, number], step?: 'integer'): NumberField =>
  numberIn(fallback, { min, max, integer: step === 'integer' });

/** One of some values; a function gives those that are known only later. */
export function choice<const T extends string>(
  fallback: T,
  values: readonly T[] | (() => readonly T[]),
): ChoiceField<T> {
  return {
    fallback,
    values: () => given(values),
    read: (text) => given(values).find((value) => value === text),
    write: (value) => value,
  };
}

const given = <T>(values: readonly T[] | (() => readonly T[])): readonly T[] =>
  typeof values === 'function' ? values() : values;

export function flag(fallback: boolean): Field<boolean> {
  return {
    fallback,
    read: (text) => (text === '1' ? true : text === '0' ? false : undefined),
    write: (value) => (value ? '1' : '0'),
  };
}

export function text(fallback: string, valid: (text: string) => boolean): Field<string> {
  return { fallback, read: (value) => (valid(value) ? value : undefined), write: (value) => value };
}

/** A value that may be left to what follows from others. */
export function optional<T, F extends object>(field: F & Field<T>): Omit<F, keyof Field<T>> & Field<T | null> {
  return { ...field, fallback: null, write: (value) => (value === null ? '' : field.write(value)) };
}

/** Names from a known set, in the set's order; a dash for none. */
export function names<T extends string>(
  fallback: readonly T[],
  values: readonly T[] | (() => readonly T[]),
): Field<readonly T[]> {
  return {
    fallback,
    read: (value) => {
      const known = given(values);
      const wanted = value === '-' ? [] : value.split(',');
      return wanted.every((name) => known.includes(name as T))
        ? known.filter((name) => wanted.includes(name))
        : undefined;
    },
    write: (value) => value.join(',') || '-',
  };
}

type Fields = Record<string, Field<never>>;
export type StateOf<F> = { [K in keyof F]: F[K] extends Field<infer T> ? T : never };

export interface Codec<F> {
  fields: F;
  defaults: StateOf<F>;
  read(params: URLSearchParams): StateOf<F>;
  /** Of parameters, those that no field reads, as they stand there. */
  unreadable(params: URLSearchParams): string[];
  /** Everything but defaults that are not in `always`. */
  write(state: StateOf<F>): URLSearchParams;
}

export function codec<F extends { [K in keyof F]: Field<F[K] extends Field<infer T> ? T : never> }>(
  fields: F,
  always: readonly (keyof F)[] = [],
): Codec<F> {
  type S = StateOf<F>;
  const all = Object.entries(fields as unknown as Fields) as unknown as [keyof F & string, Field<unknown>][];
  return {
    fields,
    defaults: Object.fromEntries(all.map(([key, field]) => [key, field.fallback])) as S,
    read: (params) =>
      Object.fromEntries(
        all.map(([key, field]) => {
          const given = params.get(key);
          return [key, (given === null ? undefined : field.read(given)) ?? field.fallback];
        }),
      ) as S,
    unreadable: (params) =>
      [...params].flatMap(([key, value]) => {
        const field = all.find(([name]) => name === key)?.[1];
        return field?.read(value) === undefined ? [`${key}=${value}`] : [];
      }),
    write: (state) => {
      const params = new URLSearchParams();
      for (const [key, field] of all) {
        const value = field.write(state[key as keyof S]);
        if (always.includes(key) || value !== field.write(field.fallback)) params.set(key, value);
      }
      return params;
    },
  };
}
