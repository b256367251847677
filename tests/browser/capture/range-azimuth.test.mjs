/** The range-azimuth map of a capture's frames. */
import assert from 'node:assert/strict';
import { button, cancelOf, combobox, figure, plotOf, progress } from '../lib/controls.mjs';
import { assertCsv, assertPng, clickWhenThere, drop, parametersWith, recording, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { captionOf, frameSlider, opened } from './page.mjs';

const MAP = 'Range-azimuth map';
const method = (page) => combobox(page, 'Angle by');
/** The page's own button, in the slot of the plot's element. */
const play = (page, name) => page.locator('[data-plot="range-azimuth"]').getByRole('button', name);
const working = (page) => progress(page, MAP);
const stopped = (page) => page.locator('.progress-line', { hasText: 'The range-azimuth map was stopped' });
const save = (page, as) => saved(page, button(figure(page, MAP), as));

const shows = (page, frame) => page.waitForSelector(`[data-range-azimuth="${frame}"][aria-busy="false"]`);
const caption = (page) => figure(page, MAP).locator('figcaption').innerText();
const map = async (page) => {
  return assertCsv(await save(page, 'CSV'), 'azimuth_deg,range_m,power_dbfs').map((row) => row.map(Number));
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
    await method(page).selectOption('nomp');
    await captionOf(page, MAP, /^NOMP, targets/);
    const few = await map(page);
    assert.ok(Math.abs(strongest(few)[0] + 10.8) <= 2);
    const filled = (all) => all.filter(([, , power]) => power < 0 && power > -200).length;
    assert.ok(filled(few) < filled(rows) / 10, 'targets are points, spectra are lines');
    assertPng(await save(page, 'PNG'));
  },
);

browserTest('range-azimuth: it plays, and says which frame it is', { path: '#/capture' }, async ({ page }) => {
  await shows(page, 0);
  assert.match(await caption(page), /one frame at a time: this is the first/);
  const first = await map(page);
  await play(page, { name: 'Play' }).click();
  // Where frames come faster than maps, some are passed over.
  await page.waitForFunction(
    () => Number(document.querySelector('[data-range-azimuth]')?.getAttribute('data-range-azimuth')) > 0,
  );
  await plotOf(page, MAP).focus();
  await page.keyboard.press(' ');
  await play(page, { name: 'Play', pressed: false }).waitFor();
  await page.waitForFunction(() => {
    const at = new URLSearchParams(location.hash.split('?')[1]).get('frame');
    return document.querySelector(`[data-range-azimuth="${at}"]`);
  });
  await page.keyboard.press('Shift+ArrowRight');
  await parametersWith(page, (params) => params.get('frame') === '7');
  await shows(page, 7);
  assert.match(await figure(page, MAP).locator('.detail').innerText(), /frame 8 of 8/);
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
  await opened(page, 'weaker.bin');
  await shows(page, 0);
  const difference = strongest(first)[2] - strongest(await map(page))[2];
  assert.ok(Math.abs(difference - 20 * Math.log10(4)) < 0.3, `${difference} dB`);
});

browserTest(
  'range-azimuth: a method that one frame does not suit is named',
  { path: '#/capture?angle=music' },
  async ({ page }) => {
    const alert = page.getByRole('alert');
    assert.match(await alert.innerText(), /No range-azimuth map of one frame/);
    await method(page).selectOption('iaa');
    await shows(page, 0);
    assert.equal(await alert.count(), 0);
  },
);

browserTest(
  'range-azimuth: a slow method shows how far it is, stops, and goes on',
  { path: '#/capture?frame=0&angle=sparse-bayesian&falseAlarm=1e-2' },
  async ({ page }) => {
    const { value, max } = await clickWhenThere(page, cancelOf(MAP));
    assert.ok(value >= 0 && value < max, `${value} of ${max}`);
    const goOn = button(stopped(page), 'Go on');
    await goOn.waitFor();
    await frameSlider(page).press('ArrowRight');
    await captionOf(page, 'Range profile', 'Frame 2 of');
    assert.equal(await figure(page, MAP).or(working(page)).count(), 0, 'it rests');
    await goOn.click();
    await button(page.locator('.progress-line').filter({ has: working(page) }), 'Cancel').click();
    await goOn.click();
    await working(page).waitFor();
    // A quick method is there at once, whatever the slow one was at.
    await method(page).selectOption('bartlett');
    await shows(page, 1);
    assert.equal(await stopped(page).or(working(page)).count(), 0);
  },
);
