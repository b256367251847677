/** The first minute: what each page is for, examples to begin with, hints, verdicts, and where things stand. */
import assert from 'node:assert/strict';
import { drop, reload } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';
import { patient } from '../lib/trial.mjs';
import { typeNumber } from '../lib/type.mjs';

const examplesOf = (page) => page.getByRole('list', { name: 'Examples' }).getByRole('link');
/** Waits until the example of a link is shown. */
const shows = (page, link) => link.and(page.locator('[aria-current="true"]')).waitFor();
const plotOf = (page) => page.getByRole('figure', { name: 'Angle spectrum' });

/** Where examples show other methods than a fresh visit. */
const READY = {
  'angle lab': 'tr [data-field="azimuth"][data-value]',
  'birds-eye view': '[aria-busy="false"] [data-field="milliseconds"], [aria-busy="false"] [data-plot^="image-"]',
};

for (const { name, path, ready: fresh } of pages) {
  const ready = READY[name] ?? fresh;
  browserTest(
    `first minute: ${name} says what it is for, and its examples work`,
    { path, timeout: 240_000 },
    async ({ page }) => {
      await page.waitForSelector(ready, patient);
      assert.match(await page.locator('.introduction p').innerText(), /^[A-Z].*[.?]$/s);
      const examples = examplesOf(page);
      const count = await examples.count();
      assert.ok(count >= 4);
      for (let i = 0; i < count; i++) {
        const title = await examples.nth(i).innerText();
        const query = (await examples.nth(i).getAttribute('href')).split('?')[1];
        await examples.nth(i).click();
        await shows(page, examples.nth(i));
        // The drive before stays until the example's own is simulated.
        if (path.includes('mounting')) {
          const name = new URLSearchParams(query).get('scenario') ?? 'delphi';
          await page.locator('[data-fact="name"]').filter({ hasText: name }).waitFor(patient);
        }
        assert.equal(await examples.and(page.locator('[aria-current]')).count(), 1, title);
        assert.equal(await page.locator('[data-notice]').count(), 0, `${title}: all of its link is understood`);
        await page.waitForSelector(ready, patient);
        if (path.includes('networks')) await page.waitForSelector('[data-attempt]', patient);
        assert.deepEqual(await page.getByRole('alert').allInnerTexts(), [], title);
      }
      await page.goBack();
      await shows(page, examples.nth(count - 2));
    },
  );
}

browserTest(
  'first minute: the hint to drag goes after the first drag, for good',
  { path: '#/angle' },
  async ({ page }) => {
    await page.waitForSelector('[data-hint]');
    const box = await page.getByRole('button', { name: 'Target 1: azimuth' }).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x - 30, box.y + 10, { steps: 4 });
    await page.mouse.up();
    await page.locator('[data-hint]').waitFor({ state: 'detached' });
    await reload(page);
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    assert.equal(await page.locator('[data-hint]').count(), 0);
  },
);

browserTest(
  'first minute: controls and the main plot are in view together',
  { path: '#/angle', viewport: 'desktop' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    const last = page.locator('.controls .group').last();
    await last.scrollIntoViewIfNeeded();
    const { height } = page.viewportSize();
    const inView = (box) => box.y < height && box.y + box.height > 0;
    assert.ok(inView(await last.boundingBox()), 'the last group of controls');
    assert.ok(inView(await plotOf(page).locator('.u-over').boundingBox()), 'the spectrum');
  },
);

