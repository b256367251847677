/** The range-azimuth map of a capture's frames. */
import assert from 'node:assert/strict';
import { assertCsv, assertPng, clickWhenThere, drop, parametersWith, recording, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

const shows = (page, frame) => page.waitForSelector(`[data-range-azimuth="${frame}"][aria-busy="false"]`);
const caption = (page) => page.locator('[data-plot="range-azimuth"] figcaption').innerText();
const map = async (page) => {
  const csv = await saved(page, '[data-plot="range-azimuth"] [data-export="csv"]');
  return assertCsv(csv, 'azimuth_deg,range_m,power_dbfs').map((row) => row.map(Number));
};
const strongest = (rows) => rows.reduce((best, row) => (row[2] !== 0 && row[2] > best[2] ? row : best), [0, 0, -999]);

browserTest(
  'range-azimuth: the strongest target stands where the board saw it, by each method',
  { path: '#/capture?frame=3' },
  async ({ page }) => {
    await shows(page, 3);
    const rows = await map(page);
    assert.equal(rows.length, 301 * 256);
    const [azimuth, range] = strongest(rows);
    assert.ok(Math.abs(range - 2.95) <= 0.06, `at ${range} m`);
    assert.ok(Math.abs(azimuth + 10.8) <= 2, `at ${azimuth} degrees`);
    assert.match(await caption(page), /^Bartlett.*spectra of the \d+ cells/);
    await page.locator('select[name="angle"]').selectOption('nomp');
    await page.waitForFunction(() =>
      /^NOMP, targets/.test(within('[data-plot="range-azimuth"]', 'figcaption')?.textContent),
    );
    const few = await map(page);
    assert.ok(Math.abs(strongest(few)[0] + 10.8) <= 2);
    const filled = (all) => all.filter(([, , power]) => power < 0 && power > -200).length;
    assert.ok(filled(few) < filled(rows) / 10, 'targets are points, spectra are lines');
    assertPng(await saved(page, '[data-plot="range-azimuth"] [data-export="png"]'));
  },
);

browserTest('range-azimuth: it plays, and says which frame it is', { path: '#/capture' }, async ({ page }) => {
  await shows(page, 0);
  assert.match(await caption(page), /one frame at a time: this is the first/);
  const first = await map(page);
  await page.locator('[data-action="play-map"]').click();
  // Where frames come faster than maps, some are passed over.
  await page.waitForFunction(
    () => Number(document.querySelector('[data-range-azimuth]')?.getAttribute('data-range-azimuth')) > 0,
  );
  await page.locator('[data-plot="range-azimuth"] .plot').focus();
  await page.keyboard.press(' ');
  await page.waitForSelector('[data-action="play-map"][aria-pressed="false"]');
  await page.waitForFunction(() => {
    const at = new URLSearchParams(location.hash.split('?')[1]).get('frame');
    return document.querySelector(`[data-range-azimuth="${at}"]`);
  });
  await page.keyboard.press('Shift+ArrowRight');
  await parametersWith(page, (params) => params.get('frame') === '7');
  await shows(page, 7);
  assert.match(await page.locator('[data-plot="range-azimuth"] .detail').innerText(), /frame 8 of 8/);
  assert.doesNotMatch(await caption(page), /this is the first/);
  assert.notDeepEqual(await map(page), first);
  // The quarter of the samples' amplitude is 12 dB; the frames of another capture are another's.
  const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
  const weaker = Buffer.from(bin);
  for (let i = 0; i < bin.length; i += 2) weaker.writeInt16LE(Math.round(bin.readInt16LE(i) / 4), i);
  await drop(page, [
    { name: 'weaker.bin', bytes: weaker },
    { name: 'profile.cfg', bytes: recording('profile.cfg') },
  ]);
  await page.waitForFunction(() => document.querySelector('.files').textContent.includes('weaker.bin'));
  await shows(page, 0);
  const difference = strongest(first)[2] - strongest(await map(page))[2];
  assert.ok(Math.abs(difference - 20 * Math.log10(4)) < 0.3, `${difference} dB`);
});

browserTest(
  'range-azimuth: a method that one frame does not suit is named',
  { path: '#/capture?angle=music' },
  async ({ page }) => {
    await page.waitForSelector('[role="alert"][data-error]');
    assert.match(await page.locator('[role="alert"][data-error]').innerText(), /No range-azimuth map of one frame/);
    await page.locator('select[name="angle"]').selectOption('iaa');
    await shows(page, 0);
    assert.equal(await page.locator('[role="alert"][data-error]').count(), 0);
  },
);

browserTest(
  'range-azimuth: a slow method shows how far it is, stops, and goes on',
  { path: '#/capture?frame=0&angle=sparse-bayesian&falseAlarm=1e-2' },
  async ({ page }) => {
    const { value, max } = await clickWhenThere(page, '[data-opening] [data-action="cancel-map"]');
    assert.ok(value >= 0 && value < max, `${value} of ${max}`);
    await page.waitForSelector('[data-interrupted] [data-action="resume-map"]');
    await page.locator('input[name="frame"]').press('ArrowRight');
    await page.waitForFunction(() =>
      within('[data-plot="range-profile"]', 'figcaption')?.textContent.includes('Frame 2 of'),
    );
    assert.equal(await page.locator('[data-range-azimuth], [data-action="cancel-map"]').count(), 0, 'it rests');
    await page.locator('[data-action="resume-map"]').click();
    await page.locator('[data-action="cancel-map"]').click();
    await page.locator('[data-action="resume-map"]').click();
    await page.waitForSelector('[data-action="cancel-map"]');
    // A quick method is there at once, whatever the slow one was at.
    await page.locator('select[name="angle"]').selectOption('bartlett');
    await shows(page, 1);
    assert.equal(await page.locator('[data-interrupted], [data-action="cancel-map"]').count(), 0);
  },
);
