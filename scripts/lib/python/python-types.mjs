// Python's types of options and results, and the flags of options, from what `npm run generate` writes from the descriptions in Rust: the
// JSON Schema of options, and the TypeScript types of both.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../paths.mjs';

const WIDTH = 120;
const HEAD = 'Written by `npm run generate` from the descriptions in Rust; not edited by hand.';
const FOLDER = 'python/boresight/boresight';

/** Options of functions: what they are made of, and what functions take as arguments of their own. */
const OPTIONS = {
  CalibrateOptions: { of: ['CalibrationOptions', 'ReadDriveOptions'], without: ['format'] },
  MergeOptions: { of: ['FleetOptions'], without: [] },
  EstimateOptions: { of: ['SharedEstimatorOptions'], without: ['network'] },
};
/** Choices that are arguments of their own. */
const CHOICES = ['DriveFormat', 'Method'];
/** Results, with all that they hold. */
const RESULTS = ['CalibrationResult', 'CalibrationOutlook', 'Source', 'Fleet'];

/** `minSpeedMps` as Python writes it: `min_speed_mps`. */
export const snakeCase = (name) => name.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);

/** Text broken between words. */
function wrapped(text, width) {
  const lines = [''];
  for (const word of text.split(/\s+/)) {
    const line = lines.at(-1);
    if (line !== '' && line.length + 1 + word.length > width) lines.push(word);
    else lines[lines.length - 1] = line === '' ? word : `${line} ${word}`;
  }
  return lines;
}

function docstring(text, indent) {
  const pad = ' '.repeat(indent);
  const safe = text.replaceAll('\\', '\\\\');
  const lines = wrapped(safe, WIDTH - indent - 3);
  if (lines.length === 1 && safe.length + indent + 6 <= WIDTH) return `${pad}"""${safe}"""\n`;
  return `${pad}"""${lines.join(`\n${pad}`)}\n${pad}"""\n`;
}

/** One choice a line where all do not fit on one. */
function literal(prefix, values) {
  const line = `${prefix}Literal[${values.map((value) => `"${value}"`).join(', ')}]`;
  return line.length <= WIDTH ? line : `${prefix}Literal[\n${values.map((value) => `    "${value}",\n`).join('')}]`;
}

