// What elements show beyond their data: what is public because the demo and dashboards want it.
import assert from 'node:assert/strict';
import { elementTest } from './elements.mjs';

/** What an element says of itself. */
const said = (page, name) =>
  page.evaluate(async (name) => {
    await drawn();
    const element = document.querySelector(name);
    const [legend, words] = ['legend', 'alternative'].map((one) => part(element, one));
    return {
      label: part(element, 'plot').ariaLabel,
      legend: [...legend.querySelectorAll('li')].map(({ textContent }) => textContent),
      words: words.textContent,
      csv: element.csv().trimEnd().split('\r\n'),
    };
  }, name);

/** What is read off at a place of the plot, as shares of it from left and top. */
const readAt = async (page, name, x, y) => {
  const over = page.locator(`${name} .u-over`);
  const { width, height } = await over.boundingBox();
  await over.hover({ position: { x: x * width, y: y * height } });
  await page.evaluate(() => drawn());
  return page.locator(`${name} .readout`).innerText();
};

elementTest('Doppler over azimuth has curves, residuals, a sector and a bar of weights', async ({ page }) => {
  const name = 'boresight-doppler-azimuth';
  await page.evaluate(() => {
    const motion = { vxMps: 10, vyMps: 0 };
    const azimuthDeg = [-20, 0, 20];
    const rangeRateMps = azimuthDeg.map((angle, i) => -10 * Math.cos((angle * Math.PI) / 180) + (i === 1 ? 0.5 : 0));
    add(
      'boresight-doppler-azimuth',
      { sector: '-40 60' },
      { frame: { azimuthDeg, rangeRateMps, motion, weights: [1, 0, 1] } },
    );
  });
  const before = await said(page, name);
  assert.deepEqual(before.legend, ['Static, weight ≥ 0.5', 'Outlier', 'What stands']);
  assert.equal(before.csv[0], 'azimuth_deg,range_rate_mps,range_m,rcs_dbsm,residual_mps,weight');
  assert.match(before.csv[2], /^0,-9\.5,,,0\.5,0$/);
  assert.match(
    await readAt(page, name, 0.4, 0.5),
    /^Azimuth \+(19|20)\.\d° {3}−?\d+\.\d\d m\/s$/,
    'the sector is not symmetric',
  );
  const width = () => page.locator(`${name} .u-over`).evaluate(({ clientWidth }) => clientWidth);
  const whole = await width();
  await page.evaluate(() => {
    const element = document.querySelector('boresight-doppler-azimuth');
    element.setAttribute('residual', '');
    element.setAttribute('weight-bar', '');
    const style = { color: { light: '#000', dark: '#fff' } };
    element.motions = [{ id: 'slow', label: 'Slower', motion: { vxMps: 9, vyMps: 0 }, style }];
  });
  assert.equal((await said(page, name)).legend.at(-1), 'Slower');
  assert.ok((await width()) < whole - 40, 'there is room for the bar');
  // The rates less those of what stands are 0, but for one.
  assert.match(await readAt(page, name, 0.6, 0.5), /0\.\d\d m\/s|residual \+0\.50/);
});

