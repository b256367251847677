// The page Live: a recorded board through fake serial ports, recordings, and raw frames of a bridge.
import assert from 'node:assert/strict';
import { startBridge } from '../../lib/bridge.mjs';
import { fakeSerial, feedRecording } from '../../lib/fake-serial.mjs';
import { button, combobox, region, spinbutton, twoFrames } from '../lib/controls.mjs';
import { drop, parametersWith, recording, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeText } from '../lib/type.mjs';

const dat = recording('xwr16xx_crw_demo_visualizer_2018_1015v2.dat');
const cfg = recording('profile.cfg');

/** Counts as the page shows them. */
const counts = (page) =>
  page
    .locator('[data-facts="live"] [data-fact]')
    .evaluateAll((all) =>
      Object.fromEntries(
        all.map(({ dataset }) => [
          dataset.fact,
          Number.isNaN(Number(dataset.value)) ? dataset.value : Number(dataset.value),
        ]),
      ),
    );
const countIs = (page, fact, value) =>
  page.waitForSelector(`[data-facts="live"] [data-fact="${fact}"][data-value="${value}"]`);
/** The bar of what is live. */
const live = (page) => region(page, 'Live');
const press = (page, name) => button(page, name).click();
const stateIs = (page, state) => page.waitForSelector(`[data-live-state="${state}"]`);

/** Gives a page ports ahead of its own scripts: `ports.command` answers, but to what it refuses, and `ports.data` is fed. */
const withPorts = ({ refuse = '-' } = {}) => `
  ${fakeSerial}
  ${feedRecording}
  {
    const FakePort = fakeSerial();
    const answer = (line) => (line.startsWith('${refuse}') ? 'Error -1' : 'Done');
    globalThis.ports = { command: new FakePort(answer), data: new FakePort(), spare: new FakePort() };
    const asked = Object.values(ports);
    const requestPort = async () => {
      if (asked.length) return asked.shift();
      throw new DOMException('No port selected by the user.', 'NotFoundError');
    };
    Object.defineProperty(navigator, 'serial', { value: { requestPort } });
    globalThis.feed = (base64, { port = 'data', ...options }) =>
      feedRecording(ports[port], Uint8Array.from(atob(base64), (one) => one.charCodeAt(0)), options);
  }
`;
const before = withPorts();

const feed = (page, bytes, options = {}) =>
  page.evaluate(([base64, given]) => globalThis.feed(base64, given), [Buffer.from(bytes).toString('base64'), options]);

async function connected(page) {
  await press(page, 'Command port');
  await page.locator('[data-port="command"]').getByText('USB 0451:bef3').waitFor();
  await press(page, 'Data port');
  await page.locator('[data-port="data"]').getByText('USB 0451:bef3').waitFor();
  await press(page, 'Connect');
}

browserTest('live: a board’s bytes give the counts of its recording', { path: '#/live', before }, async ({ page }) => {
  await connected(page);
  await feed(page, dat);
  await countIs(page, 'bytes', dat.length);
  // The recording ends inside its last packet, which is whole or not only once the port is closed.
  assert.equal((await counts(page)).frames, 249);
  await press(page, 'Disconnect');
  await stateIs(page, 'ended');
  const all = await counts(page);
  assert.deepEqual(
    [all.frames, all.damagedPackets, all.missedFrames, all.skippedBytes, all.framingErrors],
    [250, 1, 0, 248 + 132, 0],
  );
  const told = await page.locator('[data-plot="board-points"] .alternative').textContent();
  assert.match(told, /^[1-9]\d* detections/);
  for (const plot of ['board-points', 'board-profile'])
    await page.locator(`[data-plot="${plot}"] .plot canvas`).first().waitFor();
  const file = await saved(page, button(live(page), 'Save .dat'));
  assert.match(file.name, /^boresight-live-.*\.dat$/);
  assert.deepEqual(file.bytes, dat);
  assert.deepEqual((await saved(page, button(page, 'Save .cfg'))).bytes, cfg);
});

