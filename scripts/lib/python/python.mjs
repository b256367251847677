import { join } from 'node:path';
import { whenChanged } from '../build/stamp.mjs';
import { atLeast } from '../checks/versions.mjs';
import { environment, root } from '../paths.mjs';
import { program } from '../programs.mjs';
import { output, run } from '../run.mjs';

const windows = process.platform === 'win32';
const python = windows ? 'python' : 'python3';

/**
 * Makes a virtual environment of exactly the packages of a requirements file, `.tools/NAME`; the path of its Python.
 * Needs Python 3.11 or newer with its venv module.
 */
export async function virtualEnvironment(name, requirements) {
  const found = /^Python (\S+)/.exec(output(python, ['--version']) ?? '')?.[1];
  if (!found || !atLeast(found, '3.11.0')) {
    throw new Error(`Python 3.11 or newer is needed; this is ${found ?? 'none'}`);
  }
  const venv = join('.tools', name);
  const venvPython = join(venv, ...(windows ? ['Scripts', 'python.exe'] : ['bin', 'python']));
  await whenChanged(name, { inputs: [requirements], extra: [found], outputs: [venvPython] }, async () => {
    await run(python, ['-m', 'venv', '--clear', venv]);
    await run(join(root, venvPython), [
      '-m',
      'pip',
      'install',
      '--quiet',
      '--no-cache-dir',
      '--no-deps',
      '-r',
      requirements,
    ]);
  });
  return join(root, venvPython);
}

/** Runs pytest on tests that use the command line, in a virtual environment of its own. */
export async function pytest(name, requirements, tests, variables = {}) {
  const interpreter = await virtualEnvironment(name, requirements);
  const boresight = await program('boresight');
  await run(interpreter, ['-m', 'pytest', '-q', '-p', 'no:cacheprovider', tests, ...process.argv.slice(2)], {
    env: { ...environment, BORESIGHT: boresight, PYTHONDONTWRITEBYTECODE: '1', ...variables },
  });
}
