// What python/boresight-widget holds of the elements: its module, and what the manifest says of each.
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { dist, root } from '../paths.mjs';
import { run } from '../run.mjs';
import { elementsOf } from './manifest.mjs';

/** The folder of the Python package that the build fills. */
export const notebookFolder = 'python/boresight-widget/boresight_widget/static';

/** Texts that go with every copy. */
const licences = ['LICENSE', 'LICENSE-APACHE', 'NOTICE'];

export async function makeNotebook() {
  await run('vite', ['build', '-c', 'vite.notebook.config.ts', '--logLevel', 'warn']);
  for (const name of licences) copyFileSync(join(root, name), join(root, notebookFolder, name));
  const { version } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
  const elements = elementsOf(JSON.parse(readFileSync(join(dist, 'elements', 'custom-elements.json'), 'utf8')));
  writeFileSync(join(root, notebookFolder, 'elements.json'), `${JSON.stringify({ version, elements }, null, 2)}\n`);
}
