/** Files that are something else, files on the wrong page, and links to files and settings that are not there. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { frameSlider, opened, ready } from '../capture/page.mjs';
import { button, combobox, figure, spinbutton } from '../lib/controls.mjs';
import { drop, parameters, parametersWith, recording, recordings, reload } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');
const notice = (page, name) => page.locator(`[data-notice="${name}"]`);
async function putAway(page, name) {
  await button(notice(page, name), 'Put this message away').click();
  await notice(page, name).waitFor({ state: 'detached' });
}
const doubts = (page) => page.locator('[data-doubt]').evaluateAll((lines) => lines.map(({ dataset }) => dataset.doubt));

/** Bytes without a pattern, always the same (xorshift). */
function noise(length) {
  const bytes = Buffer.alloc(length);
  let state = 2463534242;
  for (let i = 0; i + 4 <= length; i += 4) {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    bytes.writeInt32LE(state | 0, i);
  }
  return bytes;
}

function louder(samples, times) {
  const bytes = Buffer.from(samples);
  for (let i = 0; i < bytes.length; i += 2) {
    bytes.writeInt16LE(Math.min(Math.max(samples.readInt16LE(i) * times, -32768), 32767), i);
  }
  return bytes;
}

browserTest('files: what is no capture is doubted above the plots', { path: '#/capture' }, async ({ page }) => {
  await ready(page);
  assert.deepEqual(await doubts(page), [], 'the bundled capture is not doubted');
  const picture = noise(bin.length);
  picture.write('\x89PNG', 0, 'latin1');
  for (const [name, bytes, expected, says] of [
    ['noise.bin', noise(bin.length), ['like-noise'], /noise alone/],
    ['picture.bin', picture, ['other-file', 'like-noise'], /PNG/],
    ['text.bin', Buffer.alloc(bin.length, 'time_s,azimuth_deg\n0.1,12.5\n'), ['one-sided'], /below zero/],
    ['loud.bin', louder(bin, 200), ['clipped'], /\d\s%/],
    ['cut.bin', bin.subarray(1000), ['trailing-bytes'], /\.cfg/],
  ]) {
    await drop(page, [
      { name, bytes },
      { name: 'mine.cfg', bytes: cfg },
    ]);
    await opened(page, name);
    await page.waitForSelector(`[data-doubt="${expected[0]}"]`);
    assert.deepEqual(await doubts(page), expected, name);
    const box = await page.locator('.doubts').boundingBox();
    const plot = await figure(page, 'Range-Doppler map').boundingBox();
    assert.ok(box.y + box.height <= plot.y, 'above the plots');
    assert.match(await page.locator('.doubts').innerText(), says);
  }
  await drop(page, [{ name: 'mine.bin', bytes: bin }]);
  await opened(page, 'mine.bin');
  await page.waitForFunction(() => !document.querySelector('[data-doubt]'));
});

/** The text of the .cfg with other lines. */
const other = (changes) => Buffer.from(changes.reduce((text, [from, to]) => text.replace(from, to), String(cfg)));

/** Samples by the same .cfg: of targets that all move, at the same power, and of nothing that stands. */
function moving() {
  const bytes = Buffer.alloc(bin.length);
  const targets = [0.1, 1.3, 2.6, -2].map((turn, i) => ({ turn, beat: 2 * Math.PI * (0.05 + 0.08 * i), angle: i - 1 }));
  let at = 0;
  for (let chirp = 0; chirp < 8 * 32; chirp++) {
    for (let receiver = 0; receiver < 4; receiver++) {
      for (let sample = 0; sample < 256; sample += 2) {
        for (const part of [Math.cos, Math.sin]) {
          for (const next of [0, 1]) {
            const phase = ({ turn, beat, angle }) =>
              beat * (sample + next) + angle * (receiver + 4 * (chirp % 2)) + (turn * chirp) / 2;
            const value = targets.reduce((sum, target) => sum + part(phase(target)), 0);
            at = bytes.writeInt16LE(Math.round(1000 * value), at);
          }
        }
      }
    }
  }
  return bytes;
}

