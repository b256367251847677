/** The demo as a client of a server of the Foxglove WebSocket protocol, against the class of the protocol's authors. */
import assert from 'node:assert/strict';
import { createServer } from 'node:net';
import { after, before } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { calibrateDrive } from 'boresight';
import { WebSocketServer } from 'ws';
import { drive, messages, pointCloud } from '../../viewers/messages.mjs';
import { foxgloveServer } from '../../viewers/server.mjs';
import { control } from '../lib/controls.mjs';
import { parameters, parametersWith } from '../lib/demo.mjs';
import { browserTest, skipWithoutBrowser } from '../lib/harness.mjs';
import { typeNumber, typeText } from '../lib/type.mjs';
import { findings } from '../site/axe.mjs';

/** Where the page may connect: sockets of this machine. */
const LOCAL = /^ws:\/\/(127\.0\.0\.1|localhost)[:/]/;
const path = '#/mounting?source=live';
const BORESIGHT = [
  { topic: '/radar/1/detections', schemaName: 'foxglove.PointCloud' },
  { topic: '/car/motion', schemaName: 'boresight.CarMotion' },
  { topic: '/radar/1/transform', schemaName: 'foxglove.FrameTransform' },
  { topic: '/radar/1/mounting', schemaName: 'boresight.MountingAngle' },
  { topic: '/radar/2/mounting', schemaName: 'boresight.MountingAngle' },
];
const ROS = [
  { topic: '/radar/scan', schemaName: 'radar_msgs/msg/RadarScan' },
  { topic: '/odometry', schemaName: 'nav_msgs/msg/Odometry' },
];

let made;
before(async () => {
  if (!skipWithoutBrowser) made = await drive({ durationS: 40 });
});

const opened = [];
const serve = async (...args) => {
  const server = await foxgloveServer(...args);
  opened.push(server);
  return server;
};
after(() => Promise.all(opened.map((server) => server.close().catch(() => {}))));

const address = ({ port }) => `ws://127.0.0.1:${port}`;
const connection = (page, kind) => page.waitForSelector(`[data-connection="${kind}"]`, { state: 'attached' });
const fact = async (page, key) => Number(await page.locator(`[data-fact="${key}"]`).getAttribute('data-value'));
const factIs = (page, key, least) =>
  page.waitForFunction(
    ([name, value]) => Number(document.querySelector(`[data-fact="${name}"]`)?.dataset.value) >= value,
    [key, least],
  );
const history = (page) =>
  page.evaluate(() => {
    const { timeS, angleDeg, sigmaDeg } = document.querySelector('[data-plot="live-angle"]').history;
    return { timeS: Array.from(timeS), angleDeg: Array.from(angleDeg), sigmaDeg: Array.from(sigmaDeg) };
  });

const serverField = (page) => control(page, 'textbox', 'Server');
const placeAhead = (page) => control(page, 'spinbutton', 'Ahead of rear axle');
const nominalAngle = (page) => control(page, 'spinbutton', 'Nominal angle');
const notice = (page, text) => page.locator('[data-notice="live"]').filter({ hasText: text }).waitFor();
/** Waits until a field holds a text by itself. */
const holds = async (page, control, text) =>
  page.waitForFunction(([input, wanted]) => input.value === wanted, [await control.elementHandle(), text]);

/** Waits until something is so on the server's side, which no page tells of. */
async function until(holds, what) {
  for (let tries = 0; tries < 400; tries++) {
    if (holds()) return;
    await setTimeout(25);
  }
  assert.fail(what());
}

/** Types an address and connects by the keyboard. */
async function connectTo(page, given) {
  await typeText(serverField(page), given);
  await control(page, 'button', 'Connect').press('Enter');
}

/** Waits until the page has subscribed to topics. */
const subscribed = (server, ...topics) =>
  until(
    () => topics.every((topic) => server.topics().includes(topic)),
    () => `subscribed to ${server.topics()}`,
  );

/** Takes away what Chromium itself reports of sockets that are refused. */
function expectRefused(problems) {
  const others = problems.filter((problem) => !/console: WebSocket connection to/.test(problem));
  const refused = problems.length - others.length;
  problems.splice(0, problems.length, ...others);
  return refused;
}

const transform = { parent_frame_id: 'car', child_frame_id: 'radar_1', timestamp: { sec: 0, nsec: 0 } };
const PLACED = [
  {
    topic: '/radar/1/transform',
    message: { ...transform, translation: { x: 9, y: 9, z: 0 }, child_frame_id: 'radar_2' },
  },
  { topic: '/radar/1/transform', message: { ...transform, translation: { x: 3.6, y: 0.7, z: 0 } } },
  { topic: '/radar/1/mounting', message: { sensor: 1, nominalDeg: 30 } },
].map((one) => ({ ...one, timeS: 0 }));

