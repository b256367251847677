/** Settings of an element as fields: what its manifest says of each attribute. */
import type { elements } from 'virtual:elements';
import type { Leaf } from '../../schema-fields.ts';
import { choice, type Field, numberIn, optional, text } from '../../state/codec.ts';

export type Told = (typeof elements)[number];

const ANY = { min: Number.NEGATIVE_INFINITY, max: Number.POSITIVE_INFINITY };

function fieldOf(type: string): Field<unknown> {
  if (type === 'number') return optional(numberIn(0, ANY)) as Field<unknown>;
  const values = [...type.matchAll(/'([^']+)'/g)].map(([, value]) => value as string);
  const usual = values.includes('auto') ? 'auto' : values[0];
  if (usual !== undefined) return choice(usual, values) as unknown as Field<unknown>;
  return text('', () => true) as Field<unknown>;
}

/** A unit stands at the end of a description's first part, or in the name. */
const unitOf = ({ name, description }: Told['attributes'][number]): string =>
  name.endsWith('-deg') || /, deg\b/.test(description)
    ? '°'
    : name.endsWith('-db') || /, dB\b/.test(description)
      ? 'dB'
      : name.endsWith('-m') || /, m\b/.test(description)
        ? 'm'
        : '';

/** One field for each attribute. */
export function attributesOf({ attributes }: Told): Leaf[] {
  return attributes.map((attribute) => {
    const { name, type, description } = attribute;
    const words = name.replace(/-(deg|db|m)$/, '').replaceAll('-', ' ');
    const help = `${description.charAt(0).toUpperCase()}${description.slice(1)}.`;
    return {
      path: `@${name}`,
      label: words.charAt(0).toUpperCase() + words.slice(1),
      group: '',
      field: { ...fieldOf(type), option: { name: `@${name}`, help, unit: unitOf(attribute), choices: {} } },
    };
  });
}
