// Pages of the built demo, visited in any order, with new seeds and cancelled work.
import { generator } from '../lib/build/generator.mjs';

const SAMPLE_MS = 4000;
/** Noise: bytes of a heap, elements of a page, listeners, workers. */
const LEAST = { 'heap bytes': 6e6, nodes: 2000, listeners: 400, workers: 2 };

/** Uses the demo for so long; what was done, samples of memory, and what went wrong. */
export async function soakPages({ milliseconds, seed }) {
  const { launch, openPage, serve } = await import('../../tests/browser/lib/session.mjs');
  const { pages } = await import('../../tests/browser/lib/pages.mjs');
  const draw = generator(seed);
  const pick = (list) => list[Math.floor(draw() * list.length)];
  const server = await serve();
  const browser = await launch();
  const { page, context, problems } = await openPage(browser, server.url, { path: pages[0].path });
  // No handle of an element, which would keep its page in memory.
  const shown = (selector) => page.locator(selector).first().waitFor({ state: 'attached' });
  await shown(pages[0].ready);
  const devtools = await context.newCDPSession(page);
  await devtools.send('Performance.enable');
  const counts = { visits: 0, seeds: 0, cancels: 0, 'back and forth': 0 };
  const series = Object.fromEntries(Object.keys(LEAST).map((name) => [name, []]));

  const visit = async () => {
    const { path, ready } = pick(pages);
    await page.locator(`nav a[href^="${path}"]`).first().click();
    await shown(ready);
    counts.visits++;
  };
  const reseed = async () => {
    const field = page.locator('input[name="seed"]').first();
    if ((await field.count()) === 0) return;
    await field.click({ clickCount: 3 });
    await page.keyboard.type(String(Math.floor(1000 * draw())));
    await page.keyboard.press('Enter');
    counts.seeds++;
  };
  const cancel = async () => {
    const button = page.locator('button[data-action^="cancel"]').first();
    if ((await button.count()) === 0) return;
    // It may be gone by the time it is clicked.
    const clicked = await button.click({ timeout: 500 }).then(
      () => true,
      () => false,
    );
    if (clicked) counts.cancels++;
  };
  const backAndForth = async () => {
    await page.goBack().catch(() => undefined);
    await page.goForward().catch(() => undefined);
    counts['back and forth']++;
  };
  const sample = async () => {
    // Elements that are left go in a second round, once what held them is gone.
    for (let round = 0; round < 2; round++) {
      await devtools.send('HeapProfiler.collectGarbage');
      await page.waitForTimeout(200);
    }
    const { metrics } = await devtools.send('Performance.getMetrics');
    const metric = (name) => metrics.find((one) => one.name === name)?.value ?? Number.NaN;
    const row = [metric('JSHeapUsedSize'), metric('Nodes'), metric('JSEventListeners'), page.workers().length];
    Object.values(series).forEach((samples, at) => samples.push(row[at]));
  };

  try {
    const until = performance.now() + milliseconds;
    for (let sampled = 0; performance.now() < until && problems.length < 10; ) {
      await visit();
      for (const act of [reseed, cancel, backAndForth]) if (draw() < 0.5) await act();
      if (performance.now() - sampled < SAMPLE_MS) continue;
      // Always of the same page, whose elements are then the same.
      await page.locator(`nav a[href^="${pages[0].path}"]`).first().click();
      await shown(pages[0].ready);
      await sample();
      sampled = performance.now();
    }
  } catch (error) {
    problems.push(String(error));
  }
  await browser.close();
  await server.close();
  return { counts, series, least: LEAST, problems };
}
