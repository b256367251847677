/** Settings of an element as fields: what its manifest says of each attribute. */
import { elements } from 'virtual:elements';
import type { Leaf } from '../../schema-fields.ts';
import { choice, type Field, flag, numberIn, optional, text } from '../../state/codec.ts';

export type Told = (typeof elements)[number];

/** What numbers make sense in a form, by their unit; elements themselves take any. */
const RANGES: Readonly<Record<string, readonly [min: number, max: number]>> = {
  '°': [-360, 360],
  dB: [-300, 300],
  m: [-1000, 1000],
  '': [0, 1000],
};

/** Of a choice that is left to the element. */
export const USUAL = 'usual';

function fieldOf({ type, description }: Told['attributes'][number], unit: string): Field<unknown> {
  if (type === 'number') {
    const [min, max] = RANGES[unit] as readonly [number, number];
    return optional(numberIn(0, { min, max })) as Field<unknown>;
  }
  if (type === 'boolean') return flag(false) as Field<unknown>;
  const values = [...type.matchAll(/'([^']+)'/g)].map(([, value]) => value as string);
  const usual = values.find((value) => value === 'auto' || description.includes(`(${value})`)) ?? USUAL;
  if (values.length) return choice(usual, [...new Set([usual, ...values])]) as unknown as Field<unknown>;
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
    const { name, description } = attribute;
    const words = name.replace(/-(deg|db|m)$/, '').replaceAll('-', ' ');
    const unit = unitOf(attribute);
    const help = `${description.charAt(0).toUpperCase()}${description.slice(1)}.`;
    return {
      path: `@${name}`,
      label: words.charAt(0).toUpperCase() + words.slice(1),
      group: elements.every(({ attributes }) => attributes.some((one) => one.name === name)) ? 'all elements' : '',
      field: { ...fieldOf(attribute, unit), option: { name: `@${name}`, help, unit, choices: {} } },
    };
  });
}
