// Networks on the pages of the other methods: the angle lab, Capture, Bird’s-eye view.
import assert from 'node:assert/strict';
import { control } from '../lib/controls.mjs';
import { assertCsv, parametersWith, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';
import { typeNumber, typeText } from '../lib/type.mjs';

const method = (page, title) => control(page, 'checkbox', title);

browserTest(
  'networks in the angle lab: one that fits loads and estimates, others say which array they are for',
  { path: '#/angle?array=lrr48&targets=-20:0,5:-3,31:-6&snr=25&snapshots=1&seed=2&methods=iaa,learned-pursuit' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="learned-pursuit"] [data-field="error"][data-value]', patient);
    const errors = await values(page, '[data-row="learned-pursuit"] [data-field="error"]');
    assert.equal(errors.length, 3);
    for (const error of errors) assert.ok(Math.abs(error) < 0.3, `${error} deg`);
    assert.ok(await method(page, 'DNN (network)').isDisabled());
    assert.match(await page.locator('#method-dnn-note').innerText(), /8 elements|uniform/);
    assert.match(await page.locator('#method-cnn3d-note').innerText(), /region/);
    await control(page, 'checkbox', 'Refine by Gauss-Newton').check();
    await page.waitForSelector('[data-row="learned-pursuit"] [data-field="error"][data-value]', patient);
    await control(page, 'combobox', 'Virtual array').selectOption('ula');
    await page.waitForSelector('#method-learned-pursuit-note:not([hidden])');
    assert.match(await page.locator('#method-learned-pursuit-note').innerText(), /lrr48/);
    await typeNumber(control(page, 'spinbutton', 'Elements'), '8');
    await method(page, 'DNN (network)').check();
    await page.waitForSelector('[data-row="dnn"]', patient);
    await parametersWith(page, (params) => params.get('methods').split(',').includes('dnn'));
  },
);

browserTest(
  'networks in the angle lab: a transformer takes positions that are typed, and its deviations are shown',
  { path: '#/angle?array=ula24&targets=-20:0,5:-3,31:-6&snr=25&snapshots=1&seed=2&methods=iaa,aaetr' },
  async ({ page }) => {
    const found = '[data-row="aaetr"] [data-field="error"][data-value]';
    await page.waitForSelector(found, patient);
    const check = async () => {
      const [errors, stated] = [
        await values(page, '[data-row="aaetr"] [data-field="error"]'),
        await values(page, '[data-row="aaetr"] [data-field="azimuth-deviation"]'),
      ];
      assert.deepEqual([errors.length, stated.length], [3, 3]);
      // Each of three errors is within four deviations, and they say something: less than half a beam.
      errors.forEach((error, i) =>
        assert.ok(Math.abs(error) < 4 * stated[i] && stated[i] < 2.5, `${error}, ±${stated[i]}`),
      );
    };
    await check();
    await page.getByText('bars ±σ it states').first().waitFor();
    await control(page, 'combobox', 'Virtual array').selectOption('at');
    await typeText(
      control(page, 'textbox', 'Positions, half wavelengths'),
      Array.from({ length: 20 }, (_, k) => (1.7 * k + 0.5 * ((k * k) % 3)).toFixed(1)).join(', '),
    );
    await parametersWith(page, (params) => params.get('array')?.split(',').length === 20);
    await page.waitForSelector(found, patient);
    await check();
    assert.equal(await page.locator('[data-row="iaa"] [data-field="azimuth-deviation"]').count(), 0);
  },
);

browserTest(
  'networks in Capture: the DNN works on a cell of the recording, the learned pursuit says why not',
  { path: '#/capture?methods=bartlett,dnn&sources=1' },
  async ({ page }) => {
    await page.waitForSelector('[data-row="dnn"] [data-field="azimuth"][data-value]', patient);
    const [azimuth] = await values(page, '[data-row="dnn"] [data-field="azimuth"]');
    // The recording's near target lies at -10.8 deg, just outside the network's classes.
    assert.ok(Math.abs(azimuth + 10) <= 2, `${azimuth} deg`);
    assert.ok(await method(page, 'Learned pursuit (network)').isDisabled());
    assert.match(await page.locator('#cell-learned-pursuit-note').innerText(), /lrr48/);
  },
);

