// The custom elements of boresight/elements on a page of their own, fed with what the package computes.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { recording, recordings } from './demo.mjs';
import { browserTest } from './harness.mjs';
import { serve } from './session.mjs';

const PAGE = `<!doctype html><html lang="en"><title>elements</title>
<script type="importmap">{ "imports": {
  "boresight": "/lib/browser.js", "boresight/worker": "/worker/browser.js", "boresight/elements": "/elements/index.js"
} }</script>
<style>body { margin: 8px; display: grid; grid-template-columns: 1fr 1fr; gap: 8px; background: Canvas; color: CanvasText }</style>
<body></body></html>`;

/** The built package as a site, on which there is no page. */
let site;
const served = async () => (site ??= await serve(root));
after(() => site?.close());

/** A page with the package and the elements at hand. */
async function open(page, url) {
  await page.route('**/page.html', (route) => route.fulfill({ contentType: 'text/html', body: PAGE }));
  await page.goto(new URL('page.html', url).href);
  await page.evaluate(async () => {
    window.boresight = await import('boresight');
    window.elements = await import('boresight/elements');
    await Promise.all([boresight.init(), boresight.initDrives()]);
    window.add = (name, attributes = {}, properties = {}) => {
      const made = document.createElement(name);
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
      document.body.append(Object.assign(made, properties));
      return made;
    };
    /** Two frames of the screen later all is drawn. */
    window.drawn = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    window.part = (element, name) => element.shadowRoot.querySelector(`[part="${name}"]`);
    /** Pixels of the plot that are not its background. */
    window.inked = (element) => {
      const canvas = element.shadowRoot.querySelector('.u-wrap canvas');
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 3; i < data.length; i += 4) if (data[i] > 0) count += 1;
      return count / (data.length / 4);
    };
  });
}

const elementTest = (name, body, options = {}) =>
  browserTest(`elements: ${name}`, { served, path: 'lib/index.js', ...options }, async (view) => {
    // What was there before the page was opened is no problem of the elements.
    await open(view.page, view.url);
    view.problems.length = 0;
    await body(view);
  });

elementTest(
  'a spectrum shows its angles, is used by keys, and follows theme, properties and size',
  async ({ page, screenshot }) => {
    const said = await page.evaluate(async () => {
      const { data, shape } = boresight.simulateSnapshots({
        array: 'ula8',
        targets: [{ azimuthDeg: -12 }, { azimuthDeg: 20 }],
        snapshots: 50,
        snrDb: 20,
        seed: 1,
      });
      const snapshots = { data, shape: shape.slice(-2) };
      const of = (method) => boresight.estimate({ snapshots }, { array: 'ula8', method, sources: 2 });
      const element = add(
        'boresight-spectrum',
        { heading: 'Two sources' },
        { estimates: [of('capon'), of('music'), of('esprit')], truthDeg: [-12, 20] },
      );
      await drawn();
      return {
        alternative: part(element, 'alternative').textContent,
        heading: part(element, 'heading').textContent,
        ink: inked(element),
        legend: part(element, 'legend').textContent,
      };
    });
    assert.match(said.alternative, /capon: .*[+-−]1[12]\.\d+°/);
    assert.match(said.alternative, /esprit: /);
    assert.equal(said.heading, 'Two sources');
    assert.equal(said.legend, 'caponmusicesprit');
    assert.ok(said.ink > 0.02, `${said.ink} of the plot is drawn on`);

    await page.evaluate(() => {
      window.cursors = [];
      document.addEventListener('boresight-cursor', ({ detail }) => cursors.push(detail));
    });
    await page.keyboard.press('Tab');
    await page.keyboard.press('ArrowRight');
    const readout = page.locator('boresight-spectrum').locator('[part="readout"]');
    assert.match(await readout.textContent(), /Azimuth .*° {3}capon -?−?\d+\.\d dB/);
    assert.ok((await page.evaluate(() => cursors.at(-1)?.x)) !== undefined, 'the event leaves the shadow root');

    const looks = await page.evaluate(async () => {
      const element = document.querySelector('boresight-spectrum');
      const background = () => {
        const { backgroundColor, color } = getComputedStyle(part(element, 'figure'));
        return [backgroundColor, color];
      };
      const light = background();
      element.setAttribute('theme', 'dark');
      await drawn();
      const dark = background();
      element.style.setProperty('--boresight-background', 'rgb(1, 2, 3)');
      element.setAttribute('theme', 'light');
      await drawn();
      const own = background();
      const before = element.shadowRoot.querySelector('.u-wrap canvas').width;
      element.style.width = '300px';
      await drawn();
      return { light, dark, own, before, after: element.shadowRoot.querySelector('.u-wrap canvas').width };
    });
    assert.deepEqual(looks.light, ['rgb(255, 255, 255)', 'rgb(35, 41, 47)']);
    assert.deepEqual(looks.dark, ['rgb(25, 29, 33)', 'rgb(223, 228, 232)']);
    assert.deepEqual(looks.own, ['rgb(1, 2, 3)', 'rgb(35, 41, 47)']);
    assert.ok(looks.after < 310 && looks.after < looks.before, JSON.stringify(looks));
    await screenshot('elements-spectrum');
  },
);