browserTest(
  'live: errors of the line are counted, and cost the packets they are in',
  { path: '#/live', before },
  async ({ page }) => {
    await connected(page);
    const errors = [
      { at: 20_000, name: 'FramingError', lost: 3 },
      { at: 60_000, name: 'FramingError', lost: 1 },
      { at: 90_000, name: 'BreakError' },
      { at: 120_000, name: 'BufferOverrunError', lost: 10 },
    ];
    await feed(page, dat, { errors });
    await countIs(page, 'bytes', dat.length - 14);
    await press(page, 'Disconnect');
    await stateIs(page, 'ended');
    const all = await counts(page);
    assert.deepEqual([all.framingErrors, all.breaks, all.overruns], [2, 1, 1]);
    assert.deepEqual([all.damagedPackets, all.missedFrames], [1 + 3, 3]);
    // The last packet counts as damaged and is shown in part.
    assert.equal(all.frames + all.damagedPackets, 250 + 1);
  },
);

browserTest(
  'live: a board is unplugged, plugged in again, and changed',
  { path: '#/live', before },
  async ({ page }) => {
    await connected(page);
    await feed(page, dat.subarray(0, 50_000));
    await countIs(page, 'bytes', 50_000);
    await page.evaluate(() => ports.data.unplug());
    await stateIs(page, 'lost');
    await page.locator('[data-notice="lost"]').waitFor();
    await page.locator('[data-live]').getByText('The board was unplugged').waitFor({ state: 'attached' });
    await page.evaluate(() => ports.data.plug());
    await stateIs(page, 'open');
    await feed(page, dat.subarray(50_000, 100_000));
    await countIs(page, 'bytes', 100_000);
    // Another port takes over, and nothing was lost on the way.
    await press(page, 'Data port');
    await feed(page, dat.subarray(100_000), { port: 'spare' });
    await countIs(page, 'bytes', dat.length);
    await press(page, 'Disconnect');
    await stateIs(page, 'ended');
    const all = await counts(page);
    assert.deepEqual([all.frames, all.damagedPackets, all.losses], [250, 1, 1]);
    // Whoever is asked for a port may choose none.
    await press(page, 'Data port');
    await twoFrames(page);
    assert.equal(await page.locator('[data-error]').count(), 0);
  },
);

const hasExample = (page) =>
  page.waitForFunction(() => document.querySelector('textarea').value.includes('sensorStart'));

browserTest('live: a configuration is sent line by line', { path: '#/live', before }, async ({ page }) => {
  await connected(page);
  const field = page.getByLabel('Configuration, a command a line');
  await hasExample(page);
  await press(page, 'Send configuration');
  const lines = cfg
    .toString()
    .split(/\r?\n/)
    .filter((line) => line.trim() && !line.startsWith('%'));
  await page.locator(`[data-sent="${lines.length}"]`).waitFor();
  assert.deepEqual(
    await page.evaluate(() => ports.command.written.trim().split('\n')),
    lines.map((line) => line.trim()),
  );
  // What is typed is checked, and what is wrong named with its line.
  await field.press('ControlOrMeta+Home');
  for (const key of 'frameCfg 1 0') await page.keyboard.press(key === ' ' ? 'Space' : key);
  await page.keyboard.press('Enter');
  await page
    .locator('#live-cfg-problem')
    .getByText(/line 1: frameCfg/)
    .waitFor();
});

browserTest(
  'live: a line that a board refuses is shown',
  { path: '#/live', before: withPorts({ refuse: 'chirpCfg' }) },
  async ({ page }) => {
    await connected(page);
    await hasExample(page);
    await press(page, 'Send configuration');
    const told = page.locator('[data-error="command-refused"]');
    await told.waitFor();
    assert.match(await told.textContent(), /line \d+, chirpCfg .* is Error -1; expected Done/);
    assert.match(await page.evaluate(() => ports.command.written), /chirpCfg[^\n]*\n$/);
  },
);

