// Python's types of options and results, and the flags of options, from the JSON Schemas that `npm run generate` writes from
// the descriptions in Rust.
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

const constants = (oneOf) => oneOf.map((one) => one.const);

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

/** A type of results in Python; `use` hears the name of each record and choice. */
function resultType(schema, use) {
  const { $ref, anyOf, type, items } = schema;
  if ($ref) {
    const name = $ref.replace('#/$defs/', '');
    use(name);
    return name;
  }
  if (anyOf) return anyOf.map((one) => resultType(one, use)).join(' | ');
  if (type === 'array') return `list[${resultType(items, use)}]`;
  const plain = { number: 'float', integer: 'float', boolean: 'bool', string: 'str', null: 'None' }[type];
  if (!plain) throw new Error(`no type of Python is known for ${JSON.stringify(schema)}`);
  return plain;
}

/** The module of results. */
export function resultsModule({ $defs }) {
  const done = new Set();
  const parts = [];
  const write = (name) => {
    if (done.has(name)) return;
    done.add(name);
    const { description, oneOf, properties, required } = $defs[name] ?? {};
    if (oneOf) {
      parts.push(`${literal(`${name} = `, constants(oneOf))}\n`);
      return;
    }
    if (!properties) throw new Error(`the schema of results has no ${name}`);
    const lines = Object.entries(properties).map(([field, schema]) => {
      const of = resultType(schema, write);
      const there = required.includes(field) ? of : `NotRequired[${of}]`;
      return `    ${field}: ${there}\n${docstring(schema.description, 4)}`;
    });
    parts.push(`class ${name}(TypedDict):\n${docstring(description, 4)}\n${lines.join('')}`);
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

/** A type of options in Python. */
function optionType(property, use) {
  const { type, title, oneOf, anyOf, enum: values, items } = property;
  if (oneOf) {
    use(title, constants(oneOf));
    return title;
  }
  if (anyOf) return anyOf.map((one) => optionType(one, use)).join(' | ');
  if (values) return literal('', values);
  if (type === 'array') return `Sequence[${optionType(items, use)}]`;
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

/** Every choice of a schema by its name: of options, and of the records within them. */
function choicesOf(schema, found = new Map()) {
  if (typeof schema !== 'object' || schema === null) return found;
  if (schema.oneOf && schema.title) found.set(schema.title, constants(schema.oneOf));
  for (const inner of Object.values(schema)) choicesOf(inner, found);
  return found;
}

/** The module of options, and the version that they are of. */
export function optionsModule(schema, version) {
  const all = choicesOf(schema.$defs);
  const used = new Map(CHOICES.map((name) => [name, all.get(name)]));
  const parts = [];
  for (const [name, { of, without }] of Object.entries(OPTIONS)) {
    const definitions = of.map((one) => schema.$defs[one]);
    const fields = definitions.flatMap(({ properties }) => optionFields(properties, without));
    const lines = fields.map(({ name, property }) => {
      const more = told(property);
      const words = property.description.replace(/\.$/, '') + (more ? ` (${more})` : '');
      return `    ${name}: ${optionType(property, (choice, values) => used.set(choice, values))}\n${docstring(`${words}.`, 4)}`;
    });
    const table = fields.map(({ name, flag, how }) => `    "${name}": ("${flag}", "${how}"),\n`);
    parts.push(
      `class ${name}(TypedDict, total=False):\n${docstring(definitions[0].description, 4)}\n${lines.join('')}`,
    );
    parts.push(`${snakeCase(name).slice(1).toUpperCase()}: dict[str, tuple[str, Kind]] = {\n${table.join('')}}\n`);
  }
  const aliases = [...used].sort().map(([name, values]) => literal(`${name} = `, values));
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
  return [
    [`${FOLDER}/options.py`, optionsModule(JSON.parse(generated('schema.json')), version)],
    [`${FOLDER}/results.py`, resultsModule(JSON.parse(generated('results-schema.json')))],
  ];
}
