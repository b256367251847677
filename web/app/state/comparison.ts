/** Settings of a page that were kept as A, to compare the present ones, B, with: in the address with them. */
import { computed, type ReadonlySignal, type Signal } from '@preact/signals';
import { type Codec, type Field, type StateOf, text } from './codec.ts';
import { labelOf } from './labels.ts';
import { readable } from './route.ts';

/** A's settings as they would stand in an address. */
export const keptField = text('', (value) => /^[\w.,:;%=&+~-]{1,4000}$/.test(value));

/** Of parameters, and of those kept among them, what cannot be read, as it stands there. */
export function unreadable(codec: Pick<Codec<unknown>, 'unreadable'>, params: URLSearchParams): string[] {
  const own = codec.unreadable(params);
  const kept = params.get('a');
  if (kept === null || own.includes(`a=${kept}`)) return own;
  return [...own, ...codec.unreadable(new URLSearchParams(kept)).map((part) => `A: ${part}`)];
}

export interface Difference {
  key: string;
  /** What the page calls the setting. */
  name: string;
  /** As they stand in the address, or in words where that says nothing. */
  a: string;
  b: string;
}

export interface Comparison<S> {
  /** Null while nothing is kept. */
  kept: ReadonlySignal<S | null>;
  differences: ReadonlySignal<readonly Difference[]>;
  keep(): void;
  swap(): void;
  drop(): void;
  /** Settings in words, with in what A differs. */
  captioned(settings: string): string;
}

function words(field: Field<unknown>, value: unknown): string {
  if (typeof value === 'boolean') return value ? 'on' : 'off';
  return field.write(value).replaceAll(',', ', ') || 'as usual';
}

export function comparison<F, S extends StateOf<F> & { a: string }>(
  codec: Codec<F>,
  state: Signal<S>,
  {
    names,
    but = [],
  }: {
    /** Of fields whose controls do not say it by themselves. */
    names: Readonly<Record<string, string>>;
    /** Fields that are no settings to compare. */
    but?: readonly (keyof F & string)[];
  },
): Comparison<S> {
  const kept_ = computed(() => state.value.a);
  const kept = computed<S | null>(() =>
    kept_.value ? ({ ...codec.read(new URLSearchParams(kept_.value)), a: '' } as S) : null,
  );
  const written = (of: S): string => readable(codec.write({ ...of, a: '' }));
  const differences = computed(() => {
    const [a, b] = [kept.value, state.value];
    if (!a) return [];
    return (Object.keys(codec.fields as object) as (keyof F & string)[]).flatMap((key): Difference[] => {
      const field = codec.fields[key] as Field<unknown>;
      if (key === 'a' || but.includes(key) || field.write(a[key]) === field.write(b[key])) return [];
      const name = labelOf(codec.fields as object, key) ?? names[key] ?? key;
      return [{ key, name, a: words(field, a[key]), b: words(field, b[key]) }];
    });
  });
  return {
    kept,
    differences,
    keep: () => {
      state.value = { ...state.peek(), a: written(state.peek()) };
    },
    swap: () => {
      const a = kept.peek();
      if (a) state.value = { ...a, a: written(state.peek()) };
    },
    drop: () => {
      state.value = { ...state.peek(), a: '' };
    },
    captioned: (settings) => {
      const others = differences.peek().map(({ name, a }) => `${name} ${a}`);
      return others.length ? `${settings}. A, dashed: ${others.join(', ')}` : settings;
    },
  };
}
