/** The dialog of “Copy as code”: by keys alone, with the clipboard and without, on desktop and phone. */
import assert from 'node:assert/strict';
import { openCode } from './lib/code-dialog.mjs';
import { runScript } from './lib/code-run.mjs';
import { browserTest } from './lib/harness.mjs';
import { findings } from './site/axe.mjs';

const path = '#/angle';
const ready = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const showCode = (page) => page.getByRole('button', { name: 'Copy as code' });
const hasFocus = (control) => control.evaluate((node) => node === document.activeElement);

/** Presses Tab until something has the focus. */
async function tabTo(page, control) {
  for (let tries = 0; tries < 80; tries++) {
    if (await hasFocus(control)) return;
    await page.keyboard.press('Tab');
  }
  assert.fail(`${control} has no focus`);
}

browserTest(
  'code dialog: opened, read, copied from and closed by keys alone',
  { path, permissions: ['clipboard-read', 'clipboard-write'] },
  async ({ page }) => {
    await ready(page);
    await tabTo(page, showCode(page));
    await page.keyboard.press('Enter');
    const dialog = page.getByRole('dialog', { name: 'What this page shows, as code' });
    await dialog.waitFor();
    const tab = (name) => dialog.getByRole('tab', { name });
    const code = (name) => dialog.getByRole('region', { name: `${name}, scrollable` });
    await tabTo(page, tab('JavaScript'));
    for (const [key, name] of [
      ['ArrowRight', 'Command line'],
      ['ArrowRight', 'JavaScript'],
      ['ArrowLeft', 'Command line'],
      ['ArrowLeft', 'JavaScript'],
    ]) {
      await page.keyboard.press(key);
      await code(name).waitFor();
      assert.ok(await hasFocus(tab(name)), name);
      assert.deepEqual(await dialog.getByRole('tab', { selected: true }).allInnerTexts(), [name]);
    }
    await page.keyboard.press('Tab');
    assert.ok(await hasFocus(code('JavaScript')), 'the code itself can be reached, to scroll it');
    await tabTo(page, dialog.getByRole('button', { name: 'Copy' }));
    await page.keyboard.press('Enter');
    await dialog.getByRole('status').getByText('Copied').waitFor();
    const text = await page.evaluate(() => navigator.clipboard.readText());
    assert.equal(text, await code('JavaScript').textContent());
    const lines = await runScript(text);
    const shown = await page
      .locator('[data-row="music"] [data-target="0"][data-field="azimuth"]')
      .getAttribute('data-value');
    assert.ok(lines.some(([method, azimuth]) => method === 'music' && azimuth === Number(shown)));
    // Nothing behind a modal dialog can be reached.
    for (let presses = 0; presses < 12; presses++) {
      await page.keyboard.press('Tab');
      assert.ok(
        await page.evaluate(() => document.activeElement === document.body || document.activeElement.closest('dialog')),
        await page.evaluate(() => document.activeElement.outerHTML),
      );
    }
    await page.keyboard.press('Escape');
    await dialog.waitFor({ state: 'detached' });
    assert.ok(await hasFocus(showCode(page)));
    await page.keyboard.press('Enter');
    await dialog.waitFor();
    await dialog.getByRole('button', { name: 'Close' }).click();
    await dialog.waitFor({ state: 'detached' });
    assert.ok(await hasFocus(showCode(page)));
  },
);

browserTest(
  'code dialog: where the browser does not copy, the code is selected and it is said',
  { path },
  async ({ page }) => {
    await ready(page);
    await page.evaluate(() => {
      navigator.clipboard.writeText = () => Promise.reject(new DOMException('refused', 'NotAllowedError'));
    });
    const dialog = await openCode(page);
    await dialog.getByRole('button', { name: 'Copy' }).click();
    await dialog.getByText('The browser does not let pages copy').waitFor();
    const selected = await page.evaluate(() => getSelection().toString());
    assert.equal(selected.trim(), (await dialog.locator('[data-code="javascript"] pre').textContent()).trim());
  },
);

browserTest('code dialog: its scripts are asked for when it is opened, not before', { path }, async ({ page }) => {
  await ready(page);
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  const before = await page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => name));
  assert.deepEqual(
    before.filter((name) => /\/(dialog|code)-[\w-]+\.js$/.test(name)),
    [],
  );
  await openCode(page);
  assert.ok(
    asked.some((name) => /\/dialog-[\w-]+\.js$/.test(name)) && asked.some((name) => /\/code-[\w-]+\.js$/.test(name)),
    `${asked}`,
  );
});

browserTest(
  'code dialog: a line that is down is told at the button, and it opens once the line is back',
  { path },
  async ({ page, problems }) => {
    await ready(page);
    await page.route('**/assets/*.js', (route) => route.abort());
    await showCode(page).click();
    await page.getByRole('button', { name: 'Not loaded' }).waitFor();
    problems.length = 0;
    await page.unroute('**/assets/*.js');
    await openCode(page);
  },
);

for (const viewport of ['desktop', 'phone']) {
  for (const scheme of ['light', 'dark']) {
    browserTest(
      `code dialog: axe finds nothing (${viewport}, ${scheme})`,
      { path, viewport, scheme },
      async ({ page, screenshot }) => {
        await ready(page);
        if (viewport === 'phone') await page.getByRole('button', { name: 'Show array, targets and settings' }).click();
        const dialog = await openCode(page);
        for (const name of ['JavaScript', 'Command line']) {
          await dialog.getByRole('tab', { name }).click();
          assert.deepEqual(await findings(page), []);
          await screenshot(`code-${name.replace(' ', '-')}`);
        }
        const { width, scroll, inner } = await dialog.evaluate((one) => ({
          width: one.getBoundingClientRect().width,
          scroll: one.scrollWidth - one.clientWidth,
          inner: innerWidth,
        }));
        assert.ok(width <= inner && scroll <= 0, `${width} of ${inner} pixels, ${scroll} beyond`);
        // Escape closes the dialog alone.
        await page.keyboard.press('Escape');
        await dialog.waitFor({ state: 'detached' });
        assert.ok(await hasFocus(showCode(page)));
      },
    );
  }
}
