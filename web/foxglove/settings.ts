/** Settings of a panel: what the editor of the application shows, and what is kept with the layout. */
import type { Immutable, SettingsTreeAction, SettingsTreeField, SettingsTreeNodes, Topic } from '@foxglove/extension';

/** A setting: how it is edited and read. */
export interface Setting<T> {
  group: string;
  label: string;
  help: string;
  fallback: T;
  /** The editor's field. */
  field(value: T, topics: readonly Topic[]): EditorField;
  /** A value as it is kept or edited; undefined for what is none. */
  read(given: unknown): T | undefined;
}

/** What a kind of setting says of the editor's field; label and help are said once. */
type EditorField = SettingsTreeField extends infer F ? (F extends unknown ? Omit<F, 'label' | 'help'> : never) : never;

type Words = Pick<Setting<unknown>, 'group' | 'label' | 'help'>;

export type Settings = Record<string, Setting<unknown>>;
export type ValuesOf<S> = { [K in keyof S]: S[K] extends Setting<infer T> ? T : never };

/** A topic by its name; empty for the first that fits. */
export function topicSetting(words: Words, fitting: (topics: readonly Topic[]) => readonly Topic[]): Setting<string> {
  return {
    ...words,
    fallback: '',
    field(value, topics) {
      const names = fitting(topics).map(({ name }) => name);
      const known = value === '' || names.includes(value);
      const first = names[0] ?? 'none';
      return {
        input: 'select',
        value,
        options: [
          { label: `automatic (${first})`, value: '' },
          ...names.map((name) => ({ label: name, value: name })),
          ...(known ? [] : [{ label: value, value }]),
        ],
        ...(known ? {} : { warning: 'The data have no such topic.' }),
      };
    },
    read: (given) => (typeof given === 'string' ? given : undefined),
  };
}

export interface NumberRange {
  min: number;
  max: number;
  step: number;
}

/** A number that may be left open. */
export function maybeNumber(words: Words, { min, max, step }: NumberRange): Setting<number | null> {
  return {
    ...words,
    fallback: null,
    field: (value) => ({
      input: 'number',
      min,
      max,
      step,
      placeholder: 'not given',
      ...(value === null ? {} : { value }),
    }),
    read: (given) => (given === undefined || given === null ? null : inRange(given, min, max)),
  };
}

export function numberSetting(words: Words, fallback: number, { min, max, step }: NumberRange): Setting<number> {
  return {
    ...words,
    fallback,
    field: (value) => ({ input: 'number', min, max, step, value }),
    read: (given) => (given === undefined ? fallback : inRange(given, min, max)),
  };
}

const inRange = (given: unknown, min: number, max: number): number | undefined =>
  typeof given === 'number' && given >= min && given <= max ? given : undefined;

/** One of some values, by their words. */
export function choiceSetting<const V extends string>(words: Words, options: Readonly<Record<V, string>>): Setting<V> {
  const values = Object.keys(options) as V[];
  return {
    ...words,
    fallback: values[0] as V,
    field: (value) => ({
      input: 'select',
      value,
      options: values.map((one) => ({ label: options[one], value: one })),
    }),
    read: (given) => values.find((one) => one === given),
  };
}

/** The values that a layout has kept; what cannot be read falls back. */
export function kept<S extends Settings>(settings: S, state: unknown): ValuesOf<S> {
  const given = typeof state === 'object' && state !== null ? (state as Record<string, unknown>) : {};
  return Object.fromEntries(
    Object.entries(settings).map(([key, { fallback, read }]) => [
      key,
      key in given ? (read(given[key]) ?? fallback) : fallback,
    ]),
  ) as ValuesOf<S>;
}

/** The values after an action of the editor; null where it changes none. */
export function edited<S extends Settings>(
  settings: S,
  values: ValuesOf<S>,
  action: Immutable<SettingsTreeAction>,
): ValuesOf<S> | null {
  if (action.action !== 'update') return null;
  const key = action.payload.path.at(-1) ?? '';
  const setting = Object.hasOwn(settings, key) ? settings[key] : undefined;
  const value = setting?.read(action.payload.value);
  return value === undefined ? null : { ...values, [key]: value };
}

/** The editor's tree: a node for each group, in the order of the settings. */
export function tree<S extends Settings>(
  settings: S,
  values: ValuesOf<S>,
  topics: readonly Topic[],
  actions: { id: string; label: string }[],
): SettingsTreeNodes {
  const nodes: SettingsTreeNodes = {};
  for (const [key, setting] of Object.entries(settings)) {
    const id = setting.group.toLowerCase().replaceAll(' ', '-');
    nodes[id] ??= { label: setting.group, fields: {} };
    const { label, help } = setting;
    const field = { ...setting.field(values[key as keyof S], topics), label, help } as SettingsTreeField;
    Object.assign(nodes[id].fields ?? {}, { [key]: field });
  }
  const first = Object.values(nodes)[0];
  if (first && actions.length)
    first.actions = actions.map((one) => ({ type: 'action' as const, display: 'menu' as const, ...one }));
  return nodes;
}
