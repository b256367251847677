// Runs tests/interop: files exchanged with h5py and the RadarScenes package. Needs Python 3.11 or
// newer with its venv module; packages go into .tools/interop.
import { join, resolve } from 'node:path';
import { environment, root } from './lib/paths.mjs';
import { main, output, run } from './lib/run.mjs';
import { whenChanged } from './lib/stamp.mjs';
import { atLeast } from './lib/versions.mjs';

const windows = process.platform === 'win32';
const python = windows ? 'python' : 'python3';
const requirements = 'tests/interop/requirements.txt';
const venv = '.tools/interop';
const venvPython = join(venv, ...(windows ? ['Scripts', 'python.exe'] : ['bin', 'python']));

await main(async () => {
  const found = /^Python (\S+)/.exec(output(python, ['--version']) ?? '')?.[1];
  if (!found || !atLeast(found, '3.11.0')) {
    throw new Error(`Python 3.11 or newer is needed for the interop tests; this is ${found ?? 'none'}`);
  }
  await whenChanged('interop', { inputs: [requirements], extra: [found], outputs: [venvPython] }, async () => {
    await run(python, ['-m', 'venv', '--clear', venv]);
    await run(join(root, venvPython), ['-m', 'pip', 'install', '--quiet', '--no-deps', '-r', requirements]);
  });
  await run('cargo', ['build', '--quiet', '--package', 'boresight-cli']);
  const boresight = resolve(root, process.env.CARGO_TARGET_DIR ?? 'target', 'debug', windows ? 'boresight.exe' : 'boresight');
  await run(join(root, venvPython), ['-m', 'pytest', '-q', '-p', 'no:cacheprovider', 'tests/interop', ...process.argv.slice(2)], {
    env: { ...environment, BORESIGHT: boresight, PYTHONDONTWRITEBYTECODE: '1' },
  });
});
