// Dependencies between the crates point one way; bindings and tract stay where they belong. Within a crate, modules import
// from the file that defines an item, and at most two of them from each other.
import { existsSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { problems, workspaceGraph } from './lib/checks/dependency-rules.mjs';
import { cycles, importsOf, moduleProblems, sourcesOf } from './lib/checks/module-imports.mjs';
import { root } from './lib/paths.mjs';
import { main, output } from './lib/run.mjs';

await main(async () => {
  const text = output('cargo', ['metadata', '--format-version', '1', '--no-deps']);
  if (text === null) throw new Error('cargo metadata failed');
  const graph = workspaceGraph(JSON.parse(text));
  const folders = readdirSync(join(root, 'crates'));
  const sources = folders.map((crate) => [crate, join(root, 'crates', crate, 'src')]);
  sources.push(['experiments', join(root, 'research', 'experiments', 'src')]);
  const modules = sources.filter(([, folder]) => existsSync(folder));
  const read = modules.map(([crate, folder]) => [crate, sourcesOf(folder)]);
  const found = [...problems(graph), ...read.flatMap(([crate, files]) => moduleProblems(crate, files))];
  const longest = Math.max(...read.flatMap(([, files]) => cycles(importsOf(files)).map(({ length }) => length)), 0);
  const files = output('git', ['ls-files', '--', '.', ':!research'])?.trim().split('\n').length;
  console.log(
    `${graph.size - 1} product crates, ${files} tracked product files, longest import cycle ${longest} files, ${found.length} forbidden dependencies and imports`,
  );
  if (found.length > 0) throw new Error(found.join('\n'));
});
