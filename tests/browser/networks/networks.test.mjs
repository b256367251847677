import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';
import { control } from '../lib/controls.mjs';
import { assertCsv, assertPng, drop, parametersWith, reload, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { card, cell, file, models, patient, tried } from '../lib/trial.mjs';

const path = '#/networks?model=learned-pursuit';
const network = (page) => control(page, 'combobox', 'Network');
const attempt = (page) => page.getByRole('region', { name: /^Try it: / });
const run = (page) => control(attempt(page), 'button', 'Run on this scene').click();
const plot = (page, name) => page.locator(`[data-plot="${name}"]`);
const save = (scope, kind) => control(scope, 'button', kind);
/** What chooses a network in the list of all. */
const chooser = (page, name) => page.locator(`[data-network="${name}"]`).getByRole('button');
const experiment = (name) => join(root, 'research', 'results', `${name}.json`);

browserTest(
  'networks: no page fetches a network or their module before one is used',
  { path: '#/angle' },
  async ({ page }) => {
    const fetched = [];
    page.on('request', (request) => fetched.push(request.url()));
    fetched.push(...(await page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => name))));
    await page.waitForSelector('.plot canvas');
    // Of each page something that comes later than all that it fetches by itself.
    for (const [name, last] of [
      ['Capture', '[data-row="iaa"] [data-field="azimuth"][data-value]'],
      ['Networks', '[data-task="two"] .share > span'],
      ['Bird’s-eye view', '[data-row="bartlett"] [data-field="outsideDb"][data-value]'],
    ]) {
      await page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name }).click();
      await page.waitForSelector(last, patient);
    }
    assert.deepEqual(
      fetched.filter((address) => /neural|\.onnx/.test(address)),
      [],
    );
  },
);

