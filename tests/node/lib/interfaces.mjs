// The fields that web/lib/**/types.ts and the generated types declare, so that tests can hold results against them.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { basename } from 'node:path';

const folder = new URL('../../../web/lib/', import.meta.url);
const types = readdirSync(folder, { recursive: true }).filter((name) => basename(name) === 'types.ts');
const source = [...types, 'generated/options.ts', 'generated/results.ts']
  .map((name) => readFileSync(new URL(name, folder), 'utf8'))
  .join('\n');

/** Interface -> { required, optional } field names, with those of the interfaces it extends. */
export const interfaces = new Map();
for (const [, name, parent, body] of source.matchAll(
  /^export interface (\w+)(?: extends (\w+))? \{\n([\s\S]*?)^\}/gm,
)) {
  const fields = [...body.matchAll(/^ {2}(?:readonly )?(\w+)(\??):/gm)];
  const of = (mark) => fields.filter(([, , optional]) => optional === mark).map(([, field]) => field);
  interfaces.set(name, { parent, required: of(''), optional: of('?') });
}
/** Adds to an interface the fields of those that it extends, which come first. */
function extend(name) {
  const { parent, ...own } = interfaces.get(name);
  if (!interfaces.has(parent)) return;
  extend(parent);
  const { required, optional } = interfaces.get(parent);
  own.required.push(...required.filter((field) => !own.required.includes(field)));
  own.optional.push(...optional.filter((field) => !own.optional.includes(field)));
}
for (const name of interfaces.keys()) extend(name);

/** Asserts that an object has the fields of an interface, all required ones and no others. */
export function assertShape(value, name) {
  const { required, optional } = interfaces.get(name) ?? assert.fail(`no interface ${name}`);
  const keys = Object.keys(value);
  for (const field of required) assert.ok(keys.includes(field), `${name} lacks ${field}`);
  for (const key of keys)
    assert.ok(required.includes(key) || optional.includes(key), `${name} has ${key}, which is not declared`);
  for (const key of keys) assert.notEqual(value[key], undefined, `${name}.${key} is undefined`);
}
