/** Recordings that are in several .bin files. */
import assert from 'node:assert/strict';
import { button, choose, figure, progress } from '../lib/controls.mjs';
import { assertCsv, drop, recording, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { frames, opened, ready } from './page.mjs';

const path = '#/capture';
const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = { name: 'profile.cfg', bytes: recording('profile.cfg') };
/** Cut within a sample, the second file within one frame: neither begins or ends with a whole one. */
const CUTS = [0, 300_001, 340_007, bin.length];
const parts = [0, 1, 2].map((i) => bin.subarray(CUTS[i], CUTS[i + 1]));
const named = (numbers) => numbers.map((n, i) => ({ name: `adc_data_Raw_${n}.bin`, bytes: parts[i] }));

async function overTime(page) {
  await page.locator('[data-over-time="8"] [data-plot="micro-doppler"]').waitFor();
  await progress(page, 'Frames over time').waitFor({ state: 'detached' });
}
const detections = (page) =>
  page
    .locator('[data-table="detections"] tbody tr[data-detection] [data-field][data-value]:not([data-field^="board"])')
    .evaluateAll((cells) => cells.map(({ dataset }) => `${dataset.field} ${dataset.value}`));
const ofRows = async (page) =>
  (await detections(page)).filter((cell) => /^(rangeM|rateMps|azimuthDeg|powerDb|snrDb) /.test(cell));
const profiles = async (page) =>
  assertCsv(await saved(page, button(figure(page, 'Range over time'), 'CSV')), 'frame,time_s,range_m,power_dbfs');
const listed = (page) => page.locator('.files .file').allInnerTexts();
const refused = async (page, files, code = 'recording-parts') => {
  await drop(page, files);
  const alert = page.getByRole('alert');
  const named = files.map(({ name }) => alert.filter({ hasText: name }));
  await named.reduce((any, one) => any.or(one)).waitFor();
  assert.equal(await alert.getAttribute('data-error'), code);
  return alert.innerText();
};

browserTest('parts: three files cut anywhere are the recording they were cut from', { path }, async ({ page }) => {
  await ready(page);
  await drop(page, [{ name: 'whole.bin', bytes: bin }, cfg]);
  await opened(page, 'whole.bin');
  await ready(page);
  await overTime(page);
  const [rows, columns] = [await ofRows(page), await profiles(page)];
  assert.ok(rows.length > 10);
  assert.equal(await page.locator('[data-parts]').count(), 0);
  // In no order, and numbers count as such: 10 comes after 9.
  const [a, b, c] = named([9, 10, 11]);
  await drop(page, [c, cfg, a, b]);
  await opened(page, 'adc_data_Raw_9.bin');
  await ready(page);
  await overTime(page);
  assert.deepEqual(await listed(page), [
    'adc_data_Raw_9.bin',
    'adc_data_Raw_10.bin',
    'adc_data_Raw_11.bin',
    'profile.cfg',
  ]);
  assert.match(await page.locator('[data-parts="3"]').innerText(), /3 \.bin files are one recording/);
  assert.match(
    await page.locator('[data-doubt="missing-part"]').innerText(),
    /adc_data_Raw_0\.bin to adc_data_Raw_8\.bin/,
  );
  assert.match(await button(frames(page), /^All/).innerText(), /All 8 frames/);
  assert.deepEqual(await ofRows(page), rows);
  assert.deepEqual(await profiles(page), columns);
  // Chosen with the button as well, and before their .cfg.
  await button(page, 'Bundled capture').click();
  await opened(page, 'xwr16xx');
  await choose(page, button(page, 'Open files'), named([1, 2, 3]).reverse());
  await page.waitForSelector('[data-waiting="cfg"]');
  assert.deepEqual(await listed(page), ['adc_data_Raw_1.bin', 'adc_data_Raw_2.bin', 'adc_data_Raw_3.bin']);
  await drop(page, [cfg]);
  await ready(page);
  assert.deepEqual(await ofRows(page), rows);
  assert.equal(await page.locator('[data-doubt]').count(), 0, 'numbers may begin at 1');
});

browserTest('parts: what is missing between them is named above the plots', { path }, async ({ page }) => {
  await ready(page);
  await drop(page, [...named([0, 2, 6]), cfg]);
  await page.waitForSelector('[data-doubt="missing-part"]');
  assert.match(
    await page.locator('[data-doubt="missing-part"]').innerText(),
    /adc_data_Raw_1\.bin, adc_data_Raw_3\.bin to adc_data_Raw_5\.bin are missing.*times are wrong/s,
  );
  await drop(page, [...named([0, 1, 2]), cfg]);
  await page.waitForFunction(() => !document.querySelector('[data-doubt]'));
  assert.equal(await page.locator('[data-parts="3"]').count(), 1);
});

browserTest('parts: files of several recordings are refused by name', { path }, async ({ page }) => {
  await ready(page);
  const one = (name) => ({ name, bytes: parts[0] });
  assert.match(
    await refused(page, [one('left_0.bin'), one('right_1.bin'), cfg]),
    /^right_1\.bin: expected a name that differs from left_0\.bin/,
  );
  assert.match(
    await refused(page, [one('drive.bin'), one('walk.bin')]),
    /^drive\.bin: expected a name that differs from walk\.bin in its number/,
  );
  assert.match(
    await refused(page, [one('raw_1.bin'), one('raw_01.bin')]),
    /^raw_01\.bin: expected one file of each number/,
  );
  assert.match(
    await refused(page, [one('day_20261124.bin'), one('day_20261125.bin')]),
    /^day_20261124\.bin: expected files of one recording, of which \d+ would be missing/,
  );
  assert.match(
    await refused(page, [one('raw_7.bin'), cfg, { ...cfg, name: 'other.cfg' }], 'ambiguous'),
    /one configuration \(\.cfg or \.mmwave\.json\)/,
  );
  assert.deepEqual((await listed(page))[0]?.startsWith('xwr16xx'), true, 'what was open stays');
});
