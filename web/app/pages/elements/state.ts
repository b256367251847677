/** State of the gallery: the element that is shown, and what of its options is not as usual. */

import { elements } from 'virtual:elements';
import { computed, signal } from '@preact/signals';
import type { Caption } from '../../state/address.ts';
import { choice, codec, type Field } from '../../state/codec.ts';
import { attributesOf } from './attributes.ts';
import type { Sample } from './sample.ts';
import { SAMPLES } from './samples/index.ts';

/** Values by paths; those of attributes begin with an @. */
export type Changed = ReadonlyMap<string, unknown>;

const first = SAMPLES[0] as Sample;

/** The fields of all elements; those of one name are alike enough that a link may be read by any. */
function fieldsOf(path: string): Field<unknown>[] {
  const all = [...elements.flatMap(attributesOf), ...SAMPLES.flatMap(({ leaves }) => leaves)];
  return all.filter((leaf) => leaf.path === path).map(({ field }) => field);
}

const changed: Field<Changed> = {
  fallback: new Map(),
  read: (text) => {
    const pairs = text.split(',').map((part) => {
      const at = part.indexOf(':');
      const path = part.slice(0, at);
      const value = decodeURIComponent(part.slice(at + 1));
      return [
        path,
        fieldsOf(path)
          .map((field) => field.read(value))
          .find((one) => one !== undefined),
      ] as const;
    });
    return pairs.every(([, value]) => value !== undefined) ? new Map(pairs) : undefined;
  },
  write: (values) =>
    [...values]
      .map(([path, value]) => `${path}:${encodeURIComponent(fieldsOf(path)[0]?.write(value) ?? '')}`)
      .join(','),
};

export const elementsCodec = codec(
  {
    element: choice(
      first.tag,
      SAMPLES.map(({ tag }) => tag),
    ),
    set: changed,
  },
  ['element'],
);

export type ElementsState = typeof elementsCodec.defaults;
export const elementsState = signal<ElementsState>(elementsCodec.defaults);

export function update(patch: Partial<ElementsState>): void {
  elementsState.value = { ...elementsState.value, ...patch };
}

/** Sets an option; null puts it back to what it usually is. */
export function set(path: string, value: unknown): void {
  const { set } = elementsState.peek();
  const next = new Map(set);
  if (value === null) next.delete(path);
  else next.set(path, value);
  update({ set: next });
}

export const sample = computed(() => SAMPLES.find(({ tag }) => tag === elementsState.value.element) ?? first);

/** What the manifest says of the element that is shown. */
export const told = computed(() => {
  const found = elements.find(({ tag }) => tag === sample.value.tag);
  if (!found) throw new Error(`the manifest has no ${sample.value.tag}`);
  return found;
});

export const captionOf = ({ element }: ElementsState): Caption => ({
  data: `element ${element}`,
  settings: 'as its form has them',
});
