// Runs the tests of all crates of the product, as many programs at a time as there are cores, since many end with one long
// test, and then the examples of the documentation. `--only crates/aoa,crates/fleet` runs the programs of some folders.
// The whole workspace is compiled for them: a selection by `-p` has other features of dependencies, which Cargo then
// compiles again.
import { availableParallelism } from 'node:os';
import { delimiter, dirname, relative } from 'node:path';
import { parseArgs } from 'node:util';
import { environment, root } from './lib/paths.mjs';
import { main, output, run, runKeeping } from './lib/run.mjs';

/** Where tests of macros, which are part of the compiler, look for its libraries. */
const libraryPath = { win32: 'PATH', darwin: 'DYLD_FALLBACK_LIBRARY_PATH' }[process.platform] ?? 'LD_LIBRARY_PATH';

const { values } = parseArgs({ options: { only: { type: 'string' } } });
const only = values.only?.split(',');

/** Test programs: path, folder of their package, and what to call them. */
async function programs() {
  const build = [
    'test',
    ...(only ? ['--workspace'] : []),
    '--no-run',
    '--quiet',
    '--message-format=json-render-diagnostics',
  ];
  const { ok, text } = await runKeeping('cargo', build, { stdio: ['ignore', 'pipe', 'inherit'] });
  if (!ok) throw new Error('the tests do not compile');
  return text
    .split('\n')
    .filter((line) => line.startsWith('{'))
    .map((line) => JSON.parse(line))
    .filter(({ reason, profile, executable }) => reason === 'compiler-artifact' && profile.test && executable)
    .map(({ executable, manifest_path, target }) => ({
      executable,
      folder: dirname(manifest_path),
      name: `${relative(root, dirname(manifest_path))}: ${target.name}`,
    }))
    .filter(({ folder }) => !only || only.includes(relative(root, folder).replaceAll('\\', '/')));
}

await main(async () => {
  const waiting = await programs();
  if (waiting.length === 0) throw new Error(`no test program in ${values.only}`);
  const libraries = output('rustc', ['--print', 'target-libdir'])?.trim();
  const paths = [libraries, environment[libraryPath]].filter(Boolean).join(delimiter);
  const failed = [];
  const worker = async () => {
    for (let one = waiting.shift(); one; one = waiting.shift()) {
      const { executable, folder, name } = one;
      // As Cargo has it.
      const env = { ...environment, CARGO_MANIFEST_DIR: folder, [libraryPath]: paths };
      const { ok, text } = await runKeeping(executable, ['--quiet'], { cwd: folder, env });
      console.log(`\n${name}\n${text}`);
      if (!ok) failed.push(name);
    }
  };
  await Promise.all(Array.from({ length: availableParallelism() }, worker));
  if (!only) {
    const examples = run('cargo', ['test', '--doc', '--no-fail-fast', '--quiet']);
    await examples.catch(() => failed.push('examples of the documentation'));
  }
  if (failed.length > 0) throw new Error(`failed: ${failed.join(', ')}`);
});
