// docs/architecture.md names crates, layers and paths that exist, has the diagram of the workspace, and stays short.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { architecturePage, arrows, page } from '../../scripts/lib/checks/architecture.mjs';
import { layers, workspaceGraph } from '../../scripts/lib/checks/dependency-rules.mjs';
import { root } from '../../scripts/lib/paths.mjs';
import { output } from '../../scripts/lib/run.mjs';

const text = readFileSync(join(root, page), 'utf8');

test('the page has at most 1,200 words', () => {
  const words = text.split(/\s+/).filter((word) => /\w/.test(word)).length;
  assert.ok(words <= 1200, `${words} words`);
});

test('the table has every crate of the workspace in its layer', () => {
  const listed = [...text.matchAll(/^\| (\d+) \| ([\w-]+) \|/gm)].map(([, layer, name]) => [Number(layer), name]);
  assert.deepEqual(
    listed,
    layers.flatMap((names, i) => names.map((name) => [i + 1, name])),
  );
  const graph = workspaceGraph(JSON.parse(output('cargo', ['metadata', '--format-version', '1', '--no-deps'])));
  assert.deepEqual(listed.map(([, name]) => name).sort(), [...graph.keys()].sort());
});

test('the diagram is that of the workspace', () => {
  assert.equal(architecturePage()[1], text, '`npm run generate` writes it');
  const graph = new Map(
    Object.entries({ a: [], b: ['a'], c: ['a', 'b'] }).map(([name, all]) => [
      name,
      all.map((on) => ({ name: `boresight-${on}`, kind: 'normal', ours: true })),
    ]),
  );
  assert.deepEqual(
    [...arrows(graph)],
    [
      ['a', []],
      ['b', ['a']],
      ['c', ['b']],
    ],
  );
});

test('the paths that it names exist', () => {
  const quoted = [...text.matchAll(/`([\w@.-]+(?:\/[\w@.-]+)+)`/g)].map(([, path]) => path);
  const folders = [...text.matchAll(/^\| `([\w-]+)` \|/gm)].map(([, path]) => path);
  assert.ok(quoted.length > 20 && folders.length > 3, quoted.join(' '));
  assert.deepEqual(
    [...quoted, ...folders].filter((path) => !existsSync(join(root, path))),
    [],
  );
});