const regionRow = (bin) => `[data-table="regions"][aria-busy="false"] [data-region="${bin}"]`;
/** The number of targets counted in the region of a range bin, and their azimuths. */
async function counted(page, bin) {
  const row = page.locator(regionRow(bin));
  const data = (field) => row.locator(`[data-field="${field}"]`).getAttribute('data-value');
  return { sources: Number(await data('sources')), azimuths: (await data('azimuths')).split(',').map(Number) };
}

browserTest(
  'networks in Capture: regions are counted, and their targets told where classical methods see them',
  { path: '#/capture?frame=3' },
  async ({ page }) => {
    await page.waitForSelector('[data-table="detections"] [data-field="rangeM"][data-value]');
    const regions = control(page, 'region', 'Regions, counted and told by networks');
    const find = regions.getByRole('button', { name: 'Find regions' });
    await find.click();
    // Both targets of the recording, at 2.95 and 4.94 m, with Bartlett's azimuths.
    const targets = [
      [58, -11.1],
      [97, -0.4],
    ];
    for (const [bin, classicalDeg] of targets) {
      await page.waitForSelector(regionRow(bin), patient);
      const { sources, azimuths } = await counted(page, bin);
      assert.equal(sources, 1, `bin ${bin}`);
      assert.ok(Math.abs(azimuths[0] - classicalDeg) <= 1, `bin ${bin}: ${azimuths}, ${classicalDeg} by Bartlett`);
    }
    assertCsv(
      await saved(page, regions.getByRole('button', { name: 'CSV' })),
      'range_bin,range_m,rate_mps,snr_db,coarse_azimuth_deg,turned,targets,p0,p1,p2,azimuth_1_deg,power_1_db,azimuth_2_deg,power_2_db',
    );
    await parametersWith(page, (params) => params.get('regions') === '1');
    // As far as the paper's regions reach, weaker peaks are part of those of stronger ones.
    const number = '[data-table="regions"][aria-busy="false"] [data-count]';
    const before = await page.locator(number).getAttribute('data-count');
    await typeNumber(control(page, 'spinbutton', 'Reach'), '32');
    await page.waitForFunction(
      ([selector, many]) => Number(document.querySelector(selector)?.dataset.count) < Number(many),
      [number, before],
      patient,
    );
    await parametersWith(page, (params) => params.get('regionReach') === '32');
    await regions.getByRole('button', { name: 'Stop' }).click();
    await find.waitFor();
    assert.equal(await page.locator('[data-region]').count(), 0);
    await parametersWith(page, (params) => !params.has('regions'));
  },
);

browserTest(
  'networks in Capture: a link finds regions by the DNN, in the frame it names',
  { path: '#/capture?frame=5&regions=1&regionsBy=dnn' },
  async ({ page }) => {
    await page.waitForSelector(regionRow(97), patient);
    assert.match(await page.locator('[data-table="regions"] [data-count]').innerText(), /in frame 6/);
    const { sources, azimuths } = await counted(page, 97);
    assert.ok(sources === 1 && Math.abs(azimuths[0] + 0.4) <= 1, `${sources}: ${azimuths}`);
  },
);

browserTest(
  'networks in Bird’s-eye view: an image by the learned pursuit',
  { path: '#/birdseye?methods=bartlett,learned-pursuit&radars=front-left&cell=0.5' },
  async ({ page }) => {
    await page.waitForSelector(
      '[aria-busy="false"] [data-row="learned-pursuit"] [data-field="outsideDb"][data-value]',
      { timeout: 80_000 },
    );
    const [network] = await values(page, '[data-row="learned-pursuit"] [data-field="outsideDb"]');
    const [fft] = await values(page, '[data-row="bartlett"] [data-field="outsideDb"]');
    assert.ok(network < fft - 3, `learned pursuit ${network} dB, FFT ${fft} dB`);
  },
);
