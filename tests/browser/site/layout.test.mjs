/** What is cut off, too small or said by a sign alone: at the widths that people have. */
import assert from 'node:assert/strict';
import { saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';
import { patient } from '../lib/trial.mjs';

const mounting = pages.find(({ path }) => path === '#/mounting');

browserTest(
  'layout: no table of Mounting is wider than the page at 1280 px',
  { path: mounting.path },
  async ({ page }) => {
    await page.waitForSelector(mounting.ready, patient);
    const wide = await page
      .locator('[data-table="results"] .table-scroll')
      .evaluateAll((tables) => tables.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.ariaLabel));
    assert.deepEqual(wide, []);
  },
);

browserTest(
  'layout: the plots and the bar of Mounting count time from the same moment',
  { path: `${mounting.path}?t=100` },
  async ({ page }) => {
    await page.waitForSelector(mounting.ready, patient);
    const [, shown, frame] = /^([\d.]+) s of .* frame (\d+)/.exec(await page.locator('output[data-time]').innerText());
    for (const plot of ['doppler-azimuth', 'birds-eye']) {
      const caption = page.locator(`[data-plot="${plot}"] figcaption`);
      const [, seconds, number] = /([\d.]+) s, frame (\d+)/.exec(await caption.innerText());
      assert.equal(number, frame, plot);
      assert.ok(Math.abs(Number(seconds) - Number(shown)) <= 0.051, `${seconds} and ${shown} s`);
    }
  },
);

browserTest(
  'layout: names of what became of frames stand beside their bars',
  { path: mounting.path },
  async ({ page }) => {
    await page.waitForSelector(mounting.ready, patient);
    const { bytes } = await saved(
      page,
      page.locator('[data-plot="frame-weights"]').getByRole('button', { name: 'SVG' }),
    );
    const [right, bars] = await page.evaluate((source) => {
      const host = document.createElement('div');
      host.innerHTML = source.replace(/^<\?xml[^>]*>/, '');
      document.body.append(host);
      const box = (element) => element.getBoundingClientRect();
      const names = ['used', 'standing', 'slow', 'turning', 'sparse', 'off speed', 'no motion'];
      const texts = [...host.querySelectorAll('text')].filter(({ textContent }) => names.includes(textContent.trim()));
      const lanes = [...host.querySelectorAll('rect, path')].map(box).filter(({ height }) => height > 2 && height < 14);
      const found = [Math.max(...texts.map((text) => box(text).right)), Math.min(...lanes.map(({ left }) => left))];
      host.remove();
      return texts.length === names.length ? found : [texts.length, 0];
    }, bytes.toString('utf8'));
    assert.ok(right <= bars, `names end at ${right}, bars begin at ${bars}`);
  },
);

for (const { name, path, ready } of pages) {
  browserTest(
    `layout: ${name} has large boxes, plots in words and near the keyboard, paper without buttons, and fits at 200 %`,
    { path },
    async ({ page }) => {
      await page.waitForSelector(ready, patient);
      const small = await page
        .getByRole('checkbox')
        .or(page.getByRole('radio'))
        .evaluateAll((boxes) => boxes.filter((box) => box.getBoundingClientRect().width < 16).map(({ id }) => id));
      assert.deepEqual(small, []);
      const silent = await page.locator('.plot').evaluateAll((hosts) =>
        hosts
          .filter((host) => {
            const ids = host.getAttribute('aria-describedby')?.split(' ') ?? [];
            return ids.length === 0 || ids.some((id) => !host.getRootNode().getElementById(id)?.textContent.trim());
          })
          .map((host) => host.getRootNode().host.dataset.plot),
      );
      assert.deepEqual(silent, []);

      // The first key of the keyboard passes over the controls.
      await page.keyboard.press('Tab');
      assert.equal(await page.evaluate(() => document.activeElement.textContent.trim()), 'Skip to the plots');
      await page.keyboard.press('Enter');
      await page.keyboard.press('Tab');
      assert.ok(
        await page.evaluate(() => document.activeElement.closest('#plots') !== null),
        'the next is of the plots',
      );

      // Names of cells and links stand in their text.
      await page.emulateMedia({ media: 'print' });
      const idle = page.locator('button:not(.cell-button, .link, .plot-handle), details:not([open])');
      assert.deepEqual(await idle.filter({ visible: true }).allInnerTexts(), []);
      await page.emulateMedia({ media: 'screen' });

      // What a window of 1280 x 800 px shows at twice the size.
      await page.setViewportSize({ width: 640, height: 400 });
      const out = await page.locator('.site-head :is(a, button, select):visible').evaluateAll((all) =>
        all
          .filter((one) => {
            const { left, right, width } = one.getBoundingClientRect();
            return left < 0 || right > innerWidth || width < 20;
          })
          .map((one) => one.textContent),
      );
      assert.deepEqual(out, []);
    },
  );
}

browserTest(
  'layout: phones do not zoom into fields, and have a minus where numbers may be negative',
  { path: '#/angle', viewport: 'phone' },
  async ({ page }) => {
    await page.waitForSelector(pages[0].ready);
    await page.getByRole('button', { name: 'Show array, targets and settings' }).click();
    await page.getByRole('spinbutton').first().waitFor();
    const fields = await page.getByRole('spinbutton').evaluateAll((all) =>
      all.map((field) => ({
        name: field.name,
        size: Number.parseFloat(getComputedStyle(field).fontSize),
        negative: Number(field.ariaValueMin) < 0,
        keys: field.inputMode,
      })),
    );
    assert.ok(fields.some(({ negative }) => negative));
    for (const { name, size, negative, keys } of fields) {
      assert.ok(size >= 16, `${name}: ${size} px`);
      // Pads of numbers have no minus.
      assert.equal(keys === 'text', negative, name);
    }
  },
);
