// The custom elements of boresight/elements on a page of their own, fed with what the package computes.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';
import { assertCsv, assertPng, recording, recordings, saved } from '../lib/demo.mjs';
import { elementTest } from './elements.mjs';

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
    assert.equal(said.legend, 'capon–music–esprit', 'those with spectra have values at the cursor');
    assert.ok(said.ink > 0.02, `${said.ink} of the plot is drawn on`);

    await page.evaluate(() => {
      window.cursors = [];
      document.addEventListener('boresight-cursor', ({ detail }) => cursors.push(detail));
    });
    await page.keyboard.press('Tab');
    await page.keyboard.press('ArrowRight');
    await page.evaluate(() => drawn());
    const readout = page.locator('boresight-spectrum').locator('[part="readout"]');
    assert.match(await readout.textContent(), /Azimuth .*° {3}Level −?\d+\.\d\u00a0dB/);
    assert.match(await page.locator('boresight-spectrum [part="legend"]').innerText(), /capon\s+−?\d+\.\d\u00a0dB/);
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
  const captureFiles = capture.getByLabel('a capture', { exact: true });
  await captureFiles.setInputFiles([
    join(folder, 'xwr16xx_crw_dca_module_2018_1015v2.bin'),
    join(folder, 'profile.cfg'),
  ]);
  await page.waitForFunction(() =>
    told.some(([name, type]) => name === 'boresight-capture' && type === 'boresight-result'),
  );
  assert.ok((await page.evaluate(() => document.querySelector('boresight-capture').frame.frame)) === 1);
  const slider = capture.getByLabel('Frame');
  await slider.focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => document.querySelector('boresight-capture').frame.frame === 2);

  const drive = page.locator('boresight-drive');
  const driveFiles = drive.getByLabel('a drive', { exact: true });
  const tables = ['front_radar.csv.gz', 'pose_10hz.csv.gz'].map((name) => join(recordings('delphi'), name));
  await driveFiles.setInputFiles(tables);
  const cancel = drive.getByRole('button', { name: 'Cancel' });
  await cancel.click();
  await cancel.waitFor({ state: 'hidden' });
  await page.evaluate(() => document.querySelector('boresight-drive').setAttribute('method', 'least-squares'));
  await driveFiles.setInputFiles(tables);
  await page.waitForFunction(() => document.querySelector('boresight-drive').calibration !== null, undefined, {
    timeout: 60_000,
  });
  const angle = await page.evaluate(() => document.querySelector('boresight-drive').calibration.result.angleDeg);
  assert.ok(Math.abs(angle + 1.96) < 0.4, `${angle}`);
  await page.evaluate(() => drawn());
  assert.match(await drive.locator('[part="value"]').textContent(), /^[−-][12]\.\d\d° ± /);

  await driveFiles.setInputFiles([join(folder, 'profile.cfg')]);
  await drive.getByRole('alert').waitFor();
  assert.ok((await page.evaluate(() => told.at(-1)[1])) === 'boresight-error');
  await captureFiles.setInputFiles([join(folder, 'profile.cfg')]);
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

/** A plot of one's own of a line, with a point to move, and what it tells. */
const addLine = (page) =>
  page.evaluate(async () => {
    window.told = [];
    for (const name of ['select', 'view', 'drag', 'remove', 'key', 'double-click'])
      document.addEventListener(`boresight-${name}`, (event) => {
        const { key, ...detail } = event.detail;
        told.push({ name, key: key ?? event.detail.key, ...detail });
        if (name === 'double-click' || event.detail.key === 'n') event.preventDefault();
      });
    const x = [0, 1, 2, 3, 4];
    const style = { color: { light: '#0072b2', dark: '#4aa8e8' } };
    window.lineOf = (points) => ({
      axes: { x: { label: 'Time (s)' }, y: { label: 'Level (dB)' } },
      content: {
        x,
        series: [{ id: 'a', label: 'A', y: [0, 10, 20, 30, 40], style }],
        extent: { x: [0, 4], y: [0, 40] },
      },
      legend: [
        { id: 'a', label: 'A', style, line: true, value: ({ index }) => `${10 * index} dB`, rest: 'of 40 dB' },
        { label: 'B', style, line: false },
      ],
      readout: ({ x: time }) => `Time ${time.toFixed(1)} s`,
      csv: () => 'time_s,level_db\r\n0,0\r\n',
      movable: { points, steps: { x: [0.5, 1], y: [1, 5] }, help: 'Drag it' },
    });
    const element = add(
      'boresight-plot',
      { heading: 'Line', detail: 'of 5', hint: 'Click it.', tools: '', 'file-name': 'line', 'cursor-group': 'time' },
      { remarks: ['Straight.'], drawing: lineOf([{ x: 2, y: 20, label: 'Point 1' }]) },
    );
    element.append(Object.assign(document.createElement('button'), { slot: 'actions', textContent: 'Own' }));
    document.addEventListener('boresight-drag', ({ detail: { x: at, y } }) => {
      element.drawing = lineOf([{ x: at, y, label: 'Point 1' }]);
    });
    document.addEventListener('boresight-remove', () => {
      element.drawing = lineOf([]);
    });
    add('boresight-plot', { 'cursor-group': 'time', tools: '' }, { drawing: { ...lineOf([]), csv: undefined } });
    await drawn();
  });

