import assert from 'node:assert/strict';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';
import { schemes, viewports } from '../lib/session.mjs';

for (const { name, path, ready } of pages) {
  for (const viewport of Object.keys(viewports)) {
    for (const scheme of schemes) {
      browserTest(`${name} fits a ${viewport} in ${scheme}`, { path, viewport, scheme }, async ({ page }) => {
        await page.waitForSelector(ready);
        const { content, window: width } = await page.evaluate(() => ({
          content: document.documentElement.scrollWidth,
          window: document.documentElement.clientWidth,
        }));
        assert.ok(content <= width, `content is ${content} px wide in a window of ${width} px`);
        assert.equal(await page.locator('main').count(), 1, 'one main landmark');
        assert.ok((await page.title()).length > 0, 'the page has a title');
      });
    }
  }
}
