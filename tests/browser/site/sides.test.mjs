/** What is left of the radar or the car is at the left of every plot, and arrows move to the side they point to. */
import assert from 'node:assert/strict';
import { twoFrames } from '../lib/controls.mjs';
import { browserTest } from '../lib/harness.mjs';

const PLOTS = [
  { path: '#/angle', plot: 'spectrum', axis: 'Azimuth' },
  { path: '#/angle', plot: 'pattern', axis: 'Azimuth' },
  { path: '#/angle', plot: 'elements', axis: 'y' },
  { path: '#/capture', plot: 'cell-spectrum', axis: 'Azimuth' },
  { path: '#/mounting?source=simulated&duration=10&methods=weighted-mean', plot: 'doppler-azimuth', axis: 'Azimuth' },
  { path: '#/mounting?source=simulated&duration=10&methods=weighted-mean', plot: 'birds-eye', axis: 'left' },
  { path: '#/birdseye?methods=bartlett', plot: 'image-bartlett', axis: 'y' },
];

for (const path of new Set(PLOTS.map((one) => one.path))) {
  browserTest(`left is left: ${path}`, { path }, async ({ page }) => {
    for (const { plot, axis } of PLOTS.filter((one) => one.path === path)) {
      const frame = page.locator(`[data-plot="${plot}"]`);
      await frame.locator('.u-over').waitFor();
      await frame.scrollIntoViewIfNeeded();
      const { width, height } = await frame.locator('.u-over').boundingBox();
      const at = async (share) => {
        await frame.locator('.u-over').hover({ position: { x: width * share, y: height * 0.6 } });
        await twoFrames(page);
        const text = await frame.locator('.readout').innerText();
        return Number(new RegExp(`\\b${axis} ([+−]?[\\d.]+)`, 'i').exec(text)?.[1].replace('−', '-'));
      };
      const [left, right] = [await at(0.1), await at(0.9)];
      assert.ok(left > right, `${plot}: ${left} at the left, ${right} at the right`);
    }
  });
}

browserTest(
  'left is left: arrows move the cursor and a target to their side',
  { path: '#/angle' },
  async ({ page }) => {
    const plot = page.getByRole('figure', { name: 'Angle spectrum' });
    const host = plot.getByRole('application');
    const readout = async () => {
      await twoFrames(page);
      const [, azimuth] = /Azimuth ([+−]?[\d.]+)/.exec(await plot.locator('.readout').innerText());
      return Number(azimuth.replace('−', '-'));
    };
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await host.press('ArrowLeft');
    const first = await readout();
    await host.press('Shift+ArrowLeft');
    assert.ok((await readout()) > first);
    const target = plot.getByRole('button', { name: 'Target 1: azimuth' });
    const { x } = await target.boundingBox();
    await target.press('Shift+ArrowLeft');
    await page.waitForFunction(
      (before) => within('[data-plot="spectrum"]', '.plot-handle').getBoundingClientRect().x < before,
      x,
    );
  },
);
