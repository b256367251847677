/** Captures with the JSON of mmWave Studio in place of a .cfg. */
import assert from 'node:assert/strict';
import { combobox } from '../lib/controls.mjs';
import { drop, recording } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { opened, ready } from './page.mjs';
import { json, setup, studio } from './studio.mjs';

const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');

const rows = (page) =>
  page
    .locator('[data-table="detections"] tbody [data-field][data-value]')
    .evaluateAll((cells) => cells.map(({ dataset }) => `${dataset.field} ${dataset.value}`));
const facts = (page) => page.locator('[data-facts="capture"]').innerText();

browserTest(
  'studio: its JSON gives the same results as the .cfg of the same settings',
  { path: '#/angle' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await drop(page, [
      { name: 'a.bin', bytes: bin },
      { name: 'a.cfg', bytes: cfg },
    ]);
    await opened(page, 'a.bin');
    await ready(page);
    const [wanted, said] = [await rows(page), await facts(page)];
    await page.getByRole('link', { name: 'Angle lab' }).click();
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await drop(page, [
      json('mine.mmwave.json', studio()),
      json('mine.setup.json', setup),
      { name: 'b.bin', bytes: bin },
    ]);
    await opened(page, 'b.bin');
    assert.match(page.url(), /#\/capture/);
    await ready(page);
    assert.deepEqual(await rows(page), wanted);
    assert.equal(await facts(page), said);
    assert.match(
      await page.locator('.files').innerText(),
      /\.json\s+mine\.mmwave\.json[\s\S]*\.json\s+mine\.setup\.json/,
    );
    // Other settings give other results: the numbers are those of this file.
    const slower = studio();
    slower.mmWaveDevices[0].rfConfig.rlProfiles[0].rlProfileCfg_t.freqSlopeConst_MHz_usec = 30;
    slower.mmWaveDevices[0].rfConfig.rlFrameCfg_t.framePeriodicity_msec = 80;
    await drop(page, [json('slow.mmwave.json', slower), json('slow.setup.json', setup)]);
    await opened(page, 'slow.setup.json');
    await page.waitForFunction(() => /10\.\d.cm/.test(document.querySelector('[data-facts="capture"]')?.innerText));
    assert.match(await facts(page), /16 × 2 chirps, 80\.0.ms/);
  },
);

browserTest('studio: in any order, and without the board by hand', { path: '#/capture' }, async ({ page }) => {
  await ready(page);
  await drop(page, [json('mine.setup.json', setup)]);
  await page.waitForSelector('[data-waiting="bin,cfg"]');
  await drop(page, [{ name: 'mine.bin', bytes: bin }]);
  await page.waitForSelector('[data-waiting="cfg"]');
  await drop(page, [json('mine.mmwave.json', studio())]);
  await ready(page);
  const wanted = await rows(page);
  // The board is not known without its setup, and can be chosen.
  await drop(page, [{ name: 'other.bin', bytes: bin }, json('other.mmwave.json', studio())]);
  await opened(page, 'other.bin');
  assert.match(await page.getByRole('alert').innerText(), /Virtual array/);
  await combobox(page, 'Virtual array').selectOption('awr1642');
  await ready(page);
  assert.deepEqual(await rows(page), wanted);
});

browserTest(
  'studio: what cannot be read is refused by the name of its field',
  { path: '#/capture' },
  async ({ page }) => {
    await ready(page);
    const wrong = studio();
    delete wrong.mmWaveDevices[0].rfConfig.rlFrameCfg_t.numLoops;
    for (const [files, says] of [
      [
        [json('wrong.mmwave.json', wrong), { name: 'mine.bin', bytes: bin }],
        /^wrong\.mmwave\.json: .*mmWaveDevices\[0\]\.rfConfig\.rlFrameCfg_t\.numLoops is missing/,
      ],
      [[json('mine.mmwave.json', 'hello')], /JSON that mmWave Studio writes/],
      [[json('mine.mmwave.json', studio()), { name: 'mine.cfg', bytes: cfg }], /one configuration/],
      [[json('mine.setup.json', { mmWaveDevice: 5 }), json('mine.mmwave.json', studio())], /mmWaveDevice is 5/],
      [[json('mine.setup.json', setup), { name: 'mine.cfg', bytes: cfg }], /a \.mmwave\.json is expected with it/],
    ]) {
      await drop(page, files);
      await page.getByRole('alert').filter({ hasText: says }).waitFor();
    }
    await ready(page);
  },
);