elementTest(
  'a spectrum has levels as estimated, targets that move, bounds, and estimates to compare with',
  async ({ page }) => {
    const name = 'boresight-spectrum';
    await page.evaluate(() => {
      const targets = [{ azimuthDeg: -12, powerDb: 0 }];
      const { data, shape } = boresight.simulateSnapshots({
        array: 'ula8',
        targets,
        snapshots: 50,
        snrDb: 20,
        seed: 1,
      });
      const estimate = boresight.estimate(
        { snapshots: { data, shape: shape.slice(-2) } },
        { array: 'ula8', method: 'capon', sources: 1 },
      );
      const now = { estimate, id: 'now', label: 'Now' };
      add(
        'boresight-spectrum',
        {
          levels: 'absolute',
          'high-db': 10,
          'floor-db': 50,
          sector: '-40 40',
          unit: 'dBm',
          movable: '',
          'noise-db': -20,
        },
        {
          estimates: [
            now,
            { ...now, id: 'before', label: 'Before', behind: true },
            { estimate: null, id: 'none', label: 'Later' },
          ],
          targets: targets.map(({ azimuthDeg }) => ({ azimuthDeg, powerDb: 0 })),
          boundsDeg: [0.5],
          lines: [{ azimuthDeg: 20, label: 'wall' }],
        },
      );
      document.addEventListener('boresight-drag', ({ detail: { x, y } }) => {
        document.querySelector('boresight-spectrum').targets = [{ azimuthDeg: x, powerDb: y }];
      });
    });
    const { legend, csv, words } = await said(page, name);
    assert.deepEqual(legend, ['Target, CRB ±σ band', 'Now–', 'Before', 'Later']);
    assert.equal(csv[0], 'azimuth_deg,now_dbm,before_dbm');
    assert.match(words, /^Now: −1[12]\.\d\d°\.$/, 'what is behind is not told again');
    // The plot ends at 40 degrees to the left, 10 dB up and 40 down.
    assert.match(await readAt(page, name, 0.5, 0.5), /Azimuth [+−]?0\.\d+° {3}Level −1[45]\.\d\u00a0dBm/);
    const handle = page.getByRole('button', { name: /^Target 1: azimuth −12\.0 degrees, power 0\.0 dB/ });
    await handle.focus();
    await page.keyboard.press('Shift+ArrowLeft');
    await page.getByRole('button', { name: /^Target 1: azimuth −11\.0/ }).waitFor();
    await page.evaluate(() => document.querySelector('boresight-spectrum').setAttribute('legend', 'image'));
    await page.locator(`${name} [part="legend"]`).waitFor({ state: 'hidden' });
    assert.match(
      await readAt(page, name, 0.5, 0.5),
      /Azimuth .*° {3}Now −?\d+\.\d {3}Before: |Now −?\d+\.\d {3}Before −?\d+\.\d dBm/,
    );
  },
);

elementTest('a bird’s-eye view has ground, overlays, radars and words of one’s own', async ({ page }) => {
  const name = 'boresight-birds-eye';
  await page.evaluate(() => {
    const n = 20;
    const at = (make) => Float64Array.from({ length: n }, (_, i) => make(i));
    const view = { xM: at((i) => i + 0.5), yM: at((i) => i - 9.5), cellM: 1, shape: [n, n], mountings: [] };
    const each = (Kind, make) => Kind.from({ length: n * n }, (_, i) => make(Math.floor(i / n), i % n));
    const cells = {
      // The second row ahead is empty; from 10 m ahead on, what is to the left is stronger.
      power: each(Float32Array, (ahead, left) => (ahead === 1 ? 0 : ahead >= 10 && left >= n / 2 ? 1000 : 100)),
      seen: each(Uint8Array, (ahead) => Number(ahead > 0)),
    };
    window.drawnOver = 0;
    add(
      'boresight-birds-eye',
      { unit: 'dBFS', bar: 'below', 'without-car': '', 'high-db': 30, 'low-db': 0 },
      {
        extent: { xM: [0, 40], yM: [-10, 10] },
        view: { ...view, ...cells, radar: new Int8Array(n * n) },
        radars: [{ name: 'front', title: 'Front radar' }],
        overlays: [() => (drawnOver += 1)],
        signs: [{ label: 'Wall', style: { color: { light: '#000', dark: '#fff' } }, line: true }],
        about: (xM, yM) => (xM > 15 ? `wall at ${yM.toFixed(0)}` : ''),
      },
    );
  });
  const { csv, legend, words } = await said(page, name);
  assert.deepEqual(legend, ['Wall']);
  assert.match(words, /20 m ahead by 20 m across in cells of 1 m; levels from 0 to 30 dBFS/);
  assert.equal(csv.length, 1 + 19 * 20, 'cells that no radar sees are left out');
  assert.equal(csv.at(-1), '19.500,9.500,30.00,front');
  assert.equal(csv[1], '1.500,-9.500,,front', 'nothing is no level');
  assert.ok((await page.evaluate(() => drawnOver)) > 0);
  // The whole ground is shown: its middle is 20 m ahead.
  assert.match(
    await readAt(page, name, 0.5, 0.55),
    /^x \+1[5-8]\.\d m {2}y .* m {2}[23]0\.0\u00a0dBFS {2}front radar {2}wall at -?\d+$/,
  );
  assert.match(await readAt(page, name, 0.5, 0.3), /not seen {2}wall/);
  const colours = (across = 0.5) =>
    page.locator(`${name} .u-wrap canvas`).evaluate((canvas, share) => {
      const { width, height } = canvas;
      return [...canvas.getContext('2d').getImageData(width * share, height * 0.46, 1, 1).data];
    }, across);
  const [[left], [right]] = [await colours(0.47), await colours(0.6)];
  assert.ok(left > right + 50, `the highest levels are yellow: ${left} to the left, ${right} to the right`);
  const before = await colours();
  await page.evaluate(() => document.querySelector('boresight-birds-eye').setAttribute('opacity', '0.2'));
  await said(page, name);
  assert.notDeepEqual(await colours(), before);
});