browserTest(
  'live: a recording comes the same way, from the demo, a drop and a link',
  { path: '#/live' },
  async ({ page }) => {
    await press(page, 'Replay the bundled recording');
    await stateIs(page, 'open');
    await page.locator('[data-plot="board-points"]').waitFor();
    await press(live(page), 'Pause');
    await button(live(page), 'Go on').waitFor();
    const detail = () => page.locator('[data-plot="board-points"]').getAttribute('detail');
    const [shown, before] = [await detail(), (await counts(page)).frames];
    await page.waitForFunction(
      (past) => Number(document.querySelector('[data-fact="frames"]').dataset.value) > past,
      before,
    );
    assert.equal(await detail(), shown, 'the picture stays');
    await press(live(page), 'Go on');
    await press(live(page), 'Stop');
    await stateIs(page, 'ended');
    assert.ok((await counts(page)).frames < 250);
    await combobox(page, 'Pace').selectOption('fast');
    await parametersWith(page, (params) => params.get('pace') === 'fast');
    await drop(page, [{ name: 'own.dat', bytes: dat }]);
    await countIs(page, 'frames', 250);
    await stateIs(page, 'ended');
    assert.equal((await counts(page)).damagedPackets, 1);
    await drop(page, [
      { name: 'own.bin', bytes: dat },
      { name: 'own.dat', bytes: dat },
    ]);
    await page.locator('[data-error="unknown-file"]').waitFor();
  },
);

browserTest(
  'live: without serial ports recordings are offered',
  { path: '#/live', before: 'Object.defineProperty(Navigator.prototype, "serial", { value: undefined })' },
  async ({ page }) => {
    await page
      .locator('[data-notice="no-serial"]')
      .getByText(/Chrome, Edge/)
      .waitFor();
    await press(page, 'Bundled recording');
    await page.locator('[data-plot="board-points"]').waitFor();
  },
);

/** A heat map as boards send them: of the raw capture's frame, its cells at zero Doppler as Q and I. */
browserTest(
  'live: maps that a board sends stand where the targets are',
  { path: '#/live?pace=fast' },
  async ({ page }) => {
    const packet = await packetWithMaps();
    await drop(page, [{ name: 'maps.dat', bytes: packet }]);
    const azimuth = page.locator('[data-plot="board-range-azimuth"]');
    await azimuth.waitFor();
    const csv = await azimuth.evaluate((element) => element.csv());
    const rows = csv
      .trim()
      .split('\r\n')
      .slice(1)
      .map((line) => line.split(',').map(Number));
    const strongest = rows.filter(([, range]) => Math.abs(range - 2.95) < 0.06).sort((a, b) => b[2] - a[2])[0];
    assert.ok(Math.abs(strongest[0] + 10.8) < 1.5, `${strongest}`);
    const doppler = await page.locator('[data-plot="board-range-doppler"]').evaluate((element) => element.csv());
    const cells = doppler
      .trim()
      .split('\r\n')
      .slice(1)
      .map((line) => line.split(',').map(Number));
    const top = cells.sort((a, b) => b[2] - a[2])[0];
    assert.deepEqual([Math.abs(top[0] - 2.95) < 0.06, top[1]], [true, 0]);
  },
);

