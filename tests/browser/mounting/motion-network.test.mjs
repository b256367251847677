// Motions by DeepEgo's networks on the mounting page: fetched when asked for, one's own from a file.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';
import { parametersWith, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

const weights = join(root, 'models', 'motion', 'deepego.bin');
const cell = (method, field) => `[aria-busy="false"] [data-row="${method}"] [data-field="${field}"]`;
const angle = async (page, method) => (await values(page, cell(method, 'angleDeg')))[0];
const settled = (page, method) => page.waitForSelector(`${cell(method, 'angleDeg')}[data-value]`);

browserTest(
  'a network weighs detections: its weights are fetched once, and may be a file of one’s own',
  { path: '#/mounting?source=simulated&duration=20' },
  async ({ page }) => {
    const asked = [];
    page.on('request', (request) => {
      if (/deepego/.test(request.url())) asked.push(request.url());
    });
    await settled(page, 'recursive');
    await settled(page, 'least-squares');
    assert.deepEqual(asked, []);
    const [truth] = await values(page, '[data-field="truth"]');

    await page.getByLabel('Motion by').selectOption('deepego-plus');
    await page.getByText('A network that was trained on simulated drives').waitFor();
    for (const method of ['recursive', 'weighted-mean', 'least-squares']) {
      await settled(page, method);
      const found = await angle(page, method);
      assert.ok(Math.abs(found - truth) < 0.6, `${method}: ${found}, true ${truth}`);
    }
    assert.equal(asked.length, 1);
    await parametersWith(page, (parameters) => parameters.get('motion') === 'deepego-plus');
    const smoothed = await angle(page, 'least-squares');
    // The frames of a method that smooths stand over what they were before.
    await page.getByLabel('Frames by').selectOption('least-squares');
    const history = page.locator('[data-plot="angle-history"]');
    await history.getByText('grey: before smoothing').waitFor();

    // Of DeepEgo alone: it has nothing to smooth with, which is said beside each method that would smooth.
    const file = page.getByLabel('Weights of a network of motion');
    await file.setInputFiles(weights);
    await page.getByText(/Weights of deepego\.bin/).waitFor();
    await page
      .getByText(/deepego-plus needs the weights of its network/)
      .first()
      .waitFor();
    await settled(page, 'recursive');
    await page.getByLabel('Motion by').selectOption('deepego');
    await settled(page, 'least-squares');
    assert.notEqual(await angle(page, 'least-squares'), smoothed);

    // Damaged.
    const bytes = readFileSync(weights);
    bytes[bytes.length >> 1] ^= 1;
    await file.setInputFiles({ name: 'broken.bin', mimeType: 'application/octet-stream', buffer: bytes });
    await page
      .getByText(/malformed weights/)
      .first()
      .waitFor();
    await page.getByRole('button', { name: 'Use those of the package' }).click();
    await settled(page, 'least-squares');
    assert.equal(asked.length, 1);
    await file.setInputFiles({
      name: 'large.bin',
      mimeType: 'application/octet-stream',
      buffer: Buffer.alloc(17 << 20),
    });
    await page.getByText(/large\.bin: .* are expected/).waitFor();
    await page.getByRole('button', { name: 'Put this message away' }).click();
    await settled(page, 'least-squares');
  },
);
