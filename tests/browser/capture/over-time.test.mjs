/** The range-time waterfall and the micro-Doppler of a capture. */
import assert from 'node:assert/strict';
import { button, cancelOf, figure, plotOf, progress, spinbutton } from '../lib/controls.mjs';
import {
  assertCsv,
  assertPng,
  clickWhenThere,
  drop,
  parameters,
  parametersWith,
  recording,
  reload,
  saved,
} from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { leave, typeNumber } from '../lib/type.mjs';
import { captionOf, frameSays, frameSlider, frames, opened } from './page.mjs';

const path = '#/capture';
const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');
const FRAME_BYTES = 131_072;

const RANGE = 'Range over time';
const RATE = 'Micro-Doppler';
const working = (page) => progress(page, 'Frames over time');
async function whole(page, count) {
  await page.locator(`[data-over-time="${count}"] [data-plot="micro-doppler"]`).waitFor();
  await working(page).waitFor({ state: 'detached' });
}
const save = (page, plot, as) => saved(page, button(figure(page, plot), as));
const csv = async (page, plot, header) =>
  assertCsv(await save(page, plot, 'CSV'), header).map((row) => row.map(Number));
const rangeTime = (page) => csv(page, RANGE, 'frame,time_s,range_m,power_dbfs');
const microDoppler = (page) => csv(page, RATE, 'frame,time_s,rate_mps,power_dbfs');
/** Range or ranges that the micro-Doppler is of. */
const gateOf = (page) => figure(page, RATE).locator('.detail');
const left = (page) => page.locator('[data-over-time-left]');
const close = (given, wanted, tolerance, what) =>
  assert.ok(Math.abs(given - wanted) <= tolerance, `${what}: ${given}, not ${wanted}`);

/** Each frame weaker than the one before: by 6 dB, then by 9.5 and 12 dB of the first. */
function fading(samples) {
  const bytes = Buffer.from(samples);
  for (let i = 0; i < bytes.length; i += 2) {
    const weaker = 1 + (Math.floor(i / FRAME_BYTES) % 4);
    bytes.writeInt16LE(Math.round(samples.readInt16LE(i) / weaker), i);
  }
  return bytes;
}
const FADED_DB = [1, 2, 3, 4].map((weaker) => -20 * Math.log10(weaker));

browserTest('over time: columns are the frames’ own profiles and maps', { path }, async ({ page }) => {
  await whole(page, 8);
  const [overRange, overRate] = [await rangeTime(page), await microDoppler(page)];
  assert.equal(overRange.length, 8 * 256);
  assert.equal(overRate.length, 8 * 16);
  const gate = await gateOf(page).innerText();
  const [from, to] = gate.match(/[\d.]+/g).map(Number);
  assert.ok(from < 2.95 && to > 2.95 && to - from <= 0.5, `around the strongest target: ${gate}`);
  await frameSlider(page).press('ArrowRight');
  for (const frame of [2, 3]) {
    if (frame > 2) await frameSlider(page).press('ArrowRight');
    await captionOf(page, 'Range profile', `Frame ${frame} of`);
    const profile = await csv(page, 'Range profile', 'range_m,power_dbfs,bin_power_dbfs,bin_threshold_dbfs');
    const map = await csv(page, 'Range-Doppler map', 'range_m,rate_mps,power_dbfs');
    const column = overRange.filter(([of]) => of === frame);
    profile.forEach(([range, power], i) => {
      // 40 ms a frame by the .cfg. Powers are kept in single precision.
      close(column[i][1], 0.04 * (frame - 1), 1e-12, 'time');
      assert.equal(column[i][2], range);
      close(column[i][3], power, 1e-4, `power at ${range} m of frame ${frame}`);
    });
    for (const [, , rate, power] of overRate.filter(([of]) => of === frame)) {
      const within = map.filter(([range, at]) => at === rate && range > from - 0.01 && range < to + 0.01);
      assert.ok(within.length > 5);
      const sum = within.reduce((total, [, , level]) => total + 10 ** (level / 10), 0);
      close(power, 10 * Math.log10(sum), 1e-4, `power at ${rate} m/s of frame ${frame}`);
    }
  }
  for (const plot of [RANGE, RATE]) assertPng(await save(page, plot, 'PNG'));
});

browserTest('over time: a click or a key goes to a frame, which is marked', { path }, async ({ page }) => {
  await whole(page, 8);
  const plot = plotOf(page, RANGE);
  const head = plot.locator('.playhead');
  assert.equal(await head.isVisible(), false, 'no frame is marked while all are together');
  const over = plot.locator('.u-over');
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  // Eight columns, half a one beyond the first and the last frame.
  const middle = (frame) => box.width * ((frame - 0.5) / 8);
  await over.click({ position: { x: middle(6), y: box.height / 2 } });
  await parametersWith(page, (params) => params.get('frame') === '5');
  await frameSays(page, 'frame 6 of 8, 200 ms');
  const at = async () => {
    const line = await head.boundingBox();
    return line.x + line.width / 2 - (await over.boundingBox()).x;
  };
  close(await at(), middle(6), 1.5, 'the mark');
  await plot.focus();
  await page.keyboard.press('ArrowRight');
  await parametersWith(page, (params) => params.get('frame') === '6');
  close(await at(), middle(7), 1.5, 'the mark');
  await page.keyboard.press('Shift+ArrowLeft');
  await parametersWith(page, (params) => params.get('frame') === '0');
  await page.keyboard.press(' ');
  await frames(page).getByRole('button', { name: 'Pause', pressed: true }).waitFor();
  await parametersWith(page, (params) => Number(params.get('frame')) > 1);
  await page.keyboard.press(' ');
  await frames(page).getByRole('button', { name: 'Play', pressed: false }).waitFor();
  assert.equal(await working(page).count(), 0);
});

