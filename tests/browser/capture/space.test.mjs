/** Detections in space: the simulated capture, the 3-D view by mouse, keys and fingers, what it draws, and what it gives back. */
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { brotliCompressSync } from 'node:zlib';
import { root } from '../../../scripts/lib/paths.mjs';
import { button, region, spinbutton, twoFrames } from '../lib/controls.mjs';
import { assertCsv, assertPng, parameters, parametersWith, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeNumber } from '../lib/type.mjs';
import { findings } from '../site/axe.mjs';
import { chosenRow, frameSlider, frames } from './page.mjs';

const SIMULATED = '#/capture?source=simulated&frame=0&methods=bartlett&points=space';
const space = (page) => region(page, 'Point cloud in 3-D');
const host = (page) => space(page).getByRole('application');
const readout = (page) => space(page).locator('[data-readout]');
const fromAbove = (page) => page.locator('[data-plot="points"]');
// Locators, since handles of elements keep them from being given back.
const ready = (page, name = 'points') => page.locator(`[data-space="${name}"][data-state="ready"]`).waitFor();
const colours = ({ page, bytes }) =>
  page.evaluate(async (base64) => {
    const blob = await (await fetch(`data:image/png;base64,${base64}`)).blob();
    const image = await createImageBitmap(blob);
    const ctx = Object.assign(document.createElement('canvas'), image).getContext('2d');
    [ctx.canvas.width, ctx.canvas.height] = [image.width, image.height];
    ctx.drawImage(image, 0, 0);
    const { data } = ctx.getImageData(0, 0, image.width, image.height);
    let [saturated, corner] = [0, [data[0], data[1], data[2]]];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = data.subarray(i, i + 3);
      saturated += Math.max(r, g, b) - Math.min(r, g, b) > 60 ? 1 : 0;
    }
    return { saturated, corner, width: image.width, height: image.height };
  }, bytes.toString('base64'));
const picture = (page) => host(page).screenshot();
/** Waits until the picture of the view is as `accepts` wants it, and gives it. */
async function drawn(page, accepts, message) {
  for (let tries = 0; tries < 100; tries++) {
    const now = await picture(page);
    if (accepts(now)) return now;
    await twoFrames(page);
  }
  return assert.fail(message);
}
const looks = (page, expected, message = 'the view does not show what it showed') =>
  drawn(page, (now) => now.equals(expected), message);
const changes = (page, before, message = 'the view has not changed') =>
  drawn(page, (now) => !now.equals(before), message);
/** Where the view draws its largest chosen ring would need its own eyes: the middle of what the pointer finds is a point. */
async function findPoint(page) {
  const box = await host(page).boundingBox();
  for (let y = 20; y < box.height - 20; y += 14) {
    for (let x = 20; x < box.width - 20; x += 14) {
      await page.mouse.move(box.x + x, box.y + y);
      if (await host(page).locator('canvas.over').count()) return { x: box.x + x, y: box.y + y };
    }
  }
  return assert.fail('no point was found under the pointer');
}

browserTest('space: a simulated board tells azimuth, elevation and places', { path: SIMULATED }, async ({ page }) => {
  await ready(page);
  const table = '[data-table="detections"] tbody';
  const of = (field) => values(page, `${table} td[data-field="${field}"]`);
  const [x, y, z, range, elevation] = await Promise.all(['xM', 'yM', 'zM', 'rangeM', 'elevationDeg'].map(of));
  assert.ok(x.length > 12, `${x.length} detections`);
  x.forEach((at, i) => {
    assert.ok(Math.abs(Math.hypot(at, y[i], z[i]) - range[i]) < 1e-9, 'places are as far as they are said to be');
    assert.ok(Math.abs(Math.asin(z[i] / range[i]) - (elevation[i] * Math.PI) / 180) < 1e-9);
  });
  // The sign over the road is 4.2 m up, 17 m ahead.
  const sign = x.findIndex((at, i) => Math.abs(at - 17) < 1 && Math.abs(z[i] - 4.2) < 0.5 && Math.abs(y[i]) < 4);
  assert.ok(sign >= 0, `a sign among ${x.map((at, i) => [at, y[i], z[i]].map((v) => v.toFixed(1)))}`);
  const rows = assertCsv(
    await saved(page, button(region(page, 'Detections'), 'CSV')),
    'range_bin,doppler_bin,range_m,rate_mps,azimuth_deg,elevation_deg,x_m,y_m,z_m,power_dbfs,snr_db',
  );
  assert.equal(rows.length, x.length);
  assert.match(await page.locator('.controls').innerText(), /Simulated in this page/);
  // Steep ones go, and are counted.
  await typeNumber(spinbutton(page, 'Elevation ±'), '5');
  await page.waitForFunction(
    (before) => document.querySelectorAll('[data-table="detections"] tbody tr.pick').length < before,
    x.length,
  );
  for (const angle of await of('elevationDeg')) assert.ok(Math.abs(angle) <= 5);
});