elementTest('every kind draws what the package gives, in words too', async ({ page, screenshot }) => {
  const bytes = [...recording('xwr16xx_crw_dca_module_2018_1015v2.bin').subarray(0, 4 << 20)];
  const config = recording('profile.cfg').toString();
  const all = await page.evaluate(
    async ({ bytes, config }) => {
      const capture = new boresight.Capture(new Uint8Array(bytes), config);
      add('boresight-range-doppler', { heading: 'Range-Doppler', colors: 'magma' }, { frame: capture.processFrame(0) });
      const drive = boresight.simulateDrive({ durationS: 20, seed: 3, profile: 'radarscenes' });
      const found = boresight.calibrateDrive(drive, { sensor: 2, weights: true });
      const at = found.frames.scan[120];
      const [from, to] = [drive.scans.offsets[at], drive.scans.offsets[at + 1]];
      const column = (name) => drive.detections[name].subarray(from, to);
      const { offsets, values } = found.frames.weights;
      const scan = {
        azimuthDeg: column('azimuthDeg'),
        rangeRateMps: column('rangeRateMps'),
        rangeM: column('rangeM'),
        weights: values.subarray(offsets[120], offsets[121]),
      };
      const motion = { vxMps: found.frames.vxMps[120], vyMps: found.frames.vyMps[120] };
      add(
        'boresight-point-cloud',
        { heading: 'Detections' },
        { points: scan, mounting: { xM: 3.9, yM: -0.7, yawDeg: -25 } },
      );
      add('boresight-doppler-azimuth', { heading: 'Doppler over azimuth' }, { frame: { ...scan, motion } });
      add(
        'boresight-mounting-angle',
        { heading: 'Mounting angle', 'nominal-deg': found.mounting.nominalDeg, 'tolerance-deg': 5 },
        { history: found.history },
      );
      const n = 60;
      const power = Float32Array.from(
        { length: n * n },
        (_, k) => 1 + 1e4 * Math.exp(-((Math.floor(k / n) - 40) ** 2 + ((k % n) - 20) ** 2) / 8),
      );
      add(
        'boresight-birds-eye',
        { heading: 'Ground' },
        {
          view: {
            xM: Float64Array.from({ length: n }, (_, i) => i - 10),
            yM: Float64Array.from({ length: n }, (_, i) => i - 30),
            power,
            seen: Uint8Array.from({ length: n * n }, () => 1),
            radar: new Int8Array(n * n),
            shape: [n, n],
            cellM: 1,
            mountings: [],
          },
        },
      );
      await drawn();
      capture.free();
      return [...document.querySelectorAll('body > *')].map((element) => ({
        name: element.localName,
        ink: inked(element),
        alternative: part(element, 'alternative').textContent,
        role: part(element, 'plot').getAttribute('role'),
        label: part(element, 'plot').getAttribute('aria-label'),
      }));
    },
    { bytes, config },
  );
  const words = {
    'boresight-range-doppler': /ranges to .* m, .*\nDetection at/s,
    'boresight-point-cloud': /\d+ detections, of which \d+ are taken as static/,
    'boresight-doppler-azimuth': /the radar moves with \d+\.\d+ m\/s/,
    'boresight-mounting-angle': /After \d+ s: .*°, standard deviation .*; (within tolerance|not settled)/,
    'boresight-birds-eye': /60 m ahead by 60 m across in cells of 1 m/,
  };
  assert.equal(all.length, 5);
  for (const { name, ink, alternative, role, label } of all) {
    assert.match(alternative, words[name], name);
    assert.ok(ink > 0.01, `${name}: ${ink}`);
    assert.equal(role, 'application');
    assert.match(label, /Plus and minus zoom/);
  }
  await screenshot('elements-all', { fullPage: true });
});

elementTest('live data are drawn once a frame of the screen, and a knock is told', async ({ page }) => {
  const { sets, draws, alarms } = await page.evaluate(async () => {
    const element = add('boresight-mounting-angle', { 'nominal-deg': 25, 'tolerance-deg': 1 });
    const alarms = [];
    element.addEventListener('boresight-alarm', ({ detail }) => alarms.push(detail.alarm));
    let draws = 0;
    const list = part(element, 'alternative');
    new MutationObserver(() => (draws += 1)).observe(list, { childList: true, characterData: true, subtree: true });
    let sets = 0;
    for (let screen = 0; screen < 60; screen++) {
      for (let k = 0; k < 10; k++) {
        sets += 1;
        element.add(sets / 20, { angleDeg: screen < 40 ? 25.1 : 28, sigmaDeg: 0.1 });
      }
      await new Promise(requestAnimationFrame);
    }
    await drawn();
    return { sets, draws, alarms };
  });
  assert.equal(sets, 600);
  assert.ok(draws <= 62, `${draws} drawings of ${sets} numbers`);
  assert.deepEqual(alarms, ['pass', 'fail']);
});

