/** Captures of other boards, simulated, and controls for what a configuration says wrong. */
import assert from 'node:assert/strict';
import { before } from 'node:test';
import { init, parseConfig } from 'boresight';
import { cascadeFiles, configOf, framesOf, ROW } from '../../lib/boards.mjs';
import { opened, ready } from '../capture/page.mjs';
import { combobox } from '../lib/controls.mjs';
import { drop, parametersWith, recording } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

const path = '#/capture';
const bin = { name: 'mine.bin', bytes: recording('xwr16xx_crw_dca_module_2018_1015v2.bin') };
const text = recording('profile.cfg').toString('utf8');
const cfg = (name, buffer) => ({
  name,
  bytes: Buffer.from(text.replace('adcbufCfg -1 0 0 1 0', `adcbufCfg ${buffer}`)),
});

before(() => init());

const detections = (page) =>
  page
    .locator('[data-table="detections"] tbody tr[data-detection] [data-field][data-value]:not([data-field^="board"])')
    .evaluateAll((cells) => cells.map(({ dataset }) => `${dataset.field} ${dataset.value}`));
const doubts = (page) => page.locator('[data-doubt]').evaluateAll((items) => items.map(({ dataset }) => dataset.doubt));

browserTest('boards: a wrong order of I and Q, or of lanes, is told and mended', { path }, async ({ page }) => {
  await ready(page);
  await drop(page, [bin, cfg('right.cfg', '-1 0 0 1 0')]);
  await opened(page, 'right.cfg');
  await ready(page);
  const right = await detections(page);
  assert.deepEqual(await doubts(page), []);
  for (const [name, buffer, doubt, label, key, choice] of [
    ['swapped.cfg', '-1 0 1 1 0', 'iq-swapped', 'Order of I and Q', 'iqOrder', 'auto'],
    ['lanes.cfg', '-1 0 0 0 0', 'other-lanes', 'Lanes of the board', 'lanes', 'two'],
  ]) {
    const control = combobox(page, label);
    await drop(page, [bin, cfg(name, buffer)]);
    await opened(page, name);
    await page.waitForSelector(`[data-doubt="${doubt}"]`);
    await ready(page);
    assert.notDeepEqual(await detections(page), right);
    await control.selectOption(choice);
    await page.waitForSelector(`[data-doubt="${doubt}"]`, { state: 'detached' });
    await ready(page);
    assert.deepEqual(await detections(page), right);
    await parametersWith(page, (parameters) => parameters.get(key) === choice);
    await control.selectOption('configured');
    await page.waitForSelector(`[data-doubt="${doubt}"]`);
  }
});

browserTest('boards: the files of a cascade make one capture', { path }, async ({ page }) => {
  await ready(page);
  const cascade = configOf({ cascade: true, transmitters: ROW, loops: 4 });
  const files = cascadeFiles(framesOf(parseConfig(cascade).waveform, 'cascade86')).map(({ name, bytes }) => ({
    name,
    bytes: Buffer.from(bytes),
  }));
  const config = { name: 'cascade.cfg', bytes: Buffer.from(cascade) };
  await drop(page, [files[2], config, files[0], files[3], files[1]]);
  await opened(page, 'cascade.cfg');
  await ready(page);
  assert.match(await page.locator('[data-parts="4"]').innerText(), /cascade’s four chips/);
  assert.match(await page.locator('[data-fact="array"]').innerText(), /cascade86, 86 virtual/);
  const cells = await detections(page);
  const of = (field) => Number(cells.find((cell) => cell.startsWith(`${field} `)).split(' ')[1]);
  assert.ok(Math.abs(of('rangeM') - 2.5) < 0.05, cells);
  assert.ok(Math.abs(of('azimuthDeg') + 20) < 0.5, cells);
  assert.deepEqual(await doubts(page), []);
  // One is missing, and one of another recording.
  for (const [wrong, says] of [
    [files.slice(1), 'no master_0000_data.bin'],
    [[...files, bin], 'mine.bin'],
  ]) {
    await drop(page, [...wrong, config]);
    await page.getByRole('alert').filter({ hasText: says }).waitFor();
  }
});