browserTest(
  'live server: a drive that is sent is calibrated as Node does, and the angle grows',
  { path, sockets: LOCAL },
  async ({ page, screenshot }) => {
    const server = await serve(BORESIGHT);
    assert.equal(await serverField(page).inputValue(), 'ws://127.0.0.1:8765');
    await page.waitForSelector('[data-verdict="awaited"]');
    await connectTo(page, address(server));
    await connection(page, 'connected');
    await page.getByText('Connected to a car').waitFor();
    await subscribed(server, '/radar/1/detections', '/car/motion', '/radar/1/transform', '/radar/1/mounting');
    assert.ok(!server.topics().includes('/radar/2/mounting'), 'the nominal angle of another radar is not asked for');
    const all = messages(made, 'boresight');
    // A frame's name comes with its first scan.
    server.send(all.filter(({ topic }) => topic === '/radar/1/detections').slice(0, 1));
    await notice(page, 'does not say where the radar is');
    server.send(PLACED);
    await holds(page, placeAhead(page), '3.6');
    await holds(page, nominalAngle(page), '30');
    await server.play(all, { each: 100 });
    await factIs(page, 'scans', made.frames.length - 2);
    const { timeS, angleDeg, sigmaDeg } = await history(page);
    assert.ok(timeS.length > 30 && timeS.every((time, i) => i === 0 || time > timeS[i - 1]));
    const { result } = calibrateDrive(made.drive, { sensor: 1, xM: 3.6, yM: 0.7, nominalDeg: 30 });
    // Clouds hold single precision.
    assert.ok(Math.abs(angleDeg.at(-1) - result.angleDeg) < 0.03, `${angleDeg.at(-1)}, ${result.angleDeg}`);
    assert.ok(Math.abs(angleDeg.at(-1) - made.sensor.yawDeg) < 4 * sigmaDeg.at(-1));
    assert.ok(sigmaDeg.at(-1) < sigmaDeg[3]);
    assert.match(await page.locator('[data-verdict] .head').innerText(), /\+30\.[45]\d° ± 0\.\d\d°/);
    assert.deepEqual([await fact(page, 'malformed'), await fact(page, 'dropped')], [0, 0]);
    assert.ok((await fact(page, 'used')) > 480);
    await page.waitForSelector('[data-plot="live-doppler"] [data-series="recursive"]');
    await page.waitForSelector('[data-plot="live-above"] [data-series="boresight"]');
    assert.deepEqual(await findings(page), []);
    await screenshot('live-server', { fullPage: true });
    // Other pages leave it alone.
    await page.goto(`${page.url().split('#')[0]}#/networks`);
    await page.waitForSelector('[data-card]');
    await page.goBack();
    await page.waitForSelector('[data-plot="live-angle"] canvas');
    assert.equal((await history(page)).timeS.length, timeS.length);
    await connection(page, 'connected');
    // Another drive ends it.
    await control(page, 'combobox', 'Drive').selectOption('delphi');
    await page.waitForFunction(() => !document.querySelector('[data-connection]'));
    await until(
      () => server.sockets.clients.size === 0,
      () => `${server.sockets.clients.size} clients`,
    );
  },
);

browserTest(
  'live server: scans and motion of ROS 2 as CDR, of a driver with other signs',
  { path, sockets: LOCAL },
  async ({ page }) => {
    const server = await serve(ROS);
    await connectTo(page, address(server));
    await subscribed(server, '/radar/scan', '/odometry');
    await typeNumber(placeAhead(page), '3.6');
    await typeNumber(control(page, 'spinbutton', 'Left of centre line'), '0.7');
    await typeNumber(nominalAngle(page), '30');
    await control(page, 'combobox', 'Azimuth positive').selectOption('right');
    await control(page, 'combobox', 'Range rate positive').selectOption('closing');
    await parametersWith(page, (state) => state.get('rangeRateSign') === 'closing' && state.get('nominal') === '30');
    await server.play(messages(made, 'ros', { azimuth: -1, rangeRate: -1 }), { each: 100 });
    await factIs(page, 'scans', made.frames.length - 2);
    const { angleDeg, sigmaDeg } = await history(page);
    assert.ok(Math.abs(angleDeg.at(-1) - made.sensor.yawDeg) < 4 * sigmaDeg.at(-1), `${angleDeg.at(-1)}`);
    assert.ok(angleDeg.length > 30);
    await control(page, 'button', 'Begin anew').click();
    await page.waitForFunction(() => document.querySelector('[data-plot="live-angle"]').history.timeS.length === 0);
  },
);

