// Every page as it stands once it has shown its data.
import assert from 'node:assert/strict';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';
import { schemes, viewports } from '../lib/session.mjs';
import { patient } from '../lib/trial.mjs';
import { findings } from './axe.mjs';

for (const { name, path, ready } of pages)
  for (const viewport of Object.keys(viewports))
    browserTest(`axe: ${name}, ${viewport}: no finding in light and dark`, { path, viewport }, async ({ page }) => {
      await page.waitForSelector(ready, patient);
      for (const summary of await page.locator('details:not([open]) > summary').all())
        if (await summary.isVisible()) await summary.click();
      for (const scheme of schemes) {
        await page.emulateMedia({ colorScheme: scheme });
        await page.waitForFunction(
          (wanted) => getComputedStyle(document.documentElement).colorScheme.includes(wanted),
          scheme,
        );
        assert.deepEqual(await findings(page), [], scheme);
      }
    });
