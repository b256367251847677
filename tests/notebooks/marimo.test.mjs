// The snippets of docs/notebooks.md that are of marimo, as cells of its editor.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { clickPlot, of, open, says, start, story, workFolder } from './lib/host.mjs';

let server;
let view;
before(async () => {
  const folder = workFolder();
  // The first snippet makes the spectrum that those of marimo show.
  const cells = [of.jupyter[0].replace(/\nspectrum$/, ''), ...of.marimo];
  const indented = (code) => code.replaceAll(/^(?=.)/gm, '    ');
  const source = [
    'import marimo',
    'app = marimo.App()',
    ...cells.map((code) => `@app.cell\ndef _():\n${indented(code)}`),
  ];
  writeFileSync(join(folder, 'radar.py'), source.join('\n\n'));
  writeFileSync(join(folder, 'pyproject.toml'), '[tool.marimo.display]\ntheme = "dark"\n');
  server = await start(folder, 'health', (port) => [
    'marimo',
    '--yes',
    'edit',
    'radar.py',
    '--headless',
    '--no-token',
    '--skip-update-check',
    '--host=127.0.0.1',
    `--port=${port}`,
  ]);
  view = await open(server, '', { viewport: { width: 1280, height: 2000 } });
});
after(async () => {
  await view?.close();
  await server?.close();
});

const test = story(() => view);

test('cells run, and an element shows the numbers of NumPy, dark as marimo is', async () => {
  const { page } = view;
  await page.getByText('mo.ui.anywidget').first().click();
  await page.keyboard.press('Control+Shift+r');
  const found = await says(page.locator('boresight-spectrum'), /capon: .*°, .*°/);
  assert.match(found, /\+(19|20)\./);
  await page.locator('.paragraph', { hasText: 'Nothing selected' }).waitFor();
  assert.equal(await page.locator('boresight-spectrum').getAttribute('theme'), 'dark');
});

test('a click runs the cells that follow the widget', async () => {
  const { page } = view;
  await clickPlot(page, page.locator('boresight-spectrum'));
  const told = page.locator('.paragraph', { hasText: /^Selected: / });
  await told.waitFor();
  const x = Number(/-?[\d.]+/.exec(await told.textContent())[0]);
  assert.ok(Math.abs(x - 30) < 2, `a quarter from the left is ${x} deg`);
  await view.screenshot('marimo-dark');
});

test('a cell that runs twice has one element, and that of before ends', async () => {
  const { page } = view;
  const element = await page.locator('boresight-spectrum').elementHandle();
  await page.getByText('default_rng').first().click();
  await page.keyboard.press('Control+Enter');
  await page.waitForFunction((first) => !first.isConnected, element);
  await says(page.locator('boresight-spectrum'), /capon: .*°, .*°/);
  assert.equal(await page.locator('boresight-spectrum').count(), 1);
});

test('nothing left the machine, and nothing failed in the page', () => {
  assert.deepEqual(view.outside, []);
  assert.deepEqual(view.problems, []);
});