elementTest('a cell of a range-Doppler map is chosen by click and keys, if it may be', async ({ page }) => {
  const name = 'boresight-range-doppler';
  await page.evaluate(() => {
    window.cells = [];
    document.addEventListener('boresight-cell', ({ detail }) => cells.push(detail));
    const frame = {
      rangeM: Float64Array.from({ length: 10 }, (_, i) => i),
      rateMps: Float64Array.from({ length: 5 }, (_, i) => i - 2),
      rangeDopplerDb: Float32Array.from({ length: 50 }, (_, i) => -100 + i),
      detections: [
        { rangeM: 3, rateMps: 1 },
        { rangeM: 7, rateMps: -1 },
      ],
    };
    add('boresight-range-doppler', { legend: 'none' }, { frame });
  });
  await page.locator(`${name} .u-over`).click({ position: { x: 30, y: 30 } });
  assert.deepEqual(await page.evaluate(() => cells), [], 'nothing is chosen unless it may be');
  await page.evaluate(() => document.querySelector('boresight-range-doppler').setAttribute('selectable', ''));
  const { words, label, csv } = await said(page, name);
  assert.match(label, /Arrows choose a cell/);
  assert.match(words, /levels from -?−?110 to −50 dBFS/);
  assert.equal(csv.length, 51);
  assert.equal(await page.locator(`${name} [part="legend"]`).isVisible(), false);
  await page.locator(name).getByRole('application').focus();
  for (const key of ['n', 'n', 'ArrowUp', 'Shift+ArrowRight', 'Home']) await page.keyboard.press(key);
  const bins = (await page.evaluate(() => cells)).map((cell) => cell && [cell.rangeBin, cell.dopplerBin]);
  assert.deepEqual(bins, [[7, 1], [3, 3], [3, 4], [9, 4], null], 'the strongest comes first, and the map ends');
  const { width, height } = await page.locator(`${name} .u-over`).boundingBox();
  await page.locator(`${name} .u-over`).click({ position: { x: width * 0.25, y: height * 0.5 } });
  assert.deepEqual(await page.evaluate(() => cells.at(-1)), { rangeBin: 2, dopplerBin: 2 });
  await page.locator(`${name} [part="live"]`).filter({ hasText: 'Range 2.00 metres' }).waitFor({ state: 'attached' });
  assert.match(
    await readAt(page, name, 0.25, 0.5),
    /^Range 2\.000 m {3}Rate 0\.000 m\/s {3}Power −88\.0 dBFS {3}bin 2, 2$/,
  );
});