/** What TypeScript declares: choices by name, and interfaces as their fields with type and words. */
function declarations(text) {
  const choices = {};
  for (const [, name, values] of text.matchAll(/^export type (\w+) =\s+((?:\s*\|?\s*'[^']*')+);/gm))
    choices[name] = [...values.matchAll(/'([^']*)'/g)].map(([, value]) => value);
  const interfaces = {};
  for (const [, comment, name, body] of text.matchAll(
    /(?:\/\*\*((?:(?!\*\/)[\s\S])*)\*\/\n)?export interface (\w+) \{\n([\s\S]*?)^\}/gm,
  )) {
    const fields = [...body.matchAll(/\/\*\*((?:(?!\*\/)[\s\S])*)\*\/\s+(?:readonly )?(\w+)(\??): ([^;]+);/g)];
    interfaces[name] = {
      words: words(comment ?? ''),
      fields: fields.map(([, comment, field, mark, type]) => ({
        field,
        type,
        optional: mark === '?',
        words: words(comment),
      })),
    };
  }
  return { choices, interfaces };
}

const words = (comment) =>
  comment
    .replace(/^\s*\*/gm, ' ')
    .replace(/\s+/g, ' ')
    .trim();

/** A type of results in Python; `use` hears each name. */
function resultType(type, use) {
  const text = type.trim().replace(/^readonly /, '');
  if (text.endsWith('[]')) return `list[${resultType(text.slice(0, -2), use)}]`;
  if (text.startsWith('[') || /^\w+Array$/.test(text)) {
    const nested = text.startsWith('[') && text.indexOf('[', 1) > 0;
    return nested ? 'list[list[float]]' : 'list[float]';
  }
  if (text.startsWith('(') && text.endsWith(')')) return resultType(text.slice(1, -1), use);
  if (text.includes(' | '))
    return text
      .split(' | ')
      .map((one) => resultType(one, use))
      .join(' | ');
  const plain = { number: 'float', boolean: 'bool', string: 'str', null: 'None' }[text];
  if (plain) return plain;
  if (!/^\w+$/.test(text)) throw new Error(`no type of Python is known for ${type}`);
  use(text);
  return text;
}

/** The module of results. */
export function resultsModule(typescript) {
  const { choices, interfaces } = declarations(typescript);
  const done = new Set();
  const parts = [];
  const write = (name) => {
    if (done.has(name)) return;
    done.add(name);
    if (choices[name]) {
      parts.push(`${literal(`${name} = `, choices[name])}\n`);
      return;
    }
    const { words, fields } = interfaces[name] ?? {};
    if (!fields) throw new Error(`TypeScript has no ${name}`);
    const lines = fields.map(({ field, type, optional, words }) => {
      const of = resultType(type, write);
      return `    ${field}: ${optional ? `NotRequired[${of}]` : of}\n${docstring(words, 4)}`;
    });
    parts.push(`class ${name}(TypedDict):\n${docstring(words, 4)}\n${lines.join('')}`);
  };
  RESULTS.forEach(write);
  const head = `"""Results of the command line.\n\n${HEAD}\n"""\n`;
  return joined([head, 'from typing import Literal, NotRequired, TypedDict\n', ...parts]);
}

/** Blocks of a module: two empty lines around classes, as Ruff has it, one elsewhere. */
const joined = (blocks) =>
  blocks.reduce((text, block, k) => {
    const apart = [block, blocks[k - 1] ?? ''].some((one) => one.startsWith('class '));
    return `${text}${k === 0 ? '' : apart ? '\n\n' : '\n'}${block}`;
  }, '');

/** The name of a choice by its values. */
const named = (choices, values) => Object.keys(choices).find((name) => choices[name].join() === values.join());

/** A type of options in Python. */
function optionType(property, choices, use) {
  const { type, oneOf, anyOf, enum: values, items } = property;
  if (oneOf) {
    const name = named(
      choices,
      oneOf.map((one) => one.const),
    );
    if (!name) throw new Error(`TypeScript has no choice of ${JSON.stringify(oneOf)}`);
    use(name);
    return name;
  }
  if (anyOf) return anyOf.map((one) => optionType(one, choices, use)).join(' | ');
  if (values) return literal('', values);
  if (type === 'array') return `Sequence[${optionType(items, choices, use)}]`;
  const plain = { number: 'float', integer: 'int', boolean: 'bool', string: 'str' }[type];
  if (!plain) throw new Error(`no type of Python is known for ${JSON.stringify(property)}`);
  return plain;
}

/** Range, unit and default in words. */
function told({ minimum, exclusiveMinimum, maximum, default: value, 'x-unit': unit }) {
  const low = minimum ?? exclusiveMinimum;
  const after = unit ? ` ${unit}` : '';
  const above = exclusiveMinimum === undefined ? '' : 'above ';
  const range = [];
  if (low !== undefined && maximum !== undefined) range.push(`${above}${low} to ${maximum}${after}`);
  else if (low !== undefined) range.push(above ? `above ${low}${after}` : `${low}${after} or more`);
  else if (unit) range.push(unit);
  const shown =
    value === undefined || (Array.isArray(value) && value.length === 0) ? [] : [`default ${JSON.stringify(value)}`];
  return [...range, ...shown].join('; ');
}

/** How the command line takes a property: `truth`, `no` for what is true by default, `list`, `value`. */
const kind = ({ type, default: value }) =>
  type === 'boolean' ? (value === true ? 'no' : 'truth') : type === 'array' ? 'list' : 'value';

/** Fields of options, those of records within them among the others. */
function optionFields(properties, without, path = '', flags = '') {
  return Object.entries(properties)
    .filter(([name]) => !without.includes(name))
    .flatMap(([name, property]) => {
      const own = `${path}${snakeCase(name)}`;
      const flag = `${flags}${property['x-flag']}`;
      if (property.type === 'object') return optionFields(property.properties, [], `${own}_`, `${flag}-`);
      const how = kind(property);
      return [{ name: own, property, how, flag: how === 'no' ? `--no-${flag}` : `--${flag}` }];
    });
}

/** The module of options, and the version that they are of. */
export function optionsModule(schema, typescript, version) {
  const { choices } = declarations(typescript);
  const used = new Set(CHOICES);
  const parts = [];
  for (const [name, { of, without }] of Object.entries(OPTIONS)) {
    const definitions = of.map((one) => schema.$defs[one]);
    const fields = definitions.flatMap(({ properties }) => optionFields(properties, without));
    const lines = fields.map(({ name, property }) => {
      const more = told(property);
      const words = property.description.replace(/\.$/, '') + (more ? ` (${more})` : '');
      return `    ${name}: ${optionType(property, choices, (choice) => used.add(choice))}\n${docstring(`${words}.`, 4)}`;
    });
    const table = fields.map(({ name, flag, how }) => `    "${name}": ("${flag}", "${how}"),\n`);
    parts.push(
      `class ${name}(TypedDict, total=False):\n${docstring(definitions[0].description, 4)}\n${lines.join('')}`,
    );
    parts.push(`${snakeCase(name).slice(1).toUpperCase()}: dict[str, tuple[str, Kind]] = {\n${table.join('')}}\n`);
  }
  const aliases = Object.keys(choices)
    .filter((name) => used.has(name))
    .map((name) => literal(`${name} = `, choices[name]));
  return joined([
    `"""Options by their names in Python, and their flags on the command line.\n\n${HEAD}\n"""\n`,
    'from collections.abc import Sequence\nfrom typing import Literal, TypedDict\n',
    `VERSION = "${version}"\n"""The version of the command line that they are of."""\n`,
    'Kind = Literal["truth", "no", "list", "value"]\n' +
      '"""How a flag is given: where its option is true, where it is false, with a list, with a value."""\n',
    `${aliases.join('\n')}\n`,
    ...parts,
  ]);
}

/** The files by their place in the checkout, and what they should hold. */
export function pythonFiles() {
  const text = (path) => readFileSync(join(root, path), 'utf8');
  const generated = (name) => text(`web/lib/generated/${name}`);
  const version = /^\[workspace\.package\]\s+version = "([^"]+)"/m.exec(text('Cargo.toml'))?.[1];
  if (!version) throw new Error('Cargo.toml states no version of the workspace');
  const typescript = generated('options.ts') + generated('results.ts');
  return [
    [`${FOLDER}/options.py`, optionsModule(JSON.parse(generated('schema.json')), typescript, version)],
    [`${FOLDER}/results.py`, resultsModule(typescript)],
  ];
}
