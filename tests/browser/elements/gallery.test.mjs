// The page Elements: each element shows its data, its form changes it, and its code shows the same elsewhere.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { root } from '../../../scripts/lib/paths.mjs';
import { consumer } from '../../packaging/consumer.mjs';
import { parametersWith } from '../lib/demo.mjs';
import { retriedTest, skipWithoutBrowser } from '../lib/harness.mjs';
import { launch, openPage, serve } from '../lib/session.mjs';
import { leave, typeNumber } from '../lib/type.mjs';

const NAMES = [
  'spectrum',
  'range-doppler',
  'point-cloud',
  'birds-eye',
  'doppler-azimuth',
  'mounting-angle',
  'capture',
  'drive',
  'board',
];
const RECORDINGS = {
  'xwr16xx_crw_dca_module_2018_1015v2.bin': 'awr1642',
  'profile.cfg': 'awr1642',
  'xwr16xx_crw_demo_visualizer_2018_1015v2.dat': 'awr1642',
  'front_radar.csv.gz': 'delphi',
  'pose_10hz.csv.gz': 'delphi',
};
/** The package as a page without a bundler finds it. */
const IMPORTS = {
  boresight: '/lib/browser.js',
  'boresight/worker': '/worker/browser.js',
  'boresight/elements': '/elements/index.js',
};

let browser;
let demo;
before(async () => {
  if (skipWithoutBrowser) return;
  [browser, demo] = await Promise.all([launch(), serve()]);
});
after(async () => {
  await browser?.close();
  await demo?.close();
});

/** What an element says that it shows, once it shows something that stays. */
const words = async (page, name) => {
  const told = page
    .locator(`boresight-${name} .alternative`)
    .filter({ hasText: /./, hasNotText: /No data yet\.|^Live,/ });
  await told.waitFor({ state: 'attached', timeout: 40_000 });
  return told.textContent();
};

const opened = async (name, query = '') => {
  const { page, problems, close } = await openPage(browser, demo.url, {
    path: `#/elements?element=boresight-${name}${query}`,
  });
  await page.locator('#plots[aria-busy="false"]').waitFor();
  return { page, problems, close };
};

const codeOf = async (page, kind) => {
  await page.getByRole('button', { name: kind, exact: true }).click();
  return page.locator(`[data-code="${kind.toLowerCase()}"]`).textContent();
};

/** Waits until a kind of code has a text. */
const codeHas = async (page, kind, pattern) => {
  await page.getByRole('button', { name: kind, exact: true }).click();
  await page.locator(`[data-code="${kind.toLowerCase()}"]`).filter({ hasText: pattern }).waitFor();
};

/** Puts bundled recordings beside a page. */
const beside = (page) =>
  page.route(/\.(bin|cfg|dat|gz)$/, async (route) => {
    const name = new URL(route.request().url()).pathname.split('/').at(-1);
    await route.fulfill({ body: readFileSync(join(root, 'recordings', RECORDINGS[name], name)) });
  });

for (const name of NAMES) {
  retriedTest(`${name}: the code for a page shows what the gallery shows`, {}, async () => {
    const gallery = await opened(name);
    const shown = await words(gallery.page, name);
    const code = await codeOf(gallery.page, 'HTML');
    assert.deepEqual(gallery.problems, []);
    await gallery.close();
    const map = `<script type="importmap">${JSON.stringify({ imports: IMPORTS })}</script>`;
    // The built package is the site.
    const site = await serve(root);
    const copy = await openPage(browser, site.url, { path: 'about:blank' });
    try {
      await beside(copy.page);
      const body = `<!doctype html><title>copied</title><link rel="icon" href="data:,">${map}${code}`;
      await copy.page.route('**/copied.html', (route) => route.fulfill({ contentType: 'text/html', body }));
      await copy.page.goto(`${site.url}copied.html`);
      assert.equal(await words(copy.page, name), shown);
      assert.deepEqual(copy.problems, []);
    } finally {
      await copy.close();
      await site.close();
    }
  });
}