elementTest('files are opened, worked on, cancelled and refused', async ({ page }) => {
  await page.evaluate(() => {
    window.told = [];
    for (const name of ['boresight-result', 'boresight-error'])
      document.addEventListener(name, ({ type, target, detail }) =>
        told.push([target.localName, type, detail?.message]),
      );
    add('boresight-capture', { frame: 1 });
    add('boresight-drive', { 'x-m': 3 });
  });
  const folder = recordings('awr1642');
  const capture = page.locator('boresight-capture');
  await capture
    .locator('input[type=file]')
    .setInputFiles([join(folder, 'xwr16xx_crw_dca_module_2018_1015v2.bin'), join(folder, 'profile.cfg')]);
  await page.waitForFunction(() =>
    told.some(([name, type]) => name === 'boresight-capture' && type === 'boresight-result'),
  );
  assert.ok((await page.evaluate(() => document.querySelector('boresight-capture').frame.frame)) === 1);
  const slider = capture.getByLabel('Frame');
  await slider.focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => document.querySelector('boresight-capture').frame.frame === 2);

  const drive = page.locator('boresight-drive');
  await drive
    .locator('input[type=file]')
    .setInputFiles([join(recordings('delphi'), 'front_radar.csv.gz'), join(recordings('delphi'), 'pose_10hz.csv.gz')]);
  await drive.getByRole('button', { name: 'Cancel' }).click();
  assert.equal(await drive.getByRole('button', { name: 'Cancel' }).isVisible(), false);
  await page.evaluate(() => document.querySelector('boresight-drive').setAttribute('method', 'least-squares'));
  await drive
    .locator('input[type=file]')
    .setInputFiles([join(recordings('delphi'), 'front_radar.csv.gz'), join(recordings('delphi'), 'pose_10hz.csv.gz')]);
  await page.waitForFunction(() => document.querySelector('boresight-drive').calibration !== null, undefined, {
    timeout: 60_000,
  });
  const angle = await page.evaluate(() => document.querySelector('boresight-drive').calibration.result.angleDeg);
  assert.ok(Math.abs(angle + 1.96) < 0.4, `${angle}`);
  assert.match(await drive.locator('[part="value"]').textContent(), /^[−-][12]\.\d\d° ± /);

  await drive.locator('input[type=file]').setInputFiles([join(folder, 'profile.cfg')]);
  await drive.getByRole('alert').waitFor();
  assert.ok((await page.evaluate(() => told.at(-1)[1])) === 'boresight-error');
  await capture.locator('input[type=file]').setInputFiles([join(folder, 'profile.cfg')]);
  assert.match(await capture.getByRole('alert').textContent(), /\.bin/);
});

elementTest(
  'a thousand connects leave nothing behind, and properties may come before the definition',
  async ({ page, context }) => {
    const early = await page.evaluate(async () => {
      const before = document.createElement('boresight-early');
      before.history = { timeS: [0, 1], angleDeg: [1, 1], sigmaDeg: [0.1, 0.1] };
      document.body.append(before);
      customElements.define('boresight-early', class extends elements.MountingAngleElement {});
      await drawn();
      elements.define();
      return { alternative: part(before, 'alternative').textContent, own: Object.hasOwn(before, 'history') };
    });
    assert.match(early.alternative, /After 1 s: \+1\.00°/);
    assert.equal(early.own, false);
    const session = await context.newCDPSession(page);
    const cycle = (times) =>
      page.evaluate(async (times) => {
        const history = { timeS: [0, 1, 2], angleDeg: [1, 1, 1], sigmaDeg: [0.1, 0.1, 0.1] };
        for (let i = 0; i < times; i++) {
          const element = add('boresight-mounting-angle', {}, { history });
          if (i % 10 === 0) await drawn();
          element.remove();
        }
        await drawn();
      }, times);
    const counted = async () => {
      await session.send('HeapProfiler.collectGarbage');
      const { nodes, jsEventListeners } = await session.send('Memory.getDOMCounters');
      const { usedSize } = await session.send('Runtime.getHeapUsage');
      return { nodes, jsEventListeners, usedSize };
    };
    await cycle(100);
    const before = await counted();
    await cycle(900);
    const after = await counted();
    assert.ok(after.nodes <= before.nodes + 20, `${before.nodes} nodes, then ${after.nodes}`);
    assert.ok(after.jsEventListeners <= before.jsEventListeners + 10, JSON.stringify([before, after]));
    assert.ok(after.usedSize < before.usedSize + 1_000_000, JSON.stringify([before, after]));
  },
);

elementTest('the manifest lists each element with the attributes it listens to', async ({ page }) => {
  const { modules } = JSON.parse(readFileSync(join(root, 'dist', 'elements', 'custom-elements.json'), 'utf8'));
  const listed = modules
    .flatMap(({ declarations }) => declarations)
    .filter(({ customElement, tagName }) => customElement && tagName)
    .map(({ tagName, attributes }) => [tagName, attributes.map(({ name }) => name).sort()])
    .sort(([a], [b]) => (a < b ? -1 : 1));
  const found = await page.evaluate(() =>
    Object.entries(elements.elements).map(([name, made]) => [name, [...made.observedAttributes].sort()]),
  );
  assert.deepEqual(listed, found);
});