elementTest(
  'a plot of one’s own has tools, words and values, and saves what it shows',
  async ({ page, screenshot }) => {
    await addLine(page);
    const [line, other] = [page.locator('boresight-plot').first(), page.locator('boresight-plot').last()];
    assert.deepEqual(await line.getByRole('button').allInnerTexts(), [
      'Own',
      '+',
      '−',
      'Reset',
      'PNG',
      'SVG',
      'CSV',
      '',
    ]);
    assert.equal(await other.getByRole('button', { name: 'CSV' }).count(), 0, 'there are no numbers');
    assert.equal(await line.locator('[part="remarks"]').innerText(), 'Straight. Click it.');
    assert.equal(await line.locator('[part="readout"]').innerText(), 'Cursor: point at the plot');
    assert.deepEqual(await line.locator('[part="legend"] li').allInnerTexts(), ['A\nof 40 dB', 'B']);
    const said = await page.evaluate(() => {
      const root = document.querySelector('boresight-plot').shadowRoot;
      const ids = root.querySelector('.plot').getAttribute('aria-describedby').split(' ');
      return [root.querySelector('.plot').ariaLabel, ...ids.map((id) => root.getElementById(id).textContent)];
    });
    assert.deepEqual(said, [
      'Line. Plus and minus zoom, 0 resets. Left and right move the cursor.',
      'of 5',
      'Aof 40 dBB',
      'Straight. Click it.',
    ]);

    await line.getByRole('application').press('ArrowRight');
    await page.evaluate(() => drawn());
    assert.equal(await line.locator('[part="readout"]').innerText(), 'Time 3.0 s');
    assert.equal(await line.locator('[part="legend"] li').first().innerText(), 'A\n30 dB');
    await line.locator('[part="live"]').filter({ hasText: 'Time 3.0 s' }).waitFor({ state: 'attached' });
    assert.equal(await other.locator('[part="live"]').textContent(), '', 'only where the focus is is it said');

    await line.locator('.u-over').hover({ position: { x: 200, y: 60 } });
    await page.evaluate(() => drawn());
    assert.match(
      await other.locator('[part="readout"]').innerText(),
      /Time [0-3]\.\d s/,
      'the group shares its cursor',
    );

    await page.evaluate(() => {
      document.querySelector('boresight-plot').caption = () => ['Figure 1.'];
    });
    assertCsv(await saved(page, line.getByRole('button', { name: 'CSV' })), 'time_s,level_db');
    assertPng(await saved(page, line.getByRole('button', { name: 'PNG' })));
    const { name, bytes } = await saved(page, line.getByRole('button', { name: 'SVG' }));
    assert.equal(name, 'boresight-line.svg');
    const drawing = bytes.toString('utf8');
    for (const text of ['Line, of 5', '>A<', '>B<', 'Figure 1.']) assert.ok(drawing.includes(text), text);
    assert.ok(!drawing.includes('Straight.'), 'the caption is in place of the remarks');
    await screenshot('elements-own');
  },
);

elementTest('points are moved, keys and clicks told, and a zoom is set from outside', async ({ page }) => {
  await addLine(page);
  const line = page.locator('boresight-plot').first();
  const last = () => page.evaluate(() => told.at(-1));
  const point = line.getByRole('button', { name: 'Point 1' });
  const { x, y, width, height } = await point.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 60, y + height / 2, { steps: 3 });
  await page.mouse.up();
  const moved = await last();
  assert.equal(moved.name, 'drag');
  assert.ok(moved.x > 2.2 && Math.abs(moved.y - 20) < 0.5, JSON.stringify(moved));
  for (const key of ['Shift+ArrowLeft', 'ArrowLeft', 'ArrowLeft', '+']) await page.keyboard.press(key);
  const nudged = await last();
  assert.ok(Math.abs(nudged.x - (moved.x - 2)) < 1e-9 && Math.abs(nudged.y - (moved.y + 1)) < 1e-9);
  await page.keyboard.press('Delete');
  await page.waitForFunction(() => focused().matches('.plot'), undefined, { polling: 'raf' });
  assert.equal(await point.count(), 0);

  const shown = () => page.evaluate(() => document.querySelector('boresight-plot').zoom);
  await page.keyboard.press('n');
  assert.equal(await shown(), null);
  await page.keyboard.press('+');
  assert.deepEqual((await shown()).x, [1, 3]);
  const { key, name, zoomed } = await last();
  assert.deepEqual([key, name, zoomed], [undefined, 'view', true]);
  const over = line.locator('.u-over');
  await over.dblclick({ position: { x: 100, y: 50 } });
  assert.equal((await last()).name, 'double-click');
  assert.deepEqual((await shown()).x, [1, 3], 'what is prevented does not reset the zoom');
  await over.click({ position: { x: 100, y: 50 } });
  assert.equal((await last()).name, 'select');
  await line.getByRole('button', { name: 'Reset' }).click();
  assert.equal(await shown(), null);

  const events = await page.evaluate(async () => {
    const element = document.querySelector('boresight-plot');
    const before = told.length;
    element.zoom = { x: [0, 2], y: [0, 40] };
    element.playhead = 1;
    await drawn();
    return told.length - before;
  });
  assert.equal(events, 0, 'what is set is not told');
  const box = await over.boundingBox();
  const head = await line.locator('.playhead').boundingBox();
  assert.ok(Math.abs(head.x + head.width / 2 - (box.x + box.width / 2)) < 1.5, JSON.stringify([head, box]));
  await page.evaluate(() => {
    document.querySelector('boresight-plot').playhead = null;
  });
  await line.locator('.playhead').waitFor({ state: 'hidden' });
});

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
