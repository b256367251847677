// Lighthouse over the built, compressed demo: a table of performance, which is the machine's too and only printed, and of
// accessibility, which has to be 100. `-- angle,capture` takes some pages, `-- --accessibility` leaves performance out.
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { buildDemo, buildPackage } from './build.mjs';
import { browserArguments, browserMissing, findBrowser } from './lib/browser.mjs';
import { npmTools } from './lib/build/npm-tools.mjs';
import { main } from './lib/run.mjs';
import { setup } from './setup.mjs';

async function lighthouseModules() {
  // It brings 200 packages of 185 MB, in about a minute.
  const resolve = await npmTools('lighthouse', { lighthouse: '12.8.2' });
  const load = (name) => import(pathToFileURL(resolve(name)).href);
  const [{ default: lighthouse, desktopConfig }, { launch }] = await Promise.all(
    ['lighthouse', 'chrome-launcher'].map(load),
  );
  return { lighthouse, desktopConfig, launch };
}

await main(async () => {
  const chromePath = findBrowser();
  if (!chromePath) throw new Error(browserMissing);
  await setup();
  await buildPackage();
  await buildDemo();
  const { lighthouse, desktopConfig, launch } = await lighthouseModules();
  const { serve } = await import('../tests/browser/lib/session.mjs');
  const { pages } = await import('../tests/browser/lib/pages.mjs');
  const { values, positionals } = parseArgs({
    options: { accessibility: { type: 'boolean' } },
    allowPositionals: true,
  });
  const wanted = positionals[0]?.split(',');
  const onlyCategories = [...(values.accessibility ? [] : ['performance']), 'accessibility'];
  const server = await serve();
  const rows = [];
  const problems = [];
  try {
    for (const { name, path } of pages.filter((page) => !wanted || wanted.includes(page.path.slice(2)))) {
      for (const [form, config] of [
        ['desktop', desktopConfig],
        ['mobile', undefined],
      ]) {
        const chrome = await launch({ chromePath, chromeFlags: ['--headless=new', ...browserArguments] });
        try {
          const flags = { port: chrome.port, logLevel: 'error', onlyCategories };
          const { lhr } = await lighthouse(`${server.url}${path}`, flags, config);
          const score = (category) => Math.round(100 * (lhr.categories[category].score ?? Number.NaN));
          const seconds = (audit) => ((lhr.audits[audit].numericValue ?? Number.NaN) / 1000).toFixed(1);
          rows.push({
            page: name,
            form,
            accessibility: score('accessibility'),
            ...(!values.accessibility && {
              performance: score('performance'),
              'first paint, s': seconds('first-contentful-paint'),
              'largest paint, s': seconds('largest-contentful-paint'),
              'blocked, s': seconds('total-blocking-time'),
            }),
          });
          if (score('accessibility') !== 100) {
            const found = lhr.categories.accessibility.auditRefs
              .map(({ id }) => lhr.audits[id])
              .filter((audit) => audit.score !== null && audit.score < 1);
            problems.push(
              `${name}, ${form}: ${found.map(({ id, title }) => `${id} (${title})`).join('; ') || 'no score'}`,
            );
          }
        } finally {
          chrome.kill();
        }
      }
    }
  } finally {
    await server.close();
  }
  console.table(rows);
  if (problems.length > 0) throw new Error(`accessibility is not 100:\n${problems.join('\n')}`);
});
