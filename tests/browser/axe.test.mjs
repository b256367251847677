// Every page as it stands once it has shown its data.
import assert from 'node:assert/strict';
import { findings } from './axe.mjs';
import { browserTest } from './harness.mjs';
import { pages } from './pages.mjs';
import { schemes, viewports } from './session.mjs';
import { patient } from './trial.mjs';

for (const { name, path, ready } of pages)
  for (const viewport of Object.keys(viewports))
    for (const scheme of schemes)
      browserTest(`axe: ${name}, ${viewport}, ${scheme}: no finding`, { path, viewport, scheme }, async ({ page }) => {
        await page.waitForSelector(ready, patient);
        for (const summary of await page.locator('details:not([open]) > summary').all())
          if (await summary.isVisible()) await summary.click();
        assert.deepEqual(await findings(page), []);
      });