browserTest(
  'live server: one that dies and comes back is found again, and a drive from its start is a new one',
  { path, sockets: LOCAL },
  async ({ page, problems }) => {
    const all = messages(made, 'boresight');
    const first = await serve(BORESIGHT);
    const { port } = first;
    await connectTo(page, address(first));
    await subscribed(first, '/radar/1/detections', '/car/motion');
    first.send([...all.slice(0, 5), ...PLACED]);
    await holds(page, nominalAngle(page), '30');
    await first.play(all.slice(5, 2000), { each: 100 });
    await factIs(page, 'scans', 200);
    const before = await history(page);
    await first.close();
    await connection(page, 'waiting');
    await notice(page, 'boresight serve DRIVE');
    const second = await serve(BORESIGHT, { port });
    await connection(page, 'connected');
    await subscribed(second, '/radar/1/detections', '/car/motion');
    // It goes on where the drive is by now.
    await second.play(all.slice(2200, 3000), { each: 100 });
    await factIs(page, 'connections', 2);
    await page.waitForFunction(
      (length) => document.querySelector('[data-plot="live-angle"]').history.timeS.length > length + 3,
      before.timeS.length,
    );
    assert.equal((await history(page)).timeS[0], before.timeS[0], 'what was found before is part of it');
    // The same drive from its start.
    await second.play(all.slice(0, 800), { each: 100 });
    await page.waitForFunction(
      (last) => (document.querySelector('[data-plot="live-angle"]').history.timeS.at(-1) ?? 1e9) < last,
      before.timeS.at(-1),
    );
    // The counts follow a quarter of a second behind.
    await page.locator('[data-fact="connections"]').filter({ hasText: '2, 1 times anew' }).waitFor();
    second.drop();
    await connection(page, 'waiting');
    await control(page, 'button', 'Cancel').click();
    await connection(page, 'idle');
    expectRefused(problems);
  },
);

browserTest(
  'live server: wrong addresses, none that answers, and cancel',
  { path, sockets: LOCAL, viewport: 'phone', scheme: 'dark' },
  async ({ page, problems, screenshot }) => {
    await page.getByRole('button', { name: 'Show drive and settings' }).click();
    for (const [text, expected] of [
      ['ws://192.168.1.5:8765', /Only servers of this machine/],
      ['http://127.0.0.1:8765', /address like ws:/],
      ['nonsense', /address like ws:/],
    ]) {
      await typeText(serverField(page), text);
      await page.getByRole('alert').filter({ hasText: expected }).waitFor();
      assert.equal(parameters(page).get('server'), null);
    }
    // Nothing listens there.
    const free = await new Promise((resolve) => {
      const probe = createServer().listen(0, '127.0.0.1', () => {
        const { port } = probe.address();
        probe.close(() => resolve(port));
      });
    });
    await connectTo(page, `ws://localhost:${free}`);
    await connection(page, 'waiting');
    await parametersWith(page, (state) => state.get('server') === `ws://localhost:${free}`);
    await notice(page, `answers at ws://localhost:${free}`);
    await control(page, 'button', 'Cancel').click();
    await connection(page, 'idle');
    await page.locator('[data-notice="live"]').waitFor({ state: 'detached' });
    assert.ok(expectRefused(problems) >= 1);
    // One that takes the connection and speaks no WebSocket.
    const mute = createServer((socket) => socket.on('error', () => {})).listen(0, '127.0.0.1');
    await new Promise((resolve) => mute.once('listening', resolve));
    await connectTo(page, `ws://127.0.0.1:${mute.address().port}`);
    await connection(page, 'connecting');
    await control(page, 'button', 'Cancel').click();
    await connection(page, 'idle');
    mute.close();
    assert.deepEqual(await findings(page), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'it fits a phone');
    await screenshot('live-server-idle');
    expectRefused(problems);
  },
);