browserTest(
  'networks: each has a card whose digest is that of the file it links to',
  { path: '#/networks' },
  async ({ page }) => {
    for (const name of models) {
      await network(page).selectOption(name);
      await page.waitForSelector(`[data-card="${name}"]`);
      const link = page.locator(`[data-card="${name}"]`).getByRole('link', { name: 'ONNX' });
      assert.equal(await link.getAttribute('download'), `${name}.onnx`);
      const address = await link.getAttribute('href');
      const digest = await page.evaluate(async (from) => {
        const hash = await crypto.subtle.digest('SHA-256', await (await fetch(from)).arrayBuffer());
        return [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join('');
      }, address);
      assert.equal(await page.locator('.digest code').innerText(), digest);
      assert.equal(digest, card(name).sha256);
      assert.equal(await page.locator('[data-table="metrics"] tbody tr').count(), card(name).metrics.length);
    }
    assertPng(await saved(page, save(plot(page, 'metrics'), 'PNG')));
    assertCsv(await saved(page, save(plot(page, 'metrics'), 'CSV')), await header(page));
    await parametersWith(page, (params) => params.get('model') === models.at(-1));
  },
);

/** The header that the table's columns give. */
const header = (page) =>
  page
    .locator('[data-table="metrics"] tbody tr')
    .first()
    .locator('td')
    .evaluateAll((cells) => cells.map(({ dataset }) => dataset.field).join(','));

browserTest(
  'networks: the learned pursuit runs on a scene beside IAA and the truth, and the link shows it again',
  { path: `${path}&targets=4&snr=25&seed=3` },
  async ({ page }) => {
    await run(page);
    await tried(page);
    const before = {};
    for (const method of ['learned-pursuit', 'iaa', 'nomp']) {
      const [found] = await cell(page, method, 'found');
      assert.ok(found >= 3, `${method} found ${found} of 4`);
      before[method] = await cell(page, method, 'rmse');
      assert.ok(before[method][0] < 0.3, `${method}: ${before[method]} deg`);
    }
    await parametersWith(page, (params) => params.get('run') === '1');
    await reload(page);
    await tried(page);
    for (const method of ['learned-pursuit', 'iaa', 'nomp'])
      assert.deepEqual(await cell(page, method, 'rmse'), before[method]);
    await control(page, 'checkbox', 'Refine by Gauss-Newton').check();
    await page.waitForSelector('[data-attempt$="refined"]', patient);
    const [refined] = await cell(page, 'learned-pursuit', 'rmse');
    assert.ok(refined <= before['learned-pursuit'][0], `refined ${refined}, ${before['learned-pursuit']} before`);
    await control(page.getByRole('form', { name: 'Networks settings' }), 'button', 'Stop').press('Enter');
    await parametersWith(page, (params) => !params.has('run'));
    assertPng(await saved(page, save(plot(page, 'attempt'), 'PNG')));
    assertCsv(
      await saved(page, save(control(page, 'region', 'What each found'), 'CSV')),
      'method,found,missed,false,rmse_deg,power_error_db,median_ms',
    );
  },
);

browserTest(
  'networks: the transformer for any array runs on the arrays chosen, and shows how far off it may be',
  { path: '#/networks?model=aaetr-any&targets=3&snr=25&seed=3&run=1' },
  async ({ page }) => {
    await page.waitForSelector('[data-attempt^="lrr48"]', patient);
    await page.getByText('bars ±σ it states').first().waitFor(patient);
    for (const array of ['cascade86', 'ula32']) {
      await control(page, 'combobox', 'Array').selectOption(array);
      await page.waitForSelector(`[data-attempt^="${array}"]`, patient);
      const [found] = await cell(page, 'aaetr', 'found');
      assert.ok(found >= 2, `${array}: found ${found} of 3`);
    }
    await parametersWith(page, (params) => params.get('array') === 'ula32');
    // Other networks are for one array, and ask for none.
    await network(page).selectOption('learned-pursuit');
    await page.waitForSelector('[data-attempt^="lrr48"]', patient);
    assert.equal(await control(page, 'combobox', 'Array').count(), 0);
  },
);

browserTest(
  'networks: the networks of regions run on a simulated region',
  { path: '#/networks?model=counting&targets=2&snr=15&run=1' },
  async ({ page }) => {
    await tried(page);
    assert.deepEqual(await cell(page, 'network', 'sources'), [2]);
    for (const name of models.filter((model) => /^(dnn|cnn3d)/.test(model))) {
      const { network: method, targets } = card(name);
      await network(page).selectOption(name);
      await page.waitForSelector(
        `[data-attempt] [data-table="attempt"] [data-row="${method}"] [data-field="found"]`,
        patient,
      );
      const [found] = await cell(page, method, 'found');
      const [missed] = await cell(page, method, 'missed');
      assert.equal(found + missed, targets, name);
    }
  },
);

browserTest(
  'networks: a download shows its bytes, is cancelled, and goes on when asked',
  { path },
  async ({ page }) => {
    // The file comes in halves, the second never unless it is asked for again.
    await page.evaluate(() => {
      const { fetch } = window;
      let first = true;
      window.fetch = async (address, options) => {
        const response = await fetch(address, options);
        if (!String(address).endsWith('.onnx') || !first) return response;
        first = false;
        const bytes = new Uint8Array(await response.arrayBuffer());
        const body = new ReadableStream({
          start(controller) {
            controller.enqueue(bytes.subarray(0, bytes.length / 2));
            options.signal.addEventListener('abort', () => controller.error(options.signal.reason));
          },
        });
        return new Response(body);
      };
    });
    await run(page);
    await page.waitForFunction(
      (half) => document.querySelector('[data-loading="learned-pursuit"] progress')?.value === half,
      Math.floor(file('learned-pursuit.onnx').length / 2),
    );
    await control(attempt(page), 'button', 'Cancel').click();
    await page.waitForSelector('[data-stopped="learned-pursuit"]');
    await control(attempt(page), 'button', 'Load').click();
    await tried(page);
    await attempt(page).getByText('ready', { exact: true }).waitFor();
  },
);

browserTest(
  'networks: times at batches of 1 and 32 beside IAA and NOMP; timing is cancelled',
  { path },
  async ({ page }) => {
    const timing = control(page, 'region', 'Time it here');
    const start = control(timing, 'button', 'Time it here');
    await start.click();
    await control(timing, 'button', 'Cancel').click({ timeout: 30_000 });
    await page.waitForSelector('[data-table="timing"][aria-busy="false"]');
    await start.click();
    for (const row of ['network', 'iaa', 'nomp']) {
      for (const batch of [1, 32]) {
        const field = `[data-table="timing"] [data-row="${row}"] [data-field="batch${batch}"]`;
        await page.waitForSelector(`${field}[data-value]`, patient);
        const [median] = await values(page, field);
        assert.ok(median > 0 && median < 60_000, `${row}, ${batch}: ${median} ms`);
      }
    }
    await page.waitForSelector('[data-table="timing"][aria-busy="false"]');
    assertCsv(
      await saved(page, save(timing, 'CSV')),
      'subject,batch,median_ms,lower_quartile_ms,upper_quartile_ms,calls,samples_per_s',
    );
  },
);

browserTest(
  'networks: a bad file is refused with its error, and what was there goes on',
  { path },
  async ({ page }) => {
    await page.waitForSelector('[data-card]');
    const onnx = file('learned-pursuit.onnx');
    const alert = async (files, code) => {
      await drop(page, files);
      await page.getByRole('alert').filter({ hasText: code }).filter({ hasText: files[0].name }).waitFor(patient);
    };
    await alert([{ name: 'noise.onnx', bytes: Buffer.from('this is no network at all') }], 'not-onnx');
    await alert([{ name: 'cut.onnx', bytes: onnx.subarray(0, onnx.length / 2) }], 'truncated-file');
    await alert([{ name: 'card.json', bytes: file('learned-pursuit.json') }], 'missing');
    const other = JSON.stringify({ ...card('learned-pursuit'), sha256: '0'.repeat(64) });
    await alert(
      [
        { name: 'other.onnx', bytes: onnx },
        { name: 'other.json', bytes: Buffer.from(other) },
      ],
      'digest',
    );
    assert.equal(await page.locator('[data-card]').getAttribute('data-card'), 'learned-pursuit');
    await drop(page, [
      { name: 'mine.onnx', bytes: onnx },
      { name: 'mine.json', bytes: file('learned-pursuit.json') },
    ]);
    await page.waitForSelector('[data-card="own:mine.onnx"]', patient);
    assert.equal(await page.getByRole('alert').count(), 0, 'the error is gone');
  },
);

browserTest(
  'networks: a file of one’s own runs without a card',
  { path: `${path}&targets=4&snr=25&seed=3` },
  async ({ page }) => {
    await page.waitForSelector('[data-card]');
    await drop(page, [{ name: 'mine.onnx', bytes: file('learned-pursuit.onnx') }]);
    await page.waitForSelector('[data-card="own:mine.onnx"]', patient);
    await run(page);
    await tried(page);
    // What it is only its card says.
    assert.ok((await cell(page, 'aaetr', 'found'))[0] >= 3);
  },
);

browserTest('networks: the page is used from the keyboard', { path: '#/networks' }, async ({ page }) => {
  await page.waitForSelector('[data-card]');
  await chooser(page, models.at(-1)).press('Enter');
  await page.waitForSelector(`[data-card="${models.at(-1)}"]`);
  await plot(page, 'metrics').getByRole('application').press('ArrowRight');
  await plot(page, 'metrics')
    .locator('.readout')
    .filter({ hasText: /SNR −?\d+ dB/ })
    .waitFor();
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('button, input:not([hidden]), select, [role="application"]')]
      .filter((node) => !(node.getAttribute('aria-label') ?? node.labels?.[0]?.textContent ?? node.textContent).trim())
      .map((node) => node.outerHTML),
  );
  assert.deepEqual(nameless, []);
  await parametersWith(page, (params) => params.get('model') === models.at(-1));
});

