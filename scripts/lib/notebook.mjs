// What python/boresight-widget holds of the elements: its module, and what the manifest says of each.
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { dist, root } from './paths.mjs';
import { run } from './run.mjs';

/** The folder of the Python package that the build fills. */
export const notebookFolder = 'python/boresight-widget/boresight_widget/static';

/** Texts that go with every copy. */
const licences = ['LICENSE', 'LICENSE-APACHE', 'NOTICE'];

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
      events: events.map(({ name, description }) => ({ name, description })),
    }))
    .sort((a, b) => (a.tag < b.tag ? -1 : 1));
}

export async function makeNotebook() {
  await run('vite', ['build', '-c', 'vite.notebook.config.ts', '--logLevel', 'warn']);
  for (const name of licences) copyFileSync(join(root, name), join(root, notebookFolder, name));
  const { version } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
  const elements = elementsOf(JSON.parse(readFileSync(join(dist, 'elements', 'custom-elements.json'), 'utf8')));
  writeFileSync(join(root, notebookFolder, 'elements.json'), `${JSON.stringify({ version, elements }, null, 2)}\n`);
}
