/** Deno and Bun run the package as Node does, to the last digit. Both are programs that npm installs. */
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { consumer } from './consumer.mjs';

const timeout = 120_000;
const packages = { deno: '~2.9.6', bun: '~1.4.5' };

let project;
let expected;
const outcomeOf = async (program, ...args) => JSON.parse((await project.run(program, [...args, 'runtime.mjs'])).stdout);
/** Puts a runtime's program where its package has it, where npm ran no scripts. */
const placed = (name, script) => project.run(process.execPath, [join('node_modules', name, script)]);

before(
  async () => {
    project = await consumer({ packages, fixtures: ['runtime.mjs', 'embedded.mjs', 'program.mjs'] });
    expected = await outcomeOf(process.execPath);
    assert.ok(Number.isFinite(expected.here.angleDeg) && expected.here.sigmaDeg < 1, JSON.stringify(expected));
    assert.deepEqual(expected.pool, [expected.here, expected.here]);
  },
  { timeout },
);
after(() => project?.remove());

test('Deno, which may read files alone, works out what Node does', { timeout }, async () => {
  await placed('deno', 'install.cjs');
  assert.deepEqual(await outcomeOf(project.bin('deno'), 'run', '--no-prompt', '--allow-read'), expected);
});

test('Bun works out what Node does', { timeout }, async () => {
  await placed('bun', 'install.js');
  assert.deepEqual(await outcomeOf(project.bin('bun'), 'run'), expected);
});
