// The snippets of docs/notebooks.md as cells of a notebook in JupyterLab.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { clickPlot, of, open, says, start, story, workFolder } from './lib/host.mjs';

const every = readFileSync(new URL('every_widget.py', import.meta.url), 'utf8');
let server;
let view;
before(async () => {
  const folder = workFolder();
  const cells = [...of.jupyter, every].map((source, i) => ({
    id: `cell-${i}`,
    cell_type: 'code',
    metadata: {},
    source,
    outputs: [],
    execution_count: null,
  }));
  const kernelspec = { name: 'python3', display_name: 'Python 3', language: 'python' };
  const notebook = { cells, metadata: { kernelspec }, nbformat: 4, nbformat_minor: 5 };
  writeFileSync(join(folder, 'radar.ipynb'), JSON.stringify(notebook));
  // JupyterLab's own news and updates are asked for elsewhere.
  const config = join(folder, '.home', 'JUPYTER_CONFIG_DIR', 'labconfig');
  mkdirSync(config, { recursive: true });
  const disabled = { '@jupyterlab/apputils-extension:announcements': true };
  writeFileSync(join(config, 'page_config.json'), JSON.stringify({ disabledExtensions: disabled }));
  server = await start(folder, 'api/status', (port) => [
    'jupyterlab',
    '--allow-root',
    '--no-browser',
    '--ServerApp.ip=127.0.0.1',
    `--ServerApp.port=${port}`,
    '--ServerApp.port_retries=0',
    '--IdentityProvider.token=',
    `--ServerApp.root_dir=${folder}`,
  ]);
  view = await open(server, 'lab/tree/radar.ipynb?reset', { viewport: { width: 1280, height: 6000 } });
});
after(async () => {
  await view?.close();
  await server?.close();
});

const test = story(() => view);
const cell = (text) => view.page.locator('.jp-CodeCell').filter({ hasText: text }).first();

/** Runs a cell by the keyboard, and waits until it is done. */
async function runCell(text) {
  const made = cell(text);
  await made.locator('.cm-content').click();
  const prompt = made.locator('.jp-InputPrompt');
  const before = await prompt.textContent();
  await view.page.keyboard.press('Control+Enter');
  await view.page.waitForFunction(
    ([element, before]) => /\d/.test(element.textContent) && element.textContent !== before,
    [await prompt.elementHandle(), before],
  );
}

test('cells run, and elements show the numbers of NumPy', async () => {
  const { page } = view;
  await page.getByText('Python 3 (ipykernel) | Idle').waitFor();
  await page.locator('.jp-CodeCell').nth(of.jupyter.length).waitFor();
  await page.getByRole('menuitem', { name: 'Run', exact: true }).click();
  await page.getByRole('menuitem', { name: 'Run All Cells', exact: true }).click();
  const found = await says(page.locator('boresight-spectrum'), /capon: .*°, .*°/);
  const angles = [...found.matchAll(/([+−-])(\d+\.\d+)°/g)].map(([, sign, digits]) => (sign === '+' ? 1 : -1) * digits);
  angles.sort((a, b) => a - b);
  assert.ok(Math.abs(angles[0] + 12) < 1 && Math.abs(angles[1] - 20) < 1, found);
  await says(page.locator('boresight-point-cloud'), '80 detections, of which 72 are taken as static.');
  await says(page.locator('boresight-doppler-azimuth'), '80 detections; the radar moves with 12.03 m/s.');
  assert.equal(await page.locator('boresight-spectrum .heading').textContent(), 'Two sources');
});

test('every widget shows data of the shapes that are documented', async () => {
  const { page } = view;
  const words = {
    'boresight-range-doppler':
      '64 ranges to 31.5 m, 32 range rates; levels from −90 to −30 dBFS.\nDetection at 20.00 m, +3.00 m/s.',
    'boresight-birds-eye': '20 m ahead by 30 m across in cells of 0.5 m; levels from −40 to 0 dB.',
    'boresight-mounting-angle': 'After 59 s: +1.50°, standard deviation 0.10°; within tolerance.',
    'boresight-capture': /ranges to .*Detection at/s,
    'boresight-drive[heading]': /After 26 s: \+(1\.9|2\.0)\d°, .*; out of tolerance/,
  };
  for (const [name, text] of Object.entries(words)) await says(page.locator(name), text);
});