browserTest(
  'networks: keys reach a plot that waits for its turn to be drawn',
  { path: '#/networks' },
  async ({ page }) => {
    await page.waitForSelector('[data-card]');
    await page.evaluate(() => {
      within('[data-plot="metrics"]', '.u-over').dataset.old = '';
      const { setTimeout } = window;
      window.setTimeout = (work, delay = 1500, ...rest) => setTimeout(work, delay, ...rest);
    });
    await chooser(page, models.at(-1)).click();
    // As soon as it is there, and where it is out of sight, so that nothing has drawn it.
    const host = '[data-plot="metrics"] .plot:has(.u-over:not([data-old]))';
    await page.waitForSelector(host, { state: 'attached' });
    await page.locator(host).evaluate((plot) => plot.focus({ preventScroll: true }));
    await page.keyboard.press('ArrowRight');
    await page.evaluate(() => new Promise(requestAnimationFrame));
    assert.match(await page.locator('[data-plot="metrics"] .readout').textContent(), /SNR −?\d+ dB/);
  },
);

for (const name of ['aoa', 'doa'].filter((one) => existsSync(experiment(one)))) {
  browserTest(
    `networks: the figures of ${name} are drawn, and a network that loses is said to`,
    { path: '#/networks' },
    async ({ page }) => {
      await page.waitForSelector(`[data-experiment="${name}"] .plot canvas`);
      const report = JSON.parse(readFileSync(experiment(name)));
      const isNetwork = (method) => /^(aaetr|learned-pursuit|unrolled-iaa|dnn|cnn3d|counting)/.test(method);
      if (!report.methods.some(isNetwork)) {
        await page.waitForSelector(`[data-experiment="${name}"] [data-verdict="none"]`);
        return;
      }
      const part = page.locator(`[data-experiment="${name}"]`);
      await part.getByText('Each network against the classical methods').click();
      if (name === 'aoa') {
        // Counted here anew for the F1 at 15 dB: who is more than four standard deviations below any classical method
        // must be named.
        const conditions = report.conditions.filter(({ snrDb }) => snrDb === 15);
        report.methods.forEach((method, i) => {
          if (!isNetwork(method)) return;
          const behind = conditions.some(({ targets, methods }) =>
            methods.some(({ best }, k) => {
              const f1 = methods[i].best?.f1 ?? 0;
              return (
                !isNetwork(report.methods[k]) &&
                best &&
                best.f1 - f1 > 4 * Math.sqrt((f1 * (1 - f1) * 2) / (report.trials * targets))
              );
            }),
          );
          if (behind) conditions.losers = [...(conditions.losers ?? []), method];
        });
        for (const loser of conditions.losers ?? []) {
          assert.match(
            await page.locator(`[data-figure="f1"][data-network="${loser}"]`).innerText(),
            /Loses to/,
            loser,
          );
        }
      }
      const plots = await page
        .locator(`[data-experiment="${name}"] [data-plot]`)
        .evaluateAll((all) => all.map(({ dataset }) => dataset.plot));
      if (name === 'aoa')
        for (const score of ['f1', 'f1-at-one-threshold'])
          assert.ok(
            plots.some((plot) => plot.endsWith(score)),
            `${plots}`,
          );
      for (const name of plots) {
        assertPng(await saved(page, save(plot(page, name), 'PNG')));
      }
      await control(part, 'combobox', name === 'aoa' ? 'SNR' : 'Two targets').selectOption({ index: 1 });
      await parametersWith(page, (params) => params.has(name === 'aoa' ? 'at' : 'range'));
    },
  );
}

