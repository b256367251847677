/** Plots saved as pictures: PNG at twice the screen's resolution and SVG, each with what it shows and where it is from. */
import assert from 'node:assert/strict';
import { assertPng, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';

const READY = Object.fromEntries(pages.map(({ path, ready }) => [path, ready]));
const today = () => new Date().toISOString().slice(0, 10);

/** Keeps what is written on canvases from now on. */
const watchText = (page) =>
  page.evaluate(() => {
    window.written = [];
    const { fillText } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.fillText = function keep(text, ...place) {
      window.written.push(text);
      return fillText.call(this, text, ...place);
    };
  });

const sizeOf = ({ bytes }) => ({ width: bytes.readUInt32BE(16), height: bytes.readUInt32BE(20) });

const picture = (page, plot, kind) =>
  saved(page, page.locator(`[data-plot="${plot}"]`).getByRole('button', { name: kind, exact: true }));

const hostOf = (page, plot) =>
  page
    .locator(`[data-plot="${plot}"] .plot`)
    .evaluate(({ clientWidth, clientHeight }) => ({ width: clientWidth, height: clientHeight }));

/** What a reader of the file finds in it. */
const drawn = (page, { name, bytes }) => {
  assert.match(name, /^boresight-.*\.svg$/);
  return page.evaluate((text) => {
    const { documentElement: root } = new DOMParser().parseFromString(text, 'image/svg+xml');
    const all = (selector) => [...root.querySelectorAll(selector)];
    return {
      root: root.nodeName,
      width: Number(root.getAttribute('width')),
      viewBox: root.getAttribute('viewBox'),
      title: root.querySelector('title')?.textContent,
      texts: all('text').map((node) => node.textContent),
      sizes: [...new Set(all('text').map((node) => node.getAttribute('font-size')))],
      // Lines of a series have a point for each of its numbers.
      lines: all('path').filter(
        (node) => node.getAttribute('d').split('L').length > 200 && node.getAttribute('stroke') !== 'none',
      ).length,
      dashed: all('path[stroke-dasharray]').length,
      images: all('image').map((node) => ({
        data: node.getAttribute('xlink:href').slice(0, 22),
        opacity: Number(node.getAttribute('opacity')),
      })),
    };
  }, bytes.toString('utf8'));
};

function assertCaption(texts, { page, settings, data, path }) {
  // Lines break between words.
  const plain = (text) => text.replaceAll(/\s/g, '');
  const all = plain(texts.join(''));
  for (const part of [settings, `data: ${data}`, today(), /Boresight\d+\.\d+\.\d+/]) {
    if (part instanceof RegExp) assert.match(all, part);
    else assert.ok(all.includes(plain(part)), `“${part}” in ${all}`);
  }
  // However long it is and wherever it is broken, the link is whole.
  assert.ok(all.includes(path), `${path} in ${all}`);
  assert.ok(all.includes(plain(`${page}: `)), all);
}

browserTest(
  'pictures: a plot of lines is saved at twice the screen’s resolution, and as vectors',
  { path: '#/angle?array=ula12&targets=-7:0,4:-3&snr=9&snapshots=64&seed=5&methods=bartlett,capon,music' },
  async ({ page, url }) => {
    await page.waitForSelector(READY['#/angle']);
    await page.waitForFunction(() => location.hash.includes('ula12'));
    const caption = {
      page: 'Angle lab',
      settings: 'ula12, SNR 9.0 dB, 64 snapshots, targets: −7.0°, +4.0° at −3.0 dB',
      data: 'simulated, seed 5',
      path: `${url}#/angle?array=ula12&targets=-7:0,4:-3&snr=9&snapshots=64&seed=5&methods=bartlett,capon,music`,
    };
    const host = await hostOf(page, 'spectrum');
    await watchText(page);
    const image = await picture(page, 'spectrum', 'PNG');
    assertPng(image);
    const size = sizeOf(image);
    assert.equal(size.width, 2 * host.width);
    assert.ok(size.height > 2 * host.height, 'the plot, a heading and a caption');
    const written = await page.evaluate(() => window.written);
    assertCaption(written, caption);
    assert.ok(written.includes('Angle spectrum') && written.includes('MUSIC'));

    const drawing = await drawn(page, await picture(page, 'spectrum', 'SVG'));
    assert.equal(drawing.root, 'svg');
    assert.equal(drawing.width, host.width, 'as large as on the screen');
    assert.equal(drawing.viewBox, `0 0 ${size.width} ${size.height}`, 'as fine as the image');
    assert.equal(drawing.title, 'Angle spectrum');
    assert.equal(drawing.lines, 3, 'a line for each method that has a spectrum');
    assert.deepEqual(drawing.images, [], 'nothing of it is a raster');
    assertCaption(drawing.texts, caption);
    for (const text of ['Angle spectrum', 'Azimuth (°), positive to the left of boresight', '−30', 'Capon (MVDR)'])
      assert.ok(drawing.texts.includes(text), `${text} is text`);
    assert.deepEqual(drawing.sizes.sort(), ['22px', '24px', '26px']);
    assert.ok(drawing.dashed >= 3, 'the noise and the targets’ stems');
  },
);

browserTest(
  'pictures: a map embeds its raster, under axes and boxes of vectors',
  { path: '#/capture', viewport: 'phone', scheme: 'dark', deviceScaleFactor: 2 },
  async ({ page }) => {
    await page.waitForSelector(READY['#/capture']);
    await page.locator('[data-plot="range-doppler"]').scrollIntoViewIfNeeded();
    const host = await hostOf(page, 'range-doppler');
    assert.equal(sizeOf(await picture(page, 'range-doppler', 'PNG')).width, 4 * host.width);
    const drawing = await drawn(page, await picture(page, 'range-doppler', 'SVG'));
    assert.deepEqual(drawing.images, [{ data: 'data:image/png;base64,', opacity: 1 }]);
    assert.ok(drawing.texts.includes('Range (m)') && drawing.texts.includes('Range-Doppler map'));
    assert.ok(drawing.dashed >= 1, 'the chosen cell’s crosshair');
    assertCaption(drawing.texts, {
      page: 'Capture',
      settings: 'CFAR excision',
      data: 'xwr16xx_crw_dca_module_2018_1015v2.bin, profile.cfg',
      path: '#/capture?frame=all',
    });
  },
);

for (const [path, ready, plot, settings, data] of [
  ['#/mounting', READY['#/mounting'], 'angle-history', 'radar 1', 'front_radar.csv, pose_10hz.csv.gz'],
  ['#/birdseye', READY['#/birdseye'], 'image-iaa', 'radars: left', 'simulated street, seed 1'],
  ['#/networks', '[data-plot="metrics"] canvas', 'metrics', '6 targets, SNR 15 dB', 'network '],
]) {
  browserTest(`pictures: ${plot} and what is beside it have a caption in both forms`, { path }, async ({ page }) => {
    await page.waitForSelector(ready, { timeout: 80_000 });
    await watchText(page);
    const image = await picture(page, plot, 'PNG');
    assert.equal(sizeOf(image).width, 2 * (await hostOf(page, plot)).width);
    const title = await page.locator('h1').innerText();
    const caption = { page: title, settings, data, path };
    assertCaption(await page.evaluate(() => window.written), caption);
    for (const name of await page.locator('[data-plot]').evaluateAll((all) => all.map(({ dataset }) => dataset.plot))) {
      const drawing = await drawn(page, await picture(page, name, 'SVG'));
      assertCaption(drawing.texts, caption);
    }
  });
}