/** A packet of SDK 2 with profile, range-azimuth and range-Doppler maps of the recorded raw capture. */
async function packetWithMaps() {
  const { Capture, init } = await import('boresight');
  await init();
  const capture = new Capture(recording('xwr16xx_crw_dca_module_2018_1015v2.bin'), cfg);
  const view = capture.processFrame(0, { angle: { method: 'bartlett' } });
  const [ranges, rates] = [view.rangeM.length, view.rateMps.length];
  const zero = view.rateMps.indexOf(0);
  const heat = Buffer.alloc(4 * 8 * ranges);
  const word = (db) => Math.round(((db + 150) / 6.0206) * 256 * 8);
  const profile = Buffer.alloc(2 * ranges);
  const map = Buffer.alloc(2 * ranges * rates);
  for (let i = 0; i < ranges; i++) {
    const { data } = capture.cellSnapshots({ rangeBin: i, dopplerBin: zero, frame: 0 });
    for (let k = 0; k < 8; k++) {
      heat.writeInt16LE(Math.round(20_000 * data[2 * k + 1]), 4 * (8 * i + k));
      heat.writeInt16LE(Math.round(20_000 * data[2 * k]), 4 * (8 * i + k) + 2);
    }
    for (let j = 0; j < rates; j++)
      map.writeUInt16LE(word(view.rangeDopplerDb[i * rates + ((j + zero) % rates)]), 2 * (i * rates + j));
    profile.writeUInt16LE(word(view.rangeDopplerDb[i * rates + zero]), 2 * i);
  }
  capture.free();
  const parts = [
    [2, profile],
    [4, heat],
    [5, map],
  ].map(([kind, payload]) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(kind, 0);
    head.writeUInt32LE(payload.length, 4);
    return Buffer.concat([head, payload]);
  });
  const body = Buffer.concat(parts);
  const length = Math.ceil((40 + body.length) / 32) * 32;
  const header = Buffer.alloc(40);
  Buffer.from('0201040306050807', 'hex').copy(header);
  [0x0200_0004, length, 0xa_1642, 1, 0, 0, parts.length, 0].forEach((value, k) =>
    header.writeUInt32LE(value, 8 + 4 * k),
  );
  return Buffer.concat([header, body, Buffer.alloc(length - 40 - body.length)]);
}

/** A page connects to this machine and no other. */
const sockets = /^ws:\/\/127\.0\.0\.1:\d+\/$/;

browserTest(
  'live: raw frames of a bridge give the detections of the recording',
  { path: '#/live?source=raw', sockets, timeout: 240_000 },
  async ({ page }) => {
    const { Capture, init } = await import('boresight');
    await init();
    const capture = new Capture(recording('xwr16xx_crw_dca_module_2018_1015v2.bin'), cfg);
    const running = await startBridge();
    try {
      await typeText(spinbutton(page, 'Port'), String(running.port));
      await press(page, 'Connect');
      const seen = new Set();
      while (seen.size < 3) {
        await page.locator('[data-table="raw-detections"] td').first().waitFor();
        await press(live(page), 'Pause');
        await button(live(page), 'Go on').waitFor();
        const { frame, rows } = await page.locator('[data-table="raw-detections"]').evaluate((table) => ({
          frame: Number(table.dataset.frame),
          rows: [...table.querySelectorAll('tbody tr')].map((row) =>
            [...row.querySelectorAll('td')].map(({ dataset }) => Number(dataset.value)),
          ),
        }));
        const { detections } = capture.processFrame(frame % 8, { angle: { method: 'bartlett' } });
        assert.deepEqual(
          rows,
          detections.map(({ rangeM, rateMps, azimuthDeg, powerDb, snrDb }) => [
            rangeM,
            rateMps,
            azimuthDeg,
            powerDb,
            snrDb,
          ]),
          `frame ${frame}`,
        );
        seen.add(frame);
        await press(live(page), 'Go on');
      }
      assert.ok((await counts(page)).processed >= 3);
    } finally {
      const { code, counts: told } = await running.end();
      assert.equal(code, 0);
      assert.ok(told.frames > 0);
      capture.free();
    }
    // The page says that the bridge ended.
    await page.locator('[data-error="bridge-lost"]').waitFor();
  },
);

browserTest(
  'live: a bridge that is not there is told',
  { path: '#/live?source=raw&bridge=9', sockets },
  async ({ page, problems }) => {
    await press(page, 'Connect');
    await page.locator('[data-error="bridge-not-reached"]').waitFor();
    // The browser itself says so too.
    assert.match(problems.splice(0).join(), /ws:\/\/127\.0\.0\.1:9/);
    // No other machine's may be asked.
    const refused = await page.evaluate(
      () =>
        new Promise((resolve) => {
          addEventListener('securitypolicyviolation', ({ blockedURI }) => resolve(blockedURI));
          new WebSocket('ws://192.0.2.1:8417');
        }),
    );
    assert.match(refused, /192\.0\.2\.1/);
    problems.length = 0;
  },
);
