import assert from 'node:assert/strict';
import { parameters, parametersWith, reload } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

const theme = (page) => page.evaluate(() => document.documentElement.dataset.theme);
const themeIs = (page, wanted) =>
  page.waitForFunction((name) => document.documentElement.dataset.theme === name, wanted);
const goTo = (page, name) => page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name }).click();

browserTest(
  'shell: the pages are reached by keyboard, and keep their state',
  { path: '#/angle?array=ula12&targets=3:0&snr=9' },
  async ({ page }) => {
    await page.waitForSelector('[data-plot="spectrum"]');
    await page.keyboard.press('Tab');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Skip to the plots');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Tab');
    await page.keyboard.press('Enter');
    await page.waitForSelector('[data-table="detections"]');
    assert.match(page.url(), /#\/capture/);
    await page.waitForFunction(() => document.title.startsWith('Capture'));
    await goTo(page, 'Angle lab');
    await page.waitForSelector('[data-plot="spectrum"]');
    await parametersWith(page, (params) => params.get('array') === 'ula12');
    assert.equal(parameters(page).get('snr'), '9');
    await page.goBack();
    await page.waitForSelector('[data-table="detections"]');
  },
);

browserTest(
  'shell: a link that is followed right after a change is shown, and back is the change',
  {},
  async ({ page }) => {
    await page.waitForSelector('[data-plot="spectrum"]');
    // Less than the 150 ms after which the change is in the address.
    await page.getByRole('combobox', { name: 'Virtual array' }).selectOption('awr1642');
    await page.getByRole('link', { name: 'Coherent multipath' }).evaluate((link) => link.click());
    await parametersWith(page, (params) => params.get('fluctuation') === 'coherent');
    await page.goBack();
    await parametersWith(page, (params) => params.get('array') === 'awr1642');
  },
);

browserTest(
  'shell: colours follow the system until they are chosen, and the choice lasts',
  { scheme: 'dark' },
  async ({ page }) => {
    await page.waitForSelector('[data-plot="spectrum"]');
    assert.equal(await theme(page), 'dark');
    await page.getByRole('combobox', { name: 'Colours' }).selectOption('light');
    await themeIs(page, 'light');
    await reload(page);
    await page.waitForSelector('[data-plot="spectrum"]');
    assert.equal(await theme(page), 'light');
  },
);

browserTest(
  'shell: every control and button has a name, and help that can be shown',
  { path: '#/capture' },
  async ({ page }) => {
    await page.waitForSelector('[data-table="detections"]');
    const nameless = () =>
      page.evaluate(() =>
        [...document.querySelectorAll('button, input:not([hidden]), select, [role="application"]')]
          .filter(
            (node) => !(node.getAttribute('aria-label') ?? node.labels?.[0]?.textContent ?? node.textContent).trim(),
          )
          .map((node) => node.outerHTML),
      );
    assert.deepEqual(await nameless(), []);
    const hidden = await page.locator('.controls .help').count();
    await page.getByLabel('Explain the controls').check();
    await page.waitForFunction((least) => document.querySelectorAll('.controls .help').length > least, hidden + 10);
    await goTo(page, 'Angle lab');
    await page.waitForSelector('[data-plot="spectrum"]');
    assert.deepEqual(await nameless(), []);
    await goTo(page, 'Mounting angle');
    await page.waitForSelector('[data-plot="trajectory"]');
    assert.deepEqual(await nameless(), []);
    await goTo(page, 'Bird’s-eye view');
    await page.waitForSelector('[data-plot="image-iaa"]');
    assert.deepEqual(await nameless(), []);
  },
);

browserTest(
  'shell: nonsense in the address falls back to what is sensible',
  { path: '#/angle?array=nothing&targets=x&snr=1e9&methods=magic&seed=-4' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await parametersWith(page, (params) => params.get('array') === 'ula10' && params.get('snr') === '20');
  },
);

browserTest(
  'shell: paper is light, and has plots and tables without controls',
  { path: '#/angle', scheme: 'dark' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    assert.equal(await theme(page), 'dark');
    await page.emulateMedia({ media: 'print' });
    await themeIs(page, 'light');
    for (const gone of ['.sidebar', 'nav', '.introduction ul', '[data-plot="spectrum"] .tools']) {
      assert.ok(!(await page.locator(gone).first().isVisible()), gone);
    }
    for (const there of ['[data-plot="spectrum"] canvas', '[data-table="results"]', '.introduction p']) {
      assert.ok(await page.locator(there).first().isVisible(), there);
    }
    await page.emulateMedia({ media: 'screen' });
    await themeIs(page, 'dark');
  },
);

browserTest('shell: no style that gets into the page changes it', { path: '#/angle' }, async ({ page, problems }) => {
  const display = await page.evaluate(() => {
    const style = document.createElement('style');
    style.textContent = 'body { display: none }';
    document.head.append(style);
    return getComputedStyle(document.body).display;
  });
  assert.notEqual(display, 'none');
  assert.match(problems.splice(0).join(), /Content Security Policy/);
});