test('a click comes back to Python', async () => {
  const { page } = view;
  await clickPlot(page, page.locator('boresight-spectrum'));
  await runCell('spectrum.selection');
  const output = cell('spectrum.selection').locator('.jp-OutputArea-output');
  await output.waitFor();
  const [, x] = /'x': (-?[\d.]+)/.exec(await output.textContent()) ?? assert.fail(await output.textContent());
  assert.ok(Math.abs(Number(x) - 30) < 2, `a quarter from the left is ${x} deg`);
});

test('a drive is calibrated in the browser, and its result comes back', async () => {
  const { page } = view;
  const value = page.locator('boresight-drive:not([heading]) [part="value"]');
  await value.filter({ hasText: /\d° ±/ }).waitFor({ timeout: 90_000 });
  const shown = await value.textContent();
  await runCell('if drive.result');
  const output = cell('if drive.result').locator('.jp-OutputArea-output');
  await output.waitFor();
  const told = (await output.textContent()).trim();
  assert.match(told, /^-[12]\.\d\d deg \+- \d\.\d\d deg$/);
  assert.equal(told.split(' deg')[0], shown.split('°')[0].replace('−', '-'));
});

test('a cell that runs twice has one element, which knows the data', async () => {
  const { page } = view;
  await view.screenshot('jupyterlab-light');
  await page.evaluate(() => {
    window.first = document.querySelector('boresight-spectrum');
  });
  await runCell('rng = np.random.default_rng(1)');
  await page.waitForFunction(() => document.querySelector('boresight-spectrum') !== window.first);
  await says(page.locator('boresight-spectrum'), /capon: .*°, .*°/);
  assert.equal(await page.locator('boresight-spectrum').count(), 1);
  assert.equal(await page.evaluate(() => window.first.isConnected), false);
});

test('data that are set again are drawn, and wrong ones are errors of the cell', async () => {
  const { page } = view;
  const last = page.locator('.jp-CodeCell').last();
  const write = async (code) => {
    await last.locator('.cm-content').click();
    await page.keyboard.press('Control+a');
    await page.keyboard.type(code);
    await page.keyboard.press('Control+Enter');
  };
  await write('cloud.points = {"range_m": [1, 2, 3], "azimuth_deg": np.zeros(3, "f4")}');
  await says(page.locator('boresight-point-cloud'), '3 detections.');
  await write('cloud.points = {"range_m": [1, 2, 3], "azimuth_deg": [0]}');
  await last.locator('.jp-OutputArea-output').filter({ hasText: 'ValueError: points.azimuth_deg has 1' }).waitFor();
  assert.match(await says(page.locator('boresight-point-cloud'), '3'), /3 detections/);
});

test('elements follow the theme of JupyterLab, and end with their outputs', async () => {
  const { page } = view;
  await page.getByRole('menuitem', { name: 'Settings', exact: true }).click();
  await page.locator('.lm-Menu-item[aria-haspopup]', { hasText: /^Theme$/ }).click();
  await page.getByRole('menuitem', { name: 'JupyterLab Dark', exact: true }).click();
  await page.locator('boresight-spectrum[theme="dark"]').waitFor();
  await page.locator('#jupyterlab-splash').waitFor({ state: 'detached' });
  await view.screenshot('jupyterlab-dark');
  const workers = () => page.workers().filter((worker) => worker.url().startsWith('blob:')).length;
  assert.ok(workers() > 0, 'drives and captures were worked on');
  await page.getByRole('menuitem', { name: 'Edit', exact: true }).click();
  await page.getByRole('menuitem', { name: 'Clear Outputs of All Cells', exact: true }).click();
  await page.locator('boresight-spectrum').waitFor({ state: 'detached' });
  await page.locator('boresight-drive').first().waitFor({ state: 'detached' });
  assert.equal(workers(), 0);
});

test('nothing left the machine, and nothing failed in the page', () => {
  assert.deepEqual(view.outside, []);
  assert.deepEqual(view.problems, []);
});