browserTest(
  'live server: what a hostile one sends is counted and left out',
  { path, sockets: LOCAL },
  async ({ page, problems }) => {
    const sockets = new WebSocketServer({ host: '127.0.0.1', port: 0, maxPayload: 2 ** 30 });
    await new Promise((resolve) => sockets.once('listening', resolve));
    opened.push({ close: async () => sockets.close() });
    const subscriptions = [];
    const connected = new Promise((resolve) => {
      sockets.on('connection', (socket) => {
        socket.on('message', (data) => {
          const message = JSON.parse(String(data));
          if (message.op === 'subscribe') subscriptions.push(...message.subscriptions);
        });
        resolve(socket);
      });
    });
    await connectTo(page, `ws://127.0.0.1:${sockets.address().port}`);
    const socket = await connected;
    const json = (value) => socket.send(JSON.stringify(value));
    for (const text of [
      '',
      'null',
      '7',
      '[]',
      '{"op":3}',
      '{"op":"advertise"}',
      '{"op":"advertise","channels":7}',
      '{',
      '\u0000',
    ])
      socket.send(text);
    json({
      op: 'advertise',
      channels: [null, 3, {}, { id: 'x' }, { id: 1, topic: 'x'.repeat(1e6), encoding: 'json', schemaName: '' }],
    });
    for (const bytes of [[], [1], [1, 2, 3], [2], [3, 255, 255, 255, 255], [4], [9, 9], Buffer.alloc(20, 255)])
      socket.send(Uint8Array.from(bytes));
    json({ op: 'unadvertise', channelIds: { length: 3 } });
    json({ op: 'serverInfo', name: { toString: 1 }, capabilities: null });
    await connection(page, 'connected');
    const channels = [
      { id: 1, topic: '<img src=x onerror=alert(1)>', encoding: 'json', schemaName: 'foxglove.PointCloud' },
      { id: 2, topic: '/motion', encoding: 'json', schemaName: 'boresight.CarMotion' },
      { id: 3, topic: '/cdr', encoding: 'cdr', schemaName: 'sensor_msgs/msg/PointCloud2' },
    ];
    json({ op: 'advertise', channels });
    json({
      op: 'advertise',
      channels: Array.from({ length: 3000 }, (_, i) => ({ ...channels[2], id: i + 10, encoding: 'x' })),
    });
    /** Waits for the next subscription to a channel. */
    const asked = async (channel, times = 1) => {
      const count = () => subscriptions.filter(({ channelId }) => channelId === channel).length;
      const told = () => `${count()} subscriptions to ${channel}`;
      await until(() => count() >= times, told);
      assert.equal(count(), times, told());
    };
    await asked(2);
    const scans = control(page, 'combobox', 'Scans');
    await scans.selectOption(channels[0].topic);
    await asked(1);
    const idOf = (channel) => subscriptions.findLast(({ channelId }) => channelId === channel).id;
    const send = (channel, bytes) => {
      const header = Buffer.alloc(13);
      header.writeUInt8(1);
      header.writeUInt32LE(idOf(channel), 1);
      socket.send(Buffer.concat([header, Buffer.from(bytes)]));
    };
    await typeNumber(placeAhead(page), '3.6');
    const good = pointCloud(made.frames[0]);
    for (const one of [
      'null',
      '[]',
      '"x"',
      '{',
      '{}',
      '\xff',
      JSON.stringify({ ...good, point_stride: 1e308 }),
      JSON.stringify({ ...good, fields: Array.from({ length: 1e5 }, () => null) }),
      JSON.stringify({ ...good, data: Buffer.alloc(9e6).toString('base64') }),
      JSON.stringify({ ...good, timestamp: { sec: 1e300, nsec: -1 } }),
    ])
      send(1, one);
    // More than a page takes of one message.
    send(1, Buffer.alloc(40 * 2 ** 20));
    for (const one of ['{"speedMps":1}', '{"yawRateDegps":1e999}', 'x']) send(2, one);
    await scans.selectOption('/cdr');
    await asked(3, 2);
    // Lengths of CDR that no bytes are behind.
    for (const bytes of [[], [0, 1, 0, 0], [0, 1, 0, 0, ...Buffer.alloc(60, 255)], Buffer.alloc(5000, 127)])
      send(3, bytes);
    const before = await fact(page, 'malformed');
    for (let i = 0; i < 5000; i++) send(3, [i % 256]);
    await factIs(page, 'malformed', before + 5000);
    await page.getByText(/messages were left out. The last: \/cdr/).waitFor();
    // The page works on: the next good scans and motion are taken.
    await scans.selectOption(channels[0].topic);
    await asked(1, 2);
    for (const { topic, message } of messages(made, 'boresight').slice(0, 2500))
      send(topic === '/car/motion' ? 2 : 1, JSON.stringify(message));
    await page.waitForFunction(() => document.querySelector('[data-plot="live-angle"]')?.history.timeS.length > 10);
    await control(page, 'button', 'Disconnect').click();
    await connection(page, 'idle');
    assert.ok((await history(page)).timeS.length > 10, 'what was found stays');
    expectRefused(problems);
  },
);