elementTest(
  'a point cloud shows where the radar looks and should look, on the ground that is asked for',
  async ({ page }) => {
    const name = 'boresight-point-cloud';
    await page.evaluate(() => {
      const points = { rangeM: [10, 10], azimuthDeg: [0, 90], rcsDbsm: [5, Number.NaN], weights: [1, 0] };
      const mounting = { xM: 1, yM: 0, yawDeg: 90 };
      const extent = { xM: [-20, 20], yM: [-20, 20] };
      add(
        'boresight-point-cloud',
        { boresight: '', 'nominal-deg': 88, 'drag-zooms': '' },
        { points, mounting, extent },
      );
    });
    const { legend, csv, words } = await said(page, name);
    assert.deepEqual(legend.slice(-2), ['Boresight, +90.00°', 'Nominal, +88.00°']);
    assert.match(words, /^2 detections, of which 1 are taken as static/);
    // Turned to the left: what is ahead of the radar is left of the car, what is left of it behind.
    const places = csv.slice(1).map((row) => row.split(',').map(Number));
    assert.deepEqual(
      places.map(([x, y]) => [Math.round(x), Math.round(y)]),
      [
        [1, 10],
        [-9, 0],
      ],
    );
    const zoom = () => page.evaluate(() => document.querySelector('boresight-point-cloud').zoom);
    const { x, y, width, height } = await page.locator(`${name} .u-over`).boundingBox();
    await page.mouse.move(x + width * 0.3, y + height * 0.3);
    await page.mouse.down();
    await page.mouse.move(x + width * 0.6, y + height * 0.7, { steps: 4 });
    await page.mouse.up();
    const shown = await zoom();
    assert.ok(shown && shown.y[1] - shown.y[0] < 25, 'a drag zoomed to its region');
  },
);

elementTest('a mounting angle’s plot holds its band and its tolerance, and gives its numbers', async ({ page }) => {
  const name = 'boresight-mounting-angle';
  await page.evaluate(() => {
    const count = 50;
    const history = {
      timeS: Float64Array.from({ length: count }, (_, i) => 100 + i),
      angleDeg: Float64Array.from({ length: count }, () => 10),
      sigmaDeg: Float64Array.from({ length: count }, (_, i) => 5 / (1 + i)),
    };
    add('boresight-mounting-angle', { 'nominal-deg': 10, 'tolerance-deg': 2, tools: '' }, { history });
  });
  const { csv } = await said(page, name);
  assert.deepEqual([csv.length, csv[0], csv[1]], [51, 'time_s,angle_deg,sigma_deg', '100,10,5']);
  const levels = [];
  for (const at of [0.02, 0.98]) {
    const over = page.locator(`${name} .u-over`);
    const { width, height } = await over.boundingBox();
    await page.evaluate(() => {
      document.addEventListener('boresight-cursor', ({ detail }) => {
        window.level = detail?.y ?? window.level;
      });
    });
    await over.hover({ position: { x: width / 2, y: height * at } });
    await page.evaluate(() => drawn());
    levels.push(await page.evaluate(() => level));
  }
  // The tolerance is drawn in, and what was not yet known at first is not.
  assert.ok(levels[0] > 12 && levels[0] < 14 && levels[1] < 8 && levels[1] > 6, levels.join());
});

elementTest(
  'detections are marked where they are between the lines of a coarse range-Doppler map',
  async ({ page }) => {
    const boxes = await page.evaluate(async () => {
      const boxes = [];
      for (const { prototype } of [CanvasRenderingContext2D, Path2D]) {
        const { rect } = prototype;
        prototype.rect = function (x, y, width, height) {
          if (width === height) boxes.push(y + height / 2);
          return rect.call(this, x, y, width, height);
        };
      }
      const rangeM = Float64Array.from({ length: 8 }, (_, i) => i);
      const rateMps = Float64Array.of(-20, -10, 0, 10);
      // Two on the lines, one between them, and one that is folded onto that by the span of 40 m/s.
      const detections = [
        { rangeM: 1, rateMps: -10, rangeBin: 1, dopplerBin: 1 },
        { rangeM: 2, rateMps: 0, rangeBin: 2, dopplerBin: 2 },
        { rangeM: 3, rateMps: -6, rangeBin: 3, dopplerBin: 1 },
        { rangeM: 4, rateMps: 34, rangeBin: 4, dopplerBin: 1 },
      ];
      add(
        'boresight-range-doppler',
        {},
        { frame: { rangeM, rateMps, rangeDopplerDb: new Float32Array(32), detections } },
      );
      await drawn();
      return boxes.slice(-4);
    });
    const [line, next, between, folded] = boxes;
    for (const at of [between, folded]) assert.ok(Math.abs((at - line) / (next - line) - 0.4) < 0.02, `${boxes}`);
  },
);