browserTest(
  'first minute: on a phone controls are a sheet under the plot, closed by Escape',
  { path: '#/angle', viewport: 'phone' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    const plot = await plotOf(page).locator('.u-over').boundingBox();
    assert.ok(plot.y < 400, `the plot begins at ${plot.y}`);
    const toggle = page.getByRole('button', { name: 'array, targets and settings' });
    await toggle.click();
    await plotOf(page).scrollIntoViewIfNeeded();
    const sheet = await page.locator('.sidebar').boundingBox();
    assert.ok(
      sheet.y > 300 && Math.abs(sheet.y + sheet.height - page.viewportSize().height) < 2,
      'at the foot of the screen',
    );
    const snr = page.getByRole('spinbutton', { name: 'SNR' });
    await snr.click();
    await snr.press('ArrowUp');
    await plotOf(page)
      .locator('figcaption')
      .filter({ hasText: /SNR 21\.0/ })
      .waitFor();
    await snr.press('Escape');
    await snr.waitFor({ state: 'hidden' });
    assert.ok(await toggle.evaluate((node) => node === document.activeElement));
  },
);

browserTest('first minute: Tab goes to the plots before the controls', { path: '#/angle' }, async ({ page }) => {
  await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.textContent.trim()), 'Skip to the plots');
  await page.keyboard.press('Enter');
  for (let tabs = 1; tabs <= 8; tabs++) {
    await page.keyboard.press('Tab');
    if (await page.evaluate(() => focused().matches('.plot, .plot-handle'))) return;
  }
  assert.fail('no plot within eight tab stops');
});

browserTest(
  'first minute: Mounting says which method to go by, and why there is no angle',
  { path: '#/mounting?source=simulated&duration=60&methods=recursive,weighted-mean&nominal=0' },
  async ({ page }) => {
    await page.waitForSelector(
      '[data-verdict]:is([data-verdict="good"], [data-verdict="off"], [data-verdict="open"])',
      patient,
    );
    const verdict = await page.locator('[data-verdict]').boundingBox();
    const table = await page.locator('[data-row="recursive"]').first().boundingBox();
    assert.ok(verdict.y < table.y, 'above the table');
    // Detections alone: no table says how the car moved.
    const rows = Array.from({ length: 3000 }, (_, i) => {
      const azimuth = ((i * 37) % 100) - 50;
      return `${(Math.floor(i / 10) * 0.05).toFixed(2)},${azimuth},${(-10 * Math.cos((azimuth * Math.PI) / 180)).toFixed(3)}`;
    });
    await drop(page, [
      { name: 'detections.csv', bytes: Buffer.from(`time_s,azimuth_deg,range_rate_mps\n${rows.join('\n')}\n`) },
      { name: 'motion.csv', bytes: Buffer.from('time_s,yaw_rate_degps,speed_mps\n900,0,10\n901,0,10\n') },
    ]);
    await page.waitForSelector('[data-notice="place"]');
    await typeNumber(page.getByRole('spinbutton', { name: 'Ahead of rear axle' }), '3.5');
    await page.waitForSelector('[data-verdict="none"]', patient);
    assert.match(await page.locator('[data-verdict]').innerText(), /no motion at the time/);
    const shown = await page.locator('[data-row="recursive"] [data-field="angleDeg"]').innerText();
    assert.equal(shown, '–', 'no number where the drive tells none');
    assert.equal(await page.locator('[data-row="recursive"] [data-field="misaligned"]').innerText(), '–');
  },
);

browserTest('first minute: the result of a run is in view', { path: '#/networks' }, async ({ page }) => {
  await page.waitForSelector('[data-card]');
  await page
    .getByRole('form', { name: 'Networks settings' })
    .getByRole('button', { name: 'Run on this scene' })
    .click();
  await page.waitForSelector('[data-attempt] [data-plot="attempt"]', patient);
  const box = await page.locator('[data-plot="attempt"] .u-over').boundingBox();
  const { height } = page.viewportSize();
  assert.ok(box.y >= 0 && box.y < height - 100, `the scene begins at ${box.y}`);
});

