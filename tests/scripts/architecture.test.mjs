// docs/architecture.md names paths and dependencies that exist.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { workspaceGraph } from '../../scripts/lib/dependency-rules.mjs';
import { root } from '../../scripts/lib/paths.mjs';
import { output } from '../../scripts/lib/run.mjs';

const text = readFileSync(join(root, 'docs', 'architecture.md'), 'utf8');
/** Members of an archive that the page describes. */
const members = ['session.json'];
/** Indented blocks: lines that begin with four spaces, together. */
const blocks = text.match(/(?:^ {4}.*\n)+/gm);
const tracked = output('git', ['ls-files']).trim().split('\n');

test('the folders of the layout exist', () => {
  const above = [];
  const paths = [];
  for (const line of blocks[0].trimEnd().split('\n')) {
    const [, indent, name] = /^ {4}( *)(\S+)/.exec(line);
    // A line without a name of its own continues the description above it.
    if (indent.length > 8) continue;
    above.length = indent.length / 2;
    above.push(name);
    paths.push(above.join('/').replaceAll('//', '/'));
  }
  assert.ok(paths.includes('crates/fleet/') && paths.includes('web/lib/runtime/'), paths.join(' '));
  assert.deepEqual(
    paths.filter((path) => !existsSync(join(root, path))),
    [],
  );
  const crates = new Set(tracked.map((path) => /^crates\/[^/]+\//.exec(path)?.[0]).filter(Boolean));
  assert.deepEqual(
    [...crates].filter((path) => !paths.includes(path)),
    [],
  );
});

test('the files that it names exist', () => {
  const named = [
    ...text.matchAll(/[\w@.-]+(?:\/[\w@.-]+)+/g),
    ...text.matchAll(/(?<=`)[\w.-]+\.(?:rs|ts|mjs|js|toml|json)(?=`)/g),
  ].map(([path]) => path.replace(/^[ab]\/(?=crates\/)/, '').replace(/[.]$/, ''));
  const isPath = (path) => /\.(rs|ts|mjs|js|toml|json)$/.test(path) || /^(crates|web|scripts|tests|docs)\//.test(path);
  const exists = (path) =>
    tracked.some((file) => file === path || file.endsWith(`/${path}`) || file.startsWith(`${path}/`)) ||
    // Short for a file in the sources of a crate.
    tracked.some((file) => file.startsWith('crates/') && file.replace('/src/', '/').endsWith(`/${path}`));
  const paths = named.filter((path) => isPath(path) && !members.includes(path));
  assert.ok(paths.length > 20, paths.join(' '));
  assert.deepEqual(
    paths.filter((path) => !exists(path)),
    [],
  );
});

test('its arrows are the dependencies between the crates', () => {
  const graph = workspaceGraph(JSON.parse(output('cargo', ['metadata', '--format-version', '1', '--no-deps'])));
  const drawn = new Map([...graph.keys()].map((name) => [name, new Set()]));
  for (const line of blocks
    .find((block) => block.includes('<-'))
    .trim()
    .split('\n')) {
    const steps = line.split('<-').map((step) => step.match(/[\w-]+/g));
    for (let at = 1; at < steps.length; at++) {
      for (const by of steps[at]) for (const on of steps[at - 1]) drawn.get(by).add(on);
    }
  }
  const reached = (name) => new Set([...drawn.get(name)].flatMap((on) => [on, ...reached(on)]));
  for (const [name, dependencies] of graph) {
    const ours = dependencies.filter((one) => one.ours && one.kind === 'normal');
    const direct = new Set(ours.map((one) => one.name.replace('boresight-', '')));
    const extra = [...drawn.get(name)].filter((on) => !direct.has(on));
    assert.deepEqual(extra, [], `arrows to ${name}`);
    const missing = [...direct].filter((on) => !reached(name).has(on));
    assert.deepEqual(missing, [], `dependencies of ${name}`);
  }
});