browserTest(
  'files: a .cfg of other chirps is doubted though its frames fit the file',
  { path: '#/capture' },
  async ({ page }) => {
    await ready(page);
    // A frame has as many bytes by each of them.
    for (const [name, changes] of [
      [
        'fewer samples',
        [
          ['60 1 256 5209', '60 1 128 5209'],
          ['frameCfg 0 1 16', 'frameCfg 0 1 32'],
        ],
      ],
      [
        'one transmitter',
        [
          ['channelCfg 15 3 0', 'channelCfg 15 1 0'],
          ['frameCfg 0 1 16', 'frameCfg 0 0 32'],
        ],
      ],
      [
        'two receivers',
        [
          ['channelCfg 15 3 0', 'channelCfg 3 3 0'],
          ['frameCfg 0 1 16', 'frameCfg 0 1 32'],
        ],
      ],
    ]) {
      await drop(page, [
        { name: `${name}.bin`, bytes: bin },
        { name: `${name}.cfg`, bytes: other(changes) },
      ]);
      await opened(page, `${name}.cfg`);
      await page.waitForSelector('[data-doubt="loop-length"]');
      assert.deepEqual(await doubts(page), ['loop-length'], name);
      assert.match(await page.locator('.doubts').innerText(), /repeat every 2.?048.*by the \.cfg a loop has 1.?024/s);
      await drop(page, [{ name: 'mine.cfg', bytes: cfg }]);
      await opened(page, 'mine.cfg');
      await page.waitForFunction(() => !document.querySelector('[data-doubt]'));
    }
    await drop(page, [
      { name: 'moving.bin', bytes: moving() },
      { name: 'mine.cfg', bytes: cfg },
    ]);
    await opened(page, 'moving.bin');
    await ready(page);
    assert.deepEqual(await doubts(page), [], 'what moves is not doubted for it');
  },
);

browserTest('files: a link to one’s own capture waits for it', { path: '#/capture' }, async ({ page, context }) => {
  await ready(page);
  const files = [
    { name: 'mine.bin', bytes: bin },
    { name: 'mine.cfg', bytes: cfg },
  ];
  await drop(page, files);
  await opened(page, 'mine.bin');
  await ready(page);
  await frameSlider(page).press('ArrowRight');
  await parametersWith(page, (params) => params.get('source') === 'files' && params.get('frame') !== 'all');
  const { frame } = Object.fromEntries(parameters(page));
  const other = await context.newPage();
  await other.goto(page.url());
  await notice(other, 'files').waitFor();
  // What would be shown in its place would be fetched.
  await other.waitForLoadState('networkidle');
  assert.equal(await other.locator('[data-table="detections"]').count(), 0, 'nothing else is shown in its place');
  await drop(other, files);
  await ready(other);
  assert.equal(parameters(other).get('frame'), frame, 'with the settings of the link');
  assert.equal(await notice(other, 'files').count(), 0);
  await reload(page);
  await button(page, 'open the bundled capture').click();
  await opened(page, 'xwr16xx');
  await parametersWith(page, (params) => (params.get('source') ?? 'bundled') === 'bundled');
});

browserTest('files: dropped on another page they open where they belong', { path: '#/angle' }, async ({ page }) => {
  await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
  await drop(page, [{ name: 'holiday.jpg', bytes: Buffer.from([1, 2, 3]) }]);
  assert.match(await notice(page, 'drop').innerText(), /holiday\.jpg.*\.bin.*\.csv.*\.onnx/s);
  assert.match(page.url(), /#\/angle/);
  await putAway(page, 'drop');
  await drop(page, [
    { name: 'mine.bin', bytes: bin },
    { name: 'mine.cfg', bytes: cfg },
  ]);
  await opened(page, 'mine.bin');
  assert.match(page.url(), /#\/capture/);
  await ready(page);
  const delphi = recordings('delphi');
  await drop(
    page,
    ['front_radar.csv.gz', 'pose_10hz.csv.gz'].map((name) => ({ name, bytes: readFileSync(join(delphi, name)) })),
  );
  await combobox(page, 'Drive').filter({ hasText: 'own files' }).waitFor();
  await opened(page, 'front_radar.csv.gz');
  assert.match(page.url(), /#\/mounting/);
});

browserTest(
  'files: what a link says that cannot be read is named, and put away',
  { path: '#/angle?snr=abc&colour=red&snapshots=50' },
  async ({ page }) => {
    const text = await notice(page, 'link').innerText();
    assert.match(text, /snr=abc/);
    assert.match(text, /colour=red/);
    assert.doesNotMatch(text, /snapshots/);
    await putAway(page, 'link');
    assert.equal(await spinbutton(page, 'Snapshots').inputValue(), '50');
  },
);
