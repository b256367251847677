// The demo as `npm start` serves it while the module of networks is being built.
import assert from 'node:assert/strict';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { publish } from '../../../scripts/lib/build/publish.mjs';
import { root } from '../../../scripts/lib/paths.mjs';
import { values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { serve } from '../lib/session.mjs';

const folder = mkdtempSync(join(tmpdir(), 'boresight-later-'));
const patient = { timeout: 60_000 };
const angles = '#/angle?array=lrr48&targets=-20:0,5:-3,31:-6&snr=25&snapshots=1&seed=2&methods=iaa,learned-pursuit';
const estimated = (method) => `[data-row="${method}"] [data-field="error"][data-value]`;
const site = join(folder, 'site');

/** Options of a build of the demo into a folder. */
const into = (outDir) => ({ configFile: join(root, 'vite.config.ts'), logLevel: 'warn', build: { outDir } });

async function built(outDir) {
  const { build } = await import('vite');
  await build(into(outDir));
  return outDir;
}

let server;
/** The demo, built and served before the module. */
function served() {
  server ??= (async () => {
    process.env.BORESIGHT_WITHOUT_NETWORKS = '1';
    await built(site);
    return serve(join(root, 'web', 'app'), into(site));
  })();
  return server;
}
after(async () => {
  await (await server)?.close();
  rmSync(folder, { recursive: true });
});

browserTest(
  'networks later: a page that is open before the module says so, and reloads and estimates when it is built',
  { served, path: angles, timeout: 180_000 },
  async ({ page }) => {
    await page.waitForSelector('[data-loading] [data-module="building"]');
    await page.waitForSelector(estimated('iaa'), patient);
    assert.doesNotMatch(await page.locator('[data-row="learned-pursuit"]').innerText(), /missed/);
    await page.locator('nav a[href^="#/networks"]').click();
    await page.waitForSelector('.notice [data-module="building"]');
    await page.locator('nav a[href^="#/angle"]').click();
    await page.waitForSelector('[data-loading] [data-module="building"]');
    delete process.env.BORESIGHT_WITHOUT_NETWORKS;
    publish(await built(join(folder, 'next')), site);
    await page.waitForSelector(estimated('learned-pursuit'), patient);
    for (const error of await values(page, '[data-row="learned-pursuit"] [data-field="error"]'))
      assert.ok(Math.abs(error) < 0.3, `${error} deg`);
    assert.equal(await page.locator('[data-module]').count(), 0);
  },
);

test('networks later: a published page does not wait for a build', () => {
  const assets = join(root, 'web', 'app', 'dist', 'assets');
  const scripts = readdirSync(assets).filter((name) => name.endsWith('.js'));
  assert.ok(scripts.length > 1);
  for (const name of scripts) assert.doesNotMatch(readFileSync(join(assets, name), 'utf8'), /data-module/, name);
});
