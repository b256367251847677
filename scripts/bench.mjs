// Sets up, builds, and runs the benchmarks; arguments go to bench/main.mjs. NumPy, which they
// compare with, is installed in .tools/python unless the environment variable PYTHON names an
// interpreter that has it.
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { buildPackage } from './build.mjs';
import { environment, root, tools } from './lib/paths.mjs';
import { main, output, run } from './lib/run.mjs';
import { setup } from './setup.mjs';

async function python() {
  if (process.env.PYTHON) return process.env.PYTHON;
  const folder = join(tools, 'python');
  const program = process.platform === 'win32' ? join(folder, 'Scripts', 'python.exe') : join(folder, 'bin', 'python');
  const ready = () => existsSync(program) && output(program, ['-c', 'import numpy, scipy']) !== null;
  if (!ready()) {
    const system = process.platform === 'win32' ? 'python' : 'python3';
    if (output(system, ['--version']) === null) {
      console.log(`bench: ${system} was not found: ratios to NumPy will not be measured`);
      return '';
    }
    console.log('bench: NumPy and SciPy into .tools/python');
    await run(system, ['-m', 'venv', folder]);
    await run(program, [
      '-m',
      'pip',
      'install',
      '--quiet',
      '--disable-pip-version-check',
      '-r',
      join(root, 'bench', 'requirements.txt'),
    ]);
  }
  return program;
}

await main(async () => {
  await setup();
  await buildPackage();
  const against = process.argv.includes('--against');
  const interpreter = against ? '' : await python();
  const measure = () =>
    run(process.execPath, [join(root, 'bench', 'main.mjs'), ...process.argv.slice(2)], {
      env: { ...environment, PYTHON: interpreter },
    });
  if (!against) return measure();
  // Seen once in six runs: a row at half its speed all through a process, and not in the next one.
  return measure().catch(() => {
    console.log('bench: once more, since what is slower is so in another process too');
    return measure();
  });
});
