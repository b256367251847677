// Runs tests/notebooks: the wheel of python/boresight-widget in JupyterLab, marimo and Streamlit, in headless Chromium.
import { readdirSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { buildPackage } from './build.mjs';
import { environment, root, tools } from './lib/paths.mjs';
import { virtualEnvironment } from './lib/python/python.mjs';
import { isMain, main, run } from './lib/run.mjs';
import { setup } from './setup.mjs';

/** The wheel as it would be published, made anew. */
async function wheel(python) {
  const folder = join(tools, 'wheels');
  rmSync(folder, { recursive: true, force: true });
  const pip = ['-m', 'pip', '--quiet', '--disable-pip-version-check'];
  const offline = ['--no-index', '--no-deps'];
  const source = join('python', 'boresight-widget');
  await run(python, [...pip, 'wheel', ...offline, '--no-build-isolation', '--wheel-dir', folder, source]);
  const [name] = readdirSync(folder);
  await run(python, [...pip, 'install', ...offline, '--force-reinstall', join(folder, name)]);
}

/** What follows the build. */
export async function testNotebooks() {
  const python = await virtualEnvironment('notebooks', 'tests/notebooks/requirements.txt');
  await wheel(python);
  const folder = 'tests/notebooks';
  await run(python, ['-m', 'pytest', '-q', '-p', 'no:cacheprovider', folder], {
    env: { ...environment, PYTHONDONTWRITEBYTECODE: '1' },
  });
  const files = readdirSync(join(root, folder)).filter((name) => name.endsWith('.test.mjs'));
  const options = ['--test', '--test-reporter=spec', '--test-concurrency=1'];
  await run(process.execPath, [...options, ...files.sort().map((name) => `${folder}/${name}`)], {
    env: { ...environment, NOTEBOOKS_PYTHON: python },
  });
}

if (isMain(import.meta))
  await main(async () => {
    await setup();
    await buildPackage();
    await testNotebooks();
  });