browserTest('space: it turns, zooms, chooses and is reset by keys', { path: SIMULATED }, async ({ page }) => {
  await ready(page);
  await host(page).focus();
  const first = await picture(page);
  await page.keyboard.press('ArrowLeft');
  await changes(page, first, 'an arrow turns it');
  await page.keyboard.press('ArrowRight');
  await looks(page, first, 'and the other turns it back');
  for (const key of ['Shift+ArrowUp', '+', '+', '-']) await page.keyboard.press(key);
  await changes(page, first);
  await page.keyboard.press('Home');
  await looks(page, first, 'Home shows everything again');
  // The nearest comes first; the table and the address follow.
  await page.keyboard.press('Escape');
  await page.keyboard.press('n');
  await parametersWith(page, (params) => params.has('cell'));
  const one = parameters(page).get('cell');
  const chosen = chosenRow(page).first();
  assert.equal(await chosen.getAttribute('data-detection'), one);
  await page.keyboard.press('n');
  await parametersWith(page, (params) => params.get('cell') !== one);
  await page.keyboard.press('p');
  await parametersWith(page, (params) => params.get('cell') === one);
  assert.match(await readout(page).innerText(), /forward .* m +left .* m +up .* m +rate/);
});

browserTest(
  'space: a point is pointed at, tapped, and chosen from the table',
  { path: SIMULATED },
  async ({ page }) => {
    await ready(page);
    await host(page).scrollIntoViewIfNeeded();
    const at = await findPoint(page);
    assert.match(await readout(page).innerText(), /^forward/);
    await page.mouse.click(at.x, at.y);
    await parametersWith(page, (params) => params.has('cell'));
    const cell = parameters(page).get('cell');
    const row = chosenRow(page).first();
    assert.equal(await row.getAttribute('data-detection'), cell);
    const before = await picture(page);
    const unchosen = page.getByRole('button', { name: /show the cell/, pressed: false });
    await region(page, 'Detections').getByRole('row').filter({ has: unchosen }).first().click();
    await parametersWith(page, (params) => params.get('cell') !== cell);
    await page.mouse.move(1, 1);
    await host(page).scrollIntoViewIfNeeded();
    await changes(page, before, 'what the table chooses has the ring');
    // A drag turns and chooses nothing.
    const now = parameters(page).get('cell');
    const box = await host(page).boundingBox();
    const still = await picture(page);
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 120, box.y + box.height / 2 + 20, { steps: 6 });
    await page.mouse.up();
    await changes(page, still, 'a drag turns it');
    assert.equal(parameters(page).get('cell'), now);
  },
);

for (const scheme of ['light', 'dark']) {
  browserTest(`space: it is drawn in colour and saved, ${scheme}`, { path: SIMULATED, scheme }, async ({ page }) => {
    await ready(page);
    assert.deepEqual(await findings(page), []);
    const image = await saved(page, button(space(page), 'PNG'));
    assertPng(image);
    const { saturated, corner, width } = await colours({ page, bytes: image.bytes });
    assert.ok(saturated > 800, `${saturated} pixels of points`);
    assert.deepEqual(corner, scheme === 'light' ? [255, 255, 255] : [25, 29, 33]);
    const box = await host(page).boundingBox();
    assert.ok(Math.abs(width - 2 * box.width) < 8, `${width} pixels of ${box.width}`);
    for (const by of ['power', 'height', 'rate']) {
      await space(page).getByRole('combobox', { name: 'Colour' }).selectOption(by);
      await page.waitForSelector(`[data-legend="${by}"]`);
    }
  });
}

browserTest('space: frames play in it', { path: SIMULATED }, async ({ page }) => {
  await ready(page);
  const first = await picture(page);
  await button(frames(page), 'Play').click();
  await parametersWith(page, (params) => Number(params.get('frame')) > 1);
  await button(frames(page), 'Pause').click();
  // It may have come to stand on the first frame again: on to the last.
  await frameSlider(page).focus();
  await page.keyboard.press('End');
  const head = space(page).locator('.panel-head');
  await head.filter({ hasNotText: 'Frame 1 of' }).waitFor();
  await changes(page, first, 'points move');
  assert.equal(await space(page).getAttribute('data-state'), 'ready');
});

