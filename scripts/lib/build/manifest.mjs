// What the manifest of custom elements says of each, for a page or a package.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../paths.mjs';

const told = ({ name, type, description = '' }) => ({ name, type: type?.text ?? '', description });

/** Of each element: name, class, what it is given and what it tells, without what is the element's own. */
export function elementsOf({ modules }) {
  return modules
    .flatMap(({ declarations }) => declarations)
    .filter(({ customElement, tagName }) => customElement && tagName)
    .map(({ tagName, name, description, members, attributes, events }) => ({
      tag: tagName,
      name: name.replace(/Element$/, ''),
      description,
      attributes: attributes.map(told),
      properties: members
        .filter(({ kind, privacy, readonly }) => kind === 'field' && privacy === undefined && !readonly)
        .map(told),
      // The analyzer takes what is dispatched by a variable for an event of that name.
      events: events
        .filter(({ name }) => name.startsWith('boresight-'))
        .map(({ name, description }) => ({ name, description })),
    }))
    .sort((a, b) => (a.tag < b.tag ? -1 : 1));
}

/** The manifest of the elements, from their sources. */
export async function manifest() {
  // It brings a TypeScript of its own, and is loaded where it is needed.
  const { create, ts } = await import('@custom-elements-manifest/analyzer/index.js');
  const folder = 'web/elements';
  const modules = readdirSync(join(root, folder), { recursive: true })
    .filter((name) => name.endsWith('.ts'))
    .sort()
    .map((name) => `${folder}/${name}`)
    .map((path) => ts.createSourceFile(path, readFileSync(join(root, path), 'utf8'), ts.ScriptTarget.ES2015, true));
  return create({ modules, plugins: [], context: { dev: false } });
}

/** `virtual:elements`: a list of them, made from their sources. */
export function elementsModule() {
  const name = 'virtual:elements';
  return {
    name: 'elements',
    resolveId: (id) => (id === name ? `\0${name}` : undefined),
    load: async (id) =>
      id === `\0${name}` ? `export const elements = ${JSON.stringify(elementsOf(await manifest()))};` : undefined,
  };
}
