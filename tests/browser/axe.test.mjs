// axe-core's rules (WCAG 2.2 A and AA, and its best practices) on every page as it stands once it has shown its data.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { browserTest } from './harness.mjs';
import { pages } from './pages.mjs';
import { schemes, viewports } from './session.mjs';
import { patient } from './trial.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** What axe finds, with the elements it means. */
async function findings(page) {
  // The page's content security policy lets no foreign script in, but does not bind the debugger.
  await page.evaluate(axe);
  const { violations, passes } = await page.evaluate(() =>
    globalThis.axe.run(document, { resultTypes: ['violations'], rules: { 'target-size': { enabled: true } } }),
  );
  assert.ok(passes.length > 20, `axe checked by ${passes.length} rules`);
  return violations.flatMap(({ id, help, nodes }) =>
    nodes.map(({ target, any, all, none }) => {
      const why = [...any, ...all, ...none].map(({ message }) => message).join('; ');
      return `${id} (${help}): ${target.join(' ')}: ${why}`;
    }),
  );
}

for (const { name, path, ready } of pages)
  for (const viewport of Object.keys(viewports))
    for (const scheme of schemes)
      browserTest(`axe: ${name}, ${viewport}, ${scheme}: no finding`, { path, viewport, scheme }, async ({ page }) => {
        await page.waitForSelector(ready, patient);
        for (const summary of await page.locator('details:not([open]) > summary').all())
          if (await summary.isVisible()) await summary.click();
        assert.deepEqual(await findings(page), []);
      });
