/** What the gallery shows as code: of a page, of React, of a notebook. */

import { elements } from 'virtual:elements';
import { call, literal, quoted } from '../../code/literal.ts';
import type { Sample } from './sample.ts';

export const KINDS = ['html', 'react', 'notebook'] as const;
export type Kind = (typeof KINDS)[number];

interface Shown {
  sample: Sample;
  /** As the package takes them. */
  options: Readonly<Record<string, unknown>>;
  /** Attributes. */
  settings: Readonly<Record<string, string>>;
}

const escaped = (text: string): string =>
  text.replaceAll('&', '&amp;').replaceAll('"', '&quot;').replaceAll('<', '&lt;');

/** The calls of the pool, a line each or more. */
function calls({ sample, options }: Shown, indent: string): string[] {
  const files = (sample.recording?.files ?? []).map((name) => quoted(`./${name}`));
  const read = files.length
    ? [
        `${indent}const files = await Promise.all(`,
        `${indent}  [${files.join(', ')}].map(async (name) => {`,
        `${indent}    const response = await fetch(name);`,
        `${indent}    return { name, bytes: new Uint8Array(await response.arrayBuffer()) };`,
        `${indent}  }),`,
        `${indent});`,
      ]
    : [];
  const steps = sample
    .steps(options)
    .map(({ name, call: asked, args }) => call(`const ${name} = await pool.${String(asked)}`, args, ';', indent));
  return [...read, ...steps];
}

/** The heading goes before what is set. */
const attributes = ({ sample, settings }: Shown): [string, string][] =>
  Object.entries({ heading: sample.title, ...settings });

const usesPool = ({ sample }: Shown): boolean => sample.steps({}).length > 0;

const tag = (shown: Shown): string =>
  attributes(shown)
    .map(([name, value]) => (value === '' ? ` ${name}` : ` ${name}="${escaped(value)}"`))
    .join('');

function html(shown: Shown): string {
  const { sample, options } = shown;
  const properties = Object.entries(sample.properties(options)).map(([name, value]) => {
    const start = `  element.${name} = `;
    return `${start}${literal(value, { indent: '  ', before: start.length })};`;
  });
  return [
    `<${sample.tag}${tag(shown)}></${sample.tag}>`,
    '<script type="module">',
    "  import 'boresight/elements';",
    ...(usesPool(shown)
      ? ["  import { createPool } from 'boresight/worker';", '', '  const pool = createPool();']
      : ['']),
    ...calls(shown, '  '),
    `  const element = document.querySelector('${sample.tag}');`,
    ...properties,
    '</script>',
    '',
  ].join('\n');
}

const component = ({ sample }: Shown): string =>
  sample.tag.replace('boresight', '').replace(/-(\w)/g, (_, letter: string) => letter.toUpperCase());

function react(shown: Shown): string {
  const { sample, options } = shown;
  const name = component(shown);
  const start = '      if (here) setData(';
  const data = literal(sample.properties(options), { indent: '      ', before: start.length, after: 2 });
  const given = attributes(shown)
    .map(([key, value]) => ` ${key}=${/["{}\\]/.test(value) ? `{${quoted(value)}}` : `"${value}"`}`)
    .join('');
  return [
    "import 'boresight/elements';",
    ...(usesPool(shown) ? ["import { createPool } from 'boresight/worker';"] : []),
    "import { useEffect, useState } from 'react';",
    '',
    ...(usesPool(shown) ? ['const pool = createPool();', ''] : []),
    `export function ${name}() {`,
    '  const [data, setData] = useState({});',
    '  useEffect(() => {',
    '    let here = true;',
    '    async function make() {',
    ...calls(shown, '      '),
    `${start}${data});`,
    '    }',
    '    make();',
    '    return () => {',
    '      here = false;',
    '    };',
    '  }, []);',
    `  return <${sample.tag}${given} {...data} />;`,
    '}',
    '',
  ].join('\n');
}

/** As Python writes it. */
function pythonOf(value: unknown): string {
  if (typeof value === 'boolean') return value ? 'True' : 'False';
  if (typeof value === 'string') return JSON.stringify(value);
  return String(value);
}

/** Names as Python writes them: `floor_db`, `false_alarm`. */
const snake = (name: string): string =>
  name.replaceAll('-', '_').replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`);

function dictionary(value: Readonly<Record<string, unknown>>): string {
  const parts = Object.entries(value).map(([key, one]) => {
    const inner = typeof one === 'object' && one !== null ? dictionary(one as Record<string, unknown>) : pythonOf(one);
    return `"${snake(key)}": ${inner}`;
  });
  return `{${parts.join(', ')}}`;
}

function notebook(shown: Shown): string {
  const { sample, options } = shown;
  const told = elements.find(({ tag }) => tag === sample.tag)?.attributes ?? [];
  const typed = (name: string, value: string): unknown => {
    const type = told.find((one) => one.name === name)?.type;
    return type === 'number' ? Number(value) : type === 'boolean' ? true : value;
  };
  const own = Object.fromEntries(attributes(shown).map(([name, value]) => [name, typed(name, value)]));
  // Elements with files take the options of their work; the others' data are one's own.
  const all = sample.recording && Object.keys(options).length ? { ...own, options } : own;
  return sample.python.replace('settings = {}', () => `settings = ${dictionary(all)}`);
}

const WRITERS: Record<Kind, (shown: Shown) => string> = { html, react, notebook };

export const codeOf = (kind: Kind, shown: Shown): string => WRITERS[kind](shown);