browserTest(
  'networks: what they are for, and where they win and lose, is said first',
  { path: '#/networks' },
  async ({ page }) => {
    await page.waitForSelector('[data-task="two"] .share > span');
    const tasks = await page
      .locator('[data-task]')
      .evaluateAll((rows) => rows.map((row) => [row.dataset.task, row.innerText]));
    assert.deepEqual(
      tasks.map(([name]) => name),
      ['snapshot', 'counting', 'one', 'two'],
    );
    const table = await page.locator('[data-table="networks"]').boundingBox();
    assert.ok((await page.locator('[data-table="standing"]').boundingBox()).y < table.y);
    // Counted here anew: the conditions in which a network has more of the two right than every classical method.
    const { methods, conditions } = JSON.parse(readFileSync(experiment('doa')));
    const two = conditions.filter(({ targets }) => targets === 'apart' || targets === 'together');
    const [, ahead] = /of 12 conditions ahead in (\d+)/.exec(tasks[3][1]);
    const isNetwork = (method) => /^(dnn|cnn3d)/.test(method);
    const best = (of, all) =>
      Math.max(...methods.map((method, i) => (all(method) ? (of.methods[i]?.success ?? 0) : 0)));
    const leads = two.filter((of) => best(of, isNetwork) > best(of, (method) => !isNetwork(method))).length;
    assert.ok(Number(ahead) > 0 && Number(ahead) <= leads, `${ahead} of ${leads}`);
    assert.match(tasks[0][1], /behind in \d+, most often of IAA, refined/);
    assert.doesNotMatch(tasks[0][1], /refined: of/);
    const red = await page.locator('[data-field="summary"] .loses, [data-verdict="counted"] .loses').count();
    assert.equal(red, 0);
  },
);