browserTest('over time: the gate is where the cell is, and as wide as typed', { path }, async ({ page }) => {
  await whole(page, 8);
  const gate = gateOf(page);
  const first = await gate.innerText();
  await plotOf(page, RANGE).focus();
  await page.keyboard.press('Shift+ArrowUp');
  await parametersWith(page, (params) => params.has('cell'));
  await gate.filter({ hasNotText: first }).waitFor();
  const bin = Number(parameters(page).get('cell').split(':')[0]);
  const width = spinbutton(page, 'Range gate ±');
  await typeNumber(width, '0');
  await leave(width);
  await gate.filter({ hasText: /^[\d.]+ m$/ }).waitFor();
  const profile = await csv(page, 'Range profile', 'range_m,power_dbfs,bin_power_dbfs,bin_threshold_dbfs');
  close(Number.parseFloat(await gate.innerText()), profile[bin][0], 0.006, 'the gate is the bin of the cell');
  await parametersWith(page, (params) => params.get('gate') === '0');
  await reload(page);
  await whole(page, 8);
  close(Number.parseFloat(await gate.innerText()), profile[bin][0], 0.006, 'the link holds it');
});

browserTest(
  'over time: a long capture shows how far it is, stops, and goes on',
  { path: '#/capture?dopplerPadding=8&frame=2' },
  async ({ page }) => {
    await whole(page, 8);
    const bar = clickWhenThere(page, cancelOf('Frames over time'));
    await drop(page, [
      { name: 'long.bin', bytes: fading(bin), times: 40 },
      { name: 'profile.cfg', bytes: cfg },
    ]);
    const { value, max } = await bar;
    assert.ok(value > 0 && value < max, `${value} of ${max}`);
    const stopped = page.getByText(/^Over time: stopped/);
    const [, done] = (await stopped.innerText()).match(/after (\d+) of 320 frames/);
    assert.ok(Number(done) < 320);
    const part = (await rangeTime(page)).filter(([, , , power]) => power !== 0 && Number.isFinite(power));
    assert.ok(part.length < 320 * 256, 'what was not reached is blank');
    await button(page.getByRole('region', { name: 'Over time' }), 'Go on').click();
    await whole(page, 320);
    assert.equal(await stopped.count(), 0);
    const all = await rangeTime(page);
    assert.equal(all.length, 320 * 256);
    const near = (frame) => all[(frame - 1) * 256 + 58];
    close(near(1)[2], 2.95, 0.03, 'range');
    for (const frame of [1, 2, 3, 4, 159, 320]) {
      close(near(frame)[1], 0.04 * (frame - 1), 1e-9, 'time');
      close(near(frame)[3], near(1)[3] + FADED_DB[(frame - 1) % 4], 0.3, `power of frame ${frame}`);
    }
  },
);

browserTest('over time: frames that fail are counted, named and left blank', { path }, async ({ page }) => {
  await whole(page, 8);
  // One frame asks for another that is not there, as a job that goes wrong in a worker.
  await page.addInitScript(() => {
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, transfer) {
      const { name, args } = message;
      const failing = name === 'processFrame' && args[3]?.maxDetections === 1 && args[0][0] === 77;
      return post.call(this, failing ? { ...message, args: [args[0], args[1], 9, args[3]] } : message, transfer);
    };
  });
  await reload(page);
  const marked = Buffer.from(bin);
  for (let frame = 0; frame < 8; frame++) marked[frame * FRAME_BYTES] = frame === 4 ? 77 : 1;
  await whole(page, 8);
  assert.equal(await left(page).count(), 0);
  await drop(page, [
    { name: 'one-fails.bin', bytes: Buffer.concat([marked, bin.subarray(0, 1000)]) },
    { name: 'profile.cfg', bytes: cfg },
  ]);
  await opened(page, 'one-fails.bin');
  await left(page).waitFor();
  await whole(page, 8);
  const said = await left(page).innerText();
  assert.match(said, /1 of 8 frames could not be processed and are left blank \(frame 5\)/);
  assert.match(said, /cut short, 1.?000 bytes/);
  const blob = await save(page, RANGE, 'CSV');
  const rows = assertCsv(blob, 'frame,time_s,range_m,power_dbfs');
  assert.ok(rows.every(([frame, , , power]) => (power === '') === (frame === '5')));
});

browserTest(
  'over time: of more frames than columns every so many is shown, and said',
  { path: '#/capture?rangePadding=4&frame=0&axes=range' },
  async ({ page }) => {
    await whole(page, 8);
    const long = String(cfg)
      .replace(/profileCfg .*/, 'profileCfg 0 77 40 7 450 0 0 8 1 16384 37500 0 0 30')
      .replace('channelCfg 15 3 0', 'channelCfg 3 1 0')
      .replace(/chirpCfg 1 1.*\n/, '')
      .replace(/frameCfg .*/, 'frameCfg 0 0 2 0 40 1 0');
    await drop(page, [
      { name: 'fine.bin', bytes: bin.subarray(0, 131_072), times: 500 },
      { name: 'fine.cfg', bytes: Buffer.from(long) },
    ]);
    assert.match(await left(page).innerText(), /One frame of 2 is shown: 125 of 250 are left out/);
    const over = plotOf(page, RANGE).locator('.u-over');
    await over.scrollIntoViewIfNeeded();
    const { width, height } = await over.boundingBox();
    await over.click({ position: { x: (width * 100.5) / 125, y: height / 2 } });
    await parametersWith(page, (params) => params.get('frame') === '200');
  },
);
