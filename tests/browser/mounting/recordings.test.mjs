/** Recordings of ROS 2 on the page of mounting angles: dropped, chosen, left on the way, and refused. */
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, truncateSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { RADAR, recordingBytes } from '../../../scripts/lib/recordings.mjs';
import { clickWhenThere, drop, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';

const small = '#/mounting?source=simulated&duration=5&methods=recursive';
const cell = '[aria-busy="false"] [data-row="recursive"] [data-field="angleDeg"]';
const opened = (page, name) => page.getByRole('list', { name: 'Open files' }).getByText(name).waitFor(patient);

browserTest('recordings: one that is dropped opens, and its topics are told', { path: small }, async ({ page }) => {
  await page.waitForSelector('[data-fact="name"]');
  const bytes = await recordingBytes({ seconds: 30, imageBytes: 20_000, compression: 'lz4' });
  await drop(page, [{ name: 'drive.mcap', bytes }]);
  await opened(page, 'drive.mcap');
  await page.waitForSelector(`${cell}[data-value]`);
  const [angle] = await values(page, cell);
  assert.ok(Math.abs(angle - RADAR.offDeg) < 0.1, `${angle} deg`);
  assert.match(await page.locator('[data-facts="counts"]').innerText(), /Detections in the files\s*14.400/);
  const topics = page.locator('[data-topics]');
  await topics.getByText('3 of 4 topics used').press('Enter');
  const told = await topics.locator('[data-topic="/camera/image"]').innerText();
  assert.match(told, /sensor_msgs\/msg\/Image, 300 messages\s+not used\s*; no detections/);
  assert.match(await topics.locator(`[data-topic="${RADAR.topic}"]`).innerText(), /radar 1\s*; in the frame radar/);
});

browserTest(
  'recordings: one larger than a tab holds is chosen, left on the way, and read whole',
  { path: small },
  async ({ page }) => {
    await page.waitForSelector('[data-fact="name"]');
    const folder = mkdtempSync(join(tmpdir(), 'boresight-recording-'));
    try {
      const file = join(folder, 'large.mcap');
      writeFileSync(file, await recordingBytes({ seconds: 30 }));
      // Nothing follows that takes room on the disk.
      truncateSync(file, 2 ** 31);
      const choose = () => page.getByLabel('Drive files').setInputFiles(file);
      await choose();
      const { max } = await clickWhenThere(page, '[data-opening] button');
      assert.equal(max, 1, 'it is told how far it is');
      await page.waitForSelector('[data-interrupted]');
      assert.equal(await page.locator('.files.own').count(), 0);
      await choose();
      await opened(page, 'large.mcap');
      await page.waitForSelector(`${cell}[data-value]`);
      await page.locator('.warnings', { hasText: 'bytes after the end of the file' }).waitFor();
    } finally {
      rmSync(folder, { recursive: true, force: true });
    }
  },
);

browserTest(
  'recordings: what is none is refused by name, and says what is in it',
  { path: small },
  async ({ page }) => {
    await page.waitForSelector('[data-fact="name"]');
    const alert = page.getByRole('alert');
    await drop(page, [{ name: 'notes.mcap', bytes: Buffer.from('these are notes, and no recording') }]);
    await alert.filter({ hasText: /notes\.mcap.*magic bytes.*malformed-file/s }).waitFor();
    const whole = await recordingBytes({ seconds: 1, imageBytes: 1000 });
    // Until the first message all is there but messages.
    const bytes = whole.subarray(0, 700);
    await drop(page, [{ name: 'cut.mcap', bytes }]);
    await alert.filter({ hasText: /cut\.mcap.*no end.*no-drive-log/s }).waitFor();
  },
);
