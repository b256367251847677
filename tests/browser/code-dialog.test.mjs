/** The dialog of “Copy as code”: by keys alone, with the clipboard and without, on desktop and phone. */
import assert from 'node:assert/strict';
import { openCode } from './lib/code-dialog.mjs';
import { runScript } from './lib/code-run.mjs';
import { browserTest } from './lib/harness.mjs';
import { findings } from './site/axe.mjs';

const path = '#/angle';
const ready = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const focused = (page) =>
  page.evaluate(() => {
    const { activeElement: at } = document;
    return at?.dataset.action || at?.id || at?.tagName;
  });

/** Presses Tab until something has the focus. */
async function tabTo(page, wanted) {
  for (let tries = 0; tries < 80; tries++) {
    if ((await focused(page)) === wanted) return;
    await page.keyboard.press('Tab');
  }
  assert.fail(`${wanted} has the focus, not ${await focused(page)}`);
}

browserTest(
  'code dialog: opened, read, copied from and closed by keys alone',
  { path, permissions: ['clipboard-read', 'clipboard-write'] },
  async ({ page }) => {
    await ready(page);
    await tabTo(page, 'show-code');
    await page.keyboard.press('Enter');
    const dialog = page.getByRole('dialog', { name: 'What this page shows, as code' });
    await dialog.waitFor();
    await tabTo(page, 'code-tab-javascript');
    for (const [key, name] of [
      ['ArrowRight', 'commandLine'],
      ['ArrowRight', 'javascript'],
      ['ArrowLeft', 'commandLine'],
      ['ArrowLeft', 'javascript'],
    ]) {
      await page.keyboard.press(key);
      assert.equal(await focused(page), `code-tab-${name}`);
      assert.deepEqual(
        await dialog.locator('[role="tab"][aria-selected="true"]').evaluateAll((tabs) => tabs.map(({ id }) => id)),
        [`code-tab-${name}`],
      );
      await dialog.locator(`[data-code="${name}"] pre`).waitFor();
    }
    await page.keyboard.press('Tab');
    assert.equal(await focused(page), 'PRE', 'the code itself can be reached, to scroll it');
    await tabTo(page, 'copy-code');
    await page.keyboard.press('Enter');
    await dialog.locator('[data-code="javascript"]').getByRole('status').getByText('Copied').waitFor();
    const text = await page.evaluate(() => navigator.clipboard.readText());
    assert.equal(text, await dialog.locator('[data-code="javascript"] pre').textContent());
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
        await focused(page),
      );
    }
    await page.keyboard.press('Escape');
    await dialog.waitFor({ state: 'detached' });
    assert.equal(await focused(page), 'show-code');
    await page.keyboard.press('Enter');
    await dialog.waitFor();
    await dialog.getByRole('button', { name: 'Close' }).click();
    await dialog.waitFor({ state: 'detached' });
    assert.equal(await focused(page), 'show-code');
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
    await dialog.locator('[data-code="javascript"] [data-action="copy-code"]').click();
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
    await page.locator('[data-action="show-code"]').click();
    await page.locator('[data-action="show-code"]', { hasText: 'Not loaded' }).waitFor();
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
        if (viewport === 'phone') await page.locator('.sidebar-toggle').click();
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
        assert.equal(await focused(page), 'show-code');
      },
    );
  }
}
