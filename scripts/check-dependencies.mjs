// Dependencies between the crates point one way; bindings and tract stay where they belong.

import { problems, workspaceGraph } from './lib/dependency-rules.mjs';
import { main, output } from './lib/run.mjs';

await main(async () => {
  const text = output('cargo', ['metadata', '--format-version', '1', '--no-deps']);
  if (text === null) throw new Error('cargo metadata failed');
  const graph = workspaceGraph(JSON.parse(text));
  const found = problems(graph);
  console.log(`${graph.size} crates, ${found.length} forbidden dependencies`);
  if (found.length > 0) throw new Error(found.join('\n'));
});