browserTest(
  'space: a finger turns it and taps a point',
  { path: SIMULATED, viewport: 'phone' },
  async ({ page, context }) => {
    await ready(page);
    await host(page).scrollIntoViewIfNeeded();
    const before = await picture(page);
    const box = await host(page).boundingBox();
    assert.ok(box.width <= 390 && box.x >= 0, 'it fits the phone');
    const cdp = await context.newCDPSession(page);
    const touch = (type, x) =>
      cdp.send('Input.dispatchTouchEvent', {
        type,
        touchPoints: type === 'touchEnd' ? [] : [{ x: box.x + x, y: box.y + box.height / 2 }],
      });
    await touch('touchStart', 100);
    for (let x = 110; x <= 220; x += 10) await touch('touchMove', x);
    await touch('touchEnd', 220);
    await changes(page, before);
    const at = await findPoint(page);
    await page.touchscreen.tap(at.x, at.y);
    await parametersWith(page, (params) => params.has('cell'));
  },
);

browserTest(
  'space: without WebGL it says so, and the view from above stays',
  {
    path: SIMULATED,
    before: `const give = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith('webgl') ? null : give.call(this, kind, ...rest);
      };`,
  },
  async ({ page }) => {
    await page.waitForSelector('[data-space-problem="no-webgl"]');
    assert.match(await page.locator('[data-space-problem]').innerText(), /no WebGL 2/);
    await button(page, 'From above').click();
    await fromAbove(page).waitFor();
    assert.match(await fromAbove(page).locator('.alternative').textContent(), /^\d+ detections/);
  },
);

browserTest('space: graphics that are lost are said to be, and come back', { path: SIMULATED }, async ({ page }) => {
  await ready(page);
  const lose = (what) =>
    page.evaluate((call) => {
      const context = document.querySelector('[data-space="points"] .space-canvas canvas').getContext('webgl2');
      globalThis.losing ??= context.getExtension('WEBGL_lose_context');
      globalThis.losing[call]();
    }, what);
  let before = await picture(page);
  for (let last = null; !last?.equals(before); ) [last, before] = [before, await picture(page)];
  await lose('loseContext');
  await page.waitForSelector('[data-space-problem="lost"]');
  await lose('restoreContext');
  await ready(page);
  await looks(page, before);
  await lose('loseContext');
  await page.waitForSelector('[data-space-problem="lost"]');
  await button(space(page), 'Try again').click();
  await ready(page);
});

browserTest(
  'space: opened more than twenty times it holds no more than once',
  { path: SIMULATED },
  async ({ page }) => {
    const warnings = [];
    page.on('console', (message) => warnings.push(message.text()));
    await ready(page);
    const heap = async () => {
      const cdp = await page.context().newCDPSession(page);
      for (let i = 0; i < 2; i++) await cdp.send('HeapProfiler.collectGarbage');
      const { nodes, jsEventListeners } = await cdp.send('Memory.getDOMCounters');
      await cdp.detach();
      return { nodes, jsEventListeners };
    };
    const again = async () => {
      await button(page, 'From above').click();
      await fromAbove(page).waitFor();
      await button(page, '3-D').click();
      await ready(page);
    };
    for (let i = 0; i < 8; i++) await again();
    const before = await heap();
    for (let i = 0; i < 14; i++) await again();
    let after = await heap();
    // What is to be collected may take another round.
    for (let i = 0; i < 40 && after.jsEventListeners > before.jsEventListeners; i++) {
      await twoFrames(page);
      after = await heap();
    }
    assert.equal(await page.locator('.space-canvas canvas').count(), 2, 'the view, and its labels');
    assert.ok(after.nodes <= before.nodes * 1.05 + 20, `${before.nodes} to ${after.nodes} nodes`);
    assert.ok(
      after.jsEventListeners <= before.jsEventListeners * 1.05 + 10,
      `${before.jsEventListeners} to ${after.jsEventListeners} listeners`,
    );
    assert.deepEqual(
      warnings.filter((text) => /too many active|context lost/i.test(text)),
      [],
    );
  },
);

browserTest(
  'space: a board’s own points stand in it too',
  { path: '#/live?source=board&play=bundled&points=space' },
  async ({ page }) => {
    await ready(page, 'board-points');
    const words = page.locator('#board-points-words');
    await words.filter({ hasText: /\d/ }).waitFor({ state: 'attached' });
    assert.match(await words.textContent(), /^(\d+ detections|No detections)/);
  },
);

browserTest(
  'space: the view is a file of its own, as large as its button says',
  { path: SIMULATED.replace('space', 'above') },
  async ({ page }) => {
    const folder = join(root, 'web', 'app', 'dist', 'assets');
    const holds = readdirSync(folder).filter(
      (name) => name.endsWith('.js') && readFileSync(join(folder, name), 'utf8').includes('WebGLRenderer'),
    );
    assert.equal(holds.length, 1, `three.js is in ${holds}`);
    const bytes = brotliCompressSync(readFileSync(join(folder, holds[0]))).length;
    const said = Number.parseInt((await button(page, '3-D').getAttribute('title')).match(/\d+(?= KB)/)[0], 10);
    assert.ok(bytes > 800 * said && bytes < 1050 * said, `${bytes} bytes, said to be ${said} KB`);
  },
);