browserTest('first minute: the examples of the angle lab show what they say', { path: '#/angle' }, async ({ page }) => {
  await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
  const show = async (title) => {
    const link = examplesOf(page).filter({ hasText: title });
    const params = new URLSearchParams((await link.getAttribute('href')).split('?')[1]);
    await link.click();
    // The table is of the example's targets and methods, and all have answered.
    await page.waitForFunction(
      ([targets, methods]) => {
        const all = (selector) => [...document.querySelectorAll(`[data-table="results"] ${selector}`)];
        const rows = all('[data-row]').map(({ dataset }) => dataset.row);
        const truths = all('[data-field="truth"]').map(({ dataset }) => dataset.value);
        return `${truths}` === targets && `${rows.sort()}` === methods && all('[aria-busy="true"]').length === 0;
      },
      [params.get('targets').replaceAll(/:[^,]*/g, ''), `${params.get('methods').split(',').sort()}`],
    );
    return Object.fromEntries(
      await page
        .locator('[data-table="results"] [data-row]')
        .evaluateAll((rows) =>
          rows.map((row) => [
            row.dataset.row,
            [...row.querySelectorAll('[data-field="error"]')].map(({ dataset }) =>
              dataset.value === undefined ? null : Math.abs(Number(dataset.value)),
            ),
          ]),
        ),
    );
  };
  const near = (errors, limit) => errors.every((error) => error !== null && error < limit);
  const beam = await show('Two targets inside a beam');
  assert.ok(beam.bartlett.includes(null) && near(beam.music, 0.2) && near(beam.capon, 0.2), JSON.stringify(beam));
  const paths = await show('Coherent multipath');
  assert.ok(!near(paths.music, 0.15) && near(paths.iaa, 0.1), JSON.stringify(paths));
  assert.ok(near(paths['maximum-likelihood'], 0.1));
  const sparse = await show('48-element sparse array');
  assert.ok(sparse.bartlett.includes(null) && near(sparse.iaa, 0.1) && near(sparse.nomp, 0.1), JSON.stringify(sparse));
  const masking = await show('Masking');
  assert.ok(!near(masking.bartlett, 1) && near(masking.iaa, 0.5) && near(masking.nomp, 0.5), JSON.stringify(masking));
});

browserTest(
  'first minute: on a phone the hint to drag covers neither plot nor tools',
  { path: '#/angle', viewport: 'phone' },
  async ({ page }) => {
    const hint = await page.locator('[data-hint]').boundingBox();
    for (const selector of ['.tools', '.plot']) {
      const box = await page.locator(`[data-plot="spectrum"] ${selector}`).boundingBox();
      assert.ok(hint.y >= box.y + box.height || hint.y + hint.height <= box.y, `${selector} is covered`);
    }
  },
);

browserTest(
  'first minute: on a phone Mounting’s verdict is seen at once, and stands where it was awaited',
  { path: '#/mounting', viewport: 'phone' },
  async ({ page }) => {
    const place = async (kind) => (await page.waitForSelector(`[data-verdict="${kind}"]`, patient)).boundingBox();
    const before = await place('awaited');
    const { y, height } = await place('off');
    assert.equal(y, before.y);
    assert.ok(y + height < page.viewportSize().height - 56, `it ends at ${y + height}`);
    assert.match(
      await page.locator('[data-verdict] .head').innerText(),
      /^Mounting angle −(1\.9|2\.0)\d° ± 0\.0\d°: misaligned/,
    );
  },
);

browserTest(
  'first minute: plots that are out of sight are drawn all the same',
  { path: '#/mounting' },
  async ({ page }) => {
    await page.waitForSelector('[data-plot="trajectory"] [data-series="found"]', patient);
    const inks = () =>
      page.locator('.plot-frame canvas.plot-canvas, .plot-frame .u-wrap canvas').evaluateAll((canvases) =>
        canvases.map((canvas) => {
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          const colours = new Set();
          for (let i = 0; i < data.length; i += 4) colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
          return colours.size;
        }),
      );
    // Axes alone have up to 560.
    const allDrawn = (colours) => colours.length === 5 && colours.every((count) => count > 600);
    let colours = [];
    for (let tries = 0; tries < 200 && !allDrawn(colours); tries++) {
      await page.evaluate(() => new Promise(requestAnimationFrame));
      colours = await inks();
    }
    assert.ok(allDrawn(colours), `colours: ${colours}`);
  },
);