retriedTest(
  'the code for React shows the same, all elements on a page',
  {
    timeout: 300_000,
  },
  async () => {
    const shown = {};
    const files = {};
    for (const name of NAMES) {
      const { page, close } = await opened(name);
      shown[name] = await words(page, name);
      files[`src/${name}.jsx`] = await codeOf(page, 'React');
      await close();
    }
    const component = (name) => name.replace(/(?:^|-)(\w)/g, (_, letter) => letter.toUpperCase());
    files['src/main.jsx'] = [
      "import { createRoot } from 'react-dom/client';",
      ...NAMES.map((name) => `import { ${component(name)} } from './${name}.jsx';`),
      `createRoot(document.getElementById('root')).render(<>${NAMES.map((name) => `<${component(name)} />`).join('')}</>);`,
    ].join('\n');
    files['index.html'] =
      '<!doctype html><link rel="icon" href="data:,"><div id="root"></div><script type="module" src="/src/main.jsx"></script>';
    const { dependencies, devDependencies } = JSON.parse(
      readFileSync(join(root, 'docs', 'examples', 'react', 'package.json'), 'utf8'),
    );
    const { react, 'react-dom': dom } = dependencies;
    const plugin = '@vitejs/plugin-react';
    const project = await consumer({
      files: {
        ...files,
        'vite.config.js': `import react from '${plugin}'; export default { plugins: [react()], build: { target: 'es2022' } };`,
      },
      tools: ['vite'],
      packages: { react, 'react-dom': dom, [plugin]: devDependencies[plugin] },
    });
    try {
      await project.run(project.bin('vite'), ['build', '--logLevel', 'error']);
      const built = await serve(project.folder, { build: { outDir: join(project.folder, 'dist') } });
      const page = await browser.newPage();
      try {
        await beside(page);
        await page.goto(built.url);
        for (const name of NAMES) assert.equal(await words(page, name), shown[name], name);
      } finally {
        await page.close();
        await built.close();
      }
    } finally {
      project.remove();
    }
  },
);

retriedTest('a form of the schema changes picture, code and link, key by key', {}, async () => {
  const { page, problems, close } = await opened('spectrum');
  const before = await words(page, 'spectrum');
  await page.getByRole('combobox', { name: 'Method', exact: true }).selectOption('music');
  const told = page.locator('boresight-spectrum .alternative');
  await told.filter({ hasText: /^music/ }).waitFor({ state: 'attached' });
  const points = page.getByRole('spinbutton', { name: 'Grid points', exact: true });
  await typeNumber(points, '64');
  await leave(points);
  await page.waitForFunction(
    () => document.querySelector('boresight-spectrum').estimates[0].spectrum.azimuthDeg.length < 100,
  );
  await codeHas(page, 'HTML', /sources: 2, method: 'music', gridPoints: 64/);
  await parametersWith(page, (given) => given.get('set') === 'method:music,gridPoints:64');
  // A number that none may be is refused with its range, and counts for nothing.
  await typeNumber(points, '5');
  await page.getByText('16 to 65536').waitFor();
  await codeHas(page, 'React', /gridPoints: 64/);
  // An attribute, of the element itself.
  const floor = page.getByRole('spinbutton', { name: 'Floor', exact: true });
  await typeNumber(floor, '30');
  await leave(floor);
  await codeHas(page, 'HTML', '<boresight-spectrum heading="Two targets" floor-db="30">');
  assert.match(await codeOf(page, 'Notebook'), /^settings = \{"heading": "Two targets", "floor_db": 30\}$/m);
  assert.equal(await page.locator('boresight-spectrum').getAttribute('floor-db'), '30');
  await page.getByRole('button', { name: 'Defaults' }).click();
  await told.filter({ hasText: before }).waitFor({ state: 'attached' });
  assert.deepEqual(problems, []);
  await close();
});

retriedTest('a link brings an element with its options, and what it says wrongly is named', {}, async () => {
  const { page, close } = await opened('birds-eye', '&set=@colors:magma,egoSpeedMps:5');
  await words(page, 'birds-eye');
  assert.equal(await page.locator('boresight-birds-eye').getAttribute('colors'), 'magma');
  await codeHas(page, 'HTML', /seed: 1, egoSpeedMps: 5/);
  const seed = page.getByRole('spinbutton', { name: 'Seed', exact: true });
  assert.equal(await seed.inputValue(), '1', 'the form has what is so');
  await close();
  const wrong = await openPage(browser, demo.url, { path: '#/elements?element=boresight-birds-eye&set=nothing:1' });
  await wrong.page.getByText('“set=nothing:1”').waitFor();
  await wrong.close();
});

retriedTest('an option that the data do not allow is told', {}, async () => {
  const { page, close } = await opened('spectrum', '&set=smoothing:1024');
  await page.locator('[data-error]').waitFor();
  await page.getByRole('button', { name: 'Defaults' }).click();
  await page.locator('[data-error]').waitFor({ state: 'detached' });
  await words(page, 'spectrum');
  await close();
});

retriedTest('code is copied by the keyboard', {}, async () => {
  const { page, close } = await opened('mounting-angle');
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const code = await codeOf(page, 'Notebook');
  await page.getByRole('button', { name: 'Copy', exact: true }).press('Enter');
  await page.getByRole('button', { name: 'Copied' }).waitFor();
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), code);
  await close();
});
