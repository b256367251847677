/** axe-core's rules (WCAG 2.2 A and AA, and its best practices) on a page as it stands. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

/** What axe finds, with the elements it means. */
export async function findings(page) {
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
