/** Panels of the extension for Foxglove and Lichtblick, in a host made by the types of both. */
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { calibrateDrive } from 'boresight';
import { root } from '../../scripts/lib/paths.mjs';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch, openPage } from '../browser/lib/session.mjs';
import { near, source } from '../viewers/extension.mjs';
import { drive, messages } from '../viewers/messages.mjs';
import { servePages } from './pages.mjs';
import { LICHTBLICK } from './policies.mjs';

const skip = skipWithoutBrowser;

let browser;
let server;
let made;
let viewer;

before(
  async () => {
    if (skip) return;
    made = await drive({ durationS: 40 });
    const { build } = await import('vite');
    const [{ output }] = await build({
      configFile: false,
      root,
      logLevel: 'warn',
      build: { write: false, lib: { entry: join(root, 'tests/viewers/host.ts'), formats: ['es'], fileName: 'host' } },
    });
    const texts = {
      'host.js': ['text/javascript', output[0].code],
      'extension.js': ['text/plain', source],
      'messages.json': ['application/json', JSON.stringify(messages(made))],
      '': [
        'text/html',
        `<!doctype html><html lang="en"><meta charset="utf-8"><title>host</title>
        <style>body { margin: 0; background: #888; display: grid; grid-template-columns: 1fr 1fr; gap: 8px }
        .panel { height: 380px; overflow: hidden }</style><script type="module" src="host.js"></script></html>`,
        LICHTBLICK,
      ],
    };
    server = await servePages((name) => texts[name]);
    browser = await launch();
  },
  { timeout: 60_000 },
);
after(async () => {
  await browser?.close();
  server?.close();
});

/** A test in a page of the host, with the extension loaded and the messages of a drive at hand. */
function hostTest(name, body) {
  test(name, { skip, timeout: 60_000 }, async () => {
    viewer = await openPage(browser, server.url);
    try {
      await viewer.page.evaluate(async () => {
        globalThis.host.load(await (await fetch('extension.js')).text());
        const time = (timeS) => ({ sec: Math.floor(timeS), nsec: Math.round((timeS % 1) * 1e9) });
        globalThis.events = (await (await fetch('messages.json')).json()).map(({ timeS, ...event }) => ({
          ...event,
          receiveTime: time(timeS),
          sizeInBytes: 0,
        }));
        globalThis.topics = ['/radar/scan', '/odometry'].map((name) => {
          const { schemaName } = globalThis.events.find(({ topic }) => topic === name);
          return { name, schemaName, datatype: schemaName };
        });
        /** Plays messages to panels in frames of the screen. */
        globalThis.play = async (panels, events = globalThis.events, each = 60) => {
          for (let at = 0; at < events.length; at += each)
            await Promise.all(panels.map((panel) => panel.play(events.slice(at, at + each))));
        };
        /** Opens a panel, and waits until the calibration is ready. */
        globalThis.opened = async (name, state, colorScheme = 'light') => {
          const panel = host.open(name, state);
          await panel.render({ topics, colorScheme });
          await ready(panel);
          return panel;
        };
        globalThis.ready = async (panel) => {
          while (panel.element.querySelector('[aria-busy=true]'))
            await new Promise((resolve) => setTimeout(resolve, 10));
        };
        globalThis.says = (panel) => panel.element.querySelector('[role=status]').textContent;
      });
      await body(viewer);
      assert.deepEqual(viewer.problems, []);
    } finally {
      await viewer.close();
    }
  });
}

const PLACE = { xM: 3.6, yM: 0.7, nominalDeg: 30 };

hostTest('the panel of the mounting angle calibrates as Node does', async ({ page, screenshot }) => {
  const found = await page.evaluate(async (place) => {
    const panel = await opened('Mounting angle');
    const first = says(panel);
    for (const [label, value] of [
      ['Ahead of rear axle (m)', place.xM],
      ['Left of centre line (m)', place.yM],
      ['Nominal angle (°)', place.nominalDeg],
    ])
      panel.edit(label, value);
    const wanted = panel.subscriptions;
    await play([panel]);
    // Live data are drawn once a frame of the screen.
    await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
    const element = panel.element.querySelector('boresight-mounting-angle');
    const { timeS, angleDeg, sigmaDeg } = element.history;
    return {
      first,
      wanted,
      state: panel.state,
      times: Array.from(timeS),
      angles: Array.from(angleDeg),
      sigmas: Array.from(sigmaDeg),
      alarm: element.alarm,
      status: says(panel),
    };
  }, PLACE);
  assert.match(found.first, /how far it is ahead/);
  assert.deepEqual(found.wanted, [{ topic: '/radar/scan' }, { topic: '/odometry' }]);
  assert.deepEqual({ ...found.state, ...PLACE }, found.state, 'the place is kept with the layout');
  const { result, history } = calibrateDrive(made.drive, { sensor: 1, ...PLACE });
  // Angles go through radians and back.
  const at = found.times.length - 1;
  const same = history.timeS.findLastIndex((timeS) => timeS <= found.times[at]);
  near(found.times[at], history.timeS[same], 1.2);
  near(found.angles[at], result.angleDeg, 0.02);
  near(found.angles[at], made.sensor.yawDeg, 4 * found.sigmas[at]);
  assert.equal(found.alarm, 'pass');
  assert.match(found.status, /536 scans, 52\d used/);
  await screenshot('foxglove-mounting');
});

hostTest('settings, a turn of the data, and what is kept', async ({ page }) => {
  const found = await page.evaluate(async (place) => {
    const panel = await opened(
      'Mounting angle',
      { ...place, azimuth: 'left', toleranceDeg: 'many', unknown: 1 },
      'dark',
    );
    await play([panel], events.slice(0, 1500));
    const element = () => panel.element.querySelector('boresight-mounting-angle');
    const before = element().history.timeS.length;
    const theme = element().getAttribute('theme');
    panel.edit('Azimuth is positive', 'right');
    const turned = element().history.timeS.length;
    const state = panel.state;
    await play([panel], events.slice(1500, 3000));
    const after = element().history.timeS.length;
    await panel.play([], { didSeek: true });
    const sought = element().history.timeS.length;
    await play([panel], events.slice(0, 800));
    const again = { length: element().history.timeS.length, first: element().history.timeS[0] };
    const bad = panel.edit('Ahead of rear axle (m)', 1e6);
    const subscribed = panel.subscribed;
    await panel.render({ topics: [...topics] });
    panel.act({ action: 'perform-node-action', payload: { id: 'again', path: ['topics'] } });
    panel.act({ action: 'something-new', payload: { path: [] } });
    return {
      before,
      turned,
      after,
      sought,
      again,
      theme,
      state,
      bad,
      kept: panel.state,
      anew: element().history.timeS.length,
      resubscribed: panel.subscribed - subscribed,
      tolerance: element().getAttribute('tolerance-deg'),
    };
  }, PLACE);
  assert.ok(found.before > 5 && found.after > 5 && found.again.length > 3, JSON.stringify(found));
  assert.deepEqual([found.turned, found.sought, found.anew, found.resubscribed], [0, 0, 0, 0]);
  assert.equal(found.theme, 'dark');
  assert.equal(found.state.azimuth, 'right');
  assert.equal(found.tolerance, '1', 'what a layout has that cannot be read falls back');
  assert.equal(found.kept.xM, 3.6, 'a place outside the range is no place');
});

hostTest('a whole recording is read at once, and again where it changes', async ({ page }) => {
  const found = await page.evaluate(async (place) => {
    host.recording = events;
    const panel = await opened('Mounting angle', place);
    const element = panel.element.firstChild.firstChild;
    await play([panel], events.slice(0, 500));
    const played = element.history.timeS.length;
    panel.edit('Calibrates', 'whole');
    const { subscriptions } = panel;
    const read = async () => {
      while (!/That is the whole recording/.test(says(panel))) await new Promise((resolve) => setTimeout(resolve, 20));
      return Array.from(element.history.angleDeg);
    };
    const first = await read();
    await panel.play(events.slice(0, 500), { didSeek: true });
    const sought = element.history.timeS.length;
    const ranges = [...panel.ranges.keys()];
    // A topic begins anew, while it is read and afterwards.
    panel.ranges.get('/odometry')();
    await new Promise((resolve) => setTimeout(resolve, 60));
    const amid = element.history.timeS.length;
    panel.ranges.get('/radar/scan')?.();
    const second = await read();
    panel.edit('Calibrates', 'played');
    const after = [panel.ranges.size, panel.subscriptions.length, element.history.timeS.length];
    panel.edit('Calibrates', 'whole');
    panel.close();
    return { played, subscriptions, first, sought, ranges, amid, second, after, left: panel.ranges.size };
  }, PLACE);
  const { history } = calibrateDrive(made.drive, { sensor: 1, ...PLACE });
  assert.ok(found.played > 2 && found.first.length > 30, JSON.stringify(found));
  near(found.first.at(-1), history.angleDeg.at(-1), 0.02);
  assert.deepEqual(
    [found.subscriptions, found.sought, found.ranges],
    [[], found.first.length, ['/radar/scan', '/odometry']],
  );
  assert.ok(found.amid < found.first.length, `${found.amid}`);
  assert.deepEqual(found.second, found.first);
  assert.deepEqual(found.after.slice(0, 2), [0, 2]);
  assert.equal(found.left, 0);
});

hostTest('transforms say where the radar is, where the settings do not', async ({ page }) => {
  const found = await page.evaluate(async () => {
    const names = ['Mounting angle', 'Detections from above', 'Doppler over azimuth'];
    topics.push({ name: '/tf_static', schemaName: 'tf2_msgs/msg/TFMessage', datatype: '' });
    const panels = [];
    for (const name of names) panels.push(await opened(name, { nominalDeg: 30 }));
    const transform = (parent, child, x, y) => ({
      header: { stamp: { sec: 0, nanosec: 0 }, frame_id: parent },
      child_frame_id: child,
      transform: { translation: { x, y, z: 0.5 }, rotation: { x: 0, y: 0, z: 0, w: 1 } },
    });
    const transforms = [
      transform('base_link', 'radar_2', 1, 1),
      transform('sensor_kit', 'radar_1', 0.2, 0.1),
      transform('base_link', 'radar_1', 1e9, 0),
    ];
    const tell = (list) => ({
      ...events[0],
      topic: '/tf_static',
      schemaName: 'tf2_msgs/msg/TFMessage',
      message: { transforms: list },
    });
    await play(panels, [tell(transforms), ...events.slice(0, 300)]);
    const before = says(panels[0]);
    await play(panels, [tell([transform('base_link', 'radar_1', 3.6, 0.7), null, 7]), ...events.slice(300, 1500)]);
    const element = (panel) => panel.element.firstChild.firstChild;
    return {
      subscribed: panels.map(({ subscriptions }) => subscriptions.map(({ topic }) => topic)),
      before,
      angles: element(panels[0]).history.timeS.length,
      mounting: element(panels[1]).mounting,
      curves: element(panels[2]).motions.map(({ id }) => id),
    };
  });
  assert.deepEqual(found.subscribed, Array(3).fill(['/radar/scan', '/odometry', '/tf_static']));
  assert.match(found.before, /No transform says where the radar is/);
  assert.ok(found.angles > 5, `${found.angles} angles`);
  assert.deepEqual(found.mounting, { xM: 3.6, yM: 0.7, yawDeg: 30 });
  assert.deepEqual(found.curves, ['scan', 'car']);
});

hostTest('the panels of a scan show it, with what stands', async ({ page, screenshot }) => {
  const found = await page.evaluate(async (place) => {
    const panels = [];
    for (const name of ['Doppler over azimuth', 'Detections from above']) panels.push(await opened(name, place));
    await play(panels, events.slice(1000, 2000));
    const [doppler, above] = panels.map((panel) => panel.element.firstChild.firstChild);
    const { frame, motions } = doppler;
    globalThis.panels = panels;
    return {
      azimuths: Array.from(frame.azimuthDeg),
      rates: Array.from(frame.rangeRateMps),
      weights: Array.from(frame.weights),
      motions: motions.map(({ id, motion }) => [id, motion]),
      range: Array.from(above.points.rangeM),
      mounting: above.mounting,
      status: panels.map(says),
    };
  }, PLACE);
  const last = messages(made)
    .slice(0, 2000)
    .findLast(({ topic }) => topic === '/radar/scan');
  const shown = made.frames.find(({ timeS }) => timeS === last.timeS);
  assert.equal(found.azimuths.length, shown.azimuthDeg.length);
  near(found.azimuths[0], shown.azimuthDeg[0], 1e-4);
  near(found.range[0], shown.rangeM[0], 1e-4);
  assert.deepEqual(found.mounting, { xM: 3.6, yM: 0.7, yawDeg: 30 });
  const [[, scan], [, car]] = found.motions;
  // What the scan says of the radar's motion is what the car carries it with.
  near(scan.vxMps, car.vxMps, 0.6);
  near(scan.vyMps, car.vyMps, 0.6);
  const standing = found.azimuths.filter((azimuth, i) => {
    const rate = -(scan.vxMps * Math.cos((azimuth * Math.PI) / 180) + scan.vyMps * Math.sin((azimuth * Math.PI) / 180));
    return found.weights[i] > 0.5 && Math.abs(found.rates[i] - rate) < 0.4;
  });
  assert.ok(standing.length >= 5 && standing.length === found.weights.filter((weight) => weight > 0.5).length);
  assert.match(found.status[0], /\d+ detections, \d+ taken as standing/);
  await screenshot('foxglove-scan');
  await page.evaluate(async () => {
    for (const panel of panels) await panel.render({ colorScheme: 'dark' });
    panels[0].edit('Shows', 'residuals');
    panels[1].edit('Range (m)', 60);
  });
  await screenshot('foxglove-scan-night');
});

hostTest('scans come as clouds of others, with other signs, and what cannot be read is said', async ({ page }) => {
  const found = await page.evaluate(async () => {
    const panel = host.open('Doppler over azimuth', { azimuth: 'right', rangeRate: 'closing' });
    const element = panel.element.firstChild.firstChild;
    const none = says(panel);
    await ready(panel);
    const receiveTime = { sec: 5, nsec: 0 };
    await panel.render({
      topics: [
        { name: '/lidar', schemaName: 'foxglove.PointCloud', datatype: '' },
        { name: '/own', schemaName: 'vendor.Radar', datatype: '', convertibleTo: ['foxglove.PointCloud'] },
      ],
    });
    const automatic = panel.subscriptions;
    const cloud = (names, row) => ({
      timestamp: { sec: 5, nsec: 0 },
      frame_id: 'x',
      point_stride: 4 * names.length,
      fields: names.map((name, i) => ({ name, offset: 4 * i, type: 7 })),
      data: new Uint8Array(Float32Array.from(row).buffer),
    });
    const event = (topic, schemaName, message) => ({ topic, schemaName, message, receiveTime, sizeInBytes: 0 });
    const takes = async (message) => {
      await panel.play([event('/lidar', 'foxglove.PointCloud', message)]);
      return says(panel);
    };
    const lidar = await takes(cloud(['x', 'y', 'z'], [1, 2, 3]));
    const huge = await takes({ ...cloud(['x', 'y', 'vx', 'vy'], [1, 1, 2, 0]), data: new Uint8Array(16 * 70_000) });
    const garbage = [];
    for (const one of [null, 3, {}, { fields: 3 }, { point_stride: -1 }, { ...cloud(['x'], [1]), data: '%%%' }])
      garbage.push(await takes(one));
    await takes(cloud(['x', 'y', 'vx', 'vy'], [1, 1, 2, 0]));
    return {
      none,
      automatic,
      lidar,
      huge,
      garbage,
      azimuth: element.frame.azimuthDeg[0],
      rate: element.frame.rangeRateMps[0],
      last: says(panel),
    };
  });
  assert.match(found.none, /no topic of radar scans/);
  assert.deepEqual(found.automatic, [{ topic: '/lidar' }]);
  assert.match(found.lidar, /range rate is expected/);
  assert.match(found.huge, /70000 points/);
  assert.equal(new Set(found.garbage).size > 2, true);
  for (const text of found.garbage) assert.match(text, /left out/);
  near(found.azimuth, -45, 1e-4);
  near(found.rate, -2 * Math.SQRT1_2, 1e-6);
  assert.doesNotMatch(found.last, /left out/);
});

hostTest('a panel that goes leaves nothing behind, however often', async ({ page }) => {
  const left = await page.evaluate(async (place) => {
    const names = [...host.panels.keys()];
    let left = 0;
    for (let round = 0; round < 5; round++) {
      const panels = names.map((name) => host.open(name, place));
      for (const panel of panels) await panel.render({ topics, colorScheme: round % 2 ? 'dark' : 'light' });
      if (round > 1) await play(panels, events.slice(0, 400));
      const last = panels.map((panel) => panel.settings);
      for (const panel of panels) left += panel.close();
      // What the editor still holds of it does nothing.
      for (const { actionHandler } of last)
        actionHandler({ action: 'update', payload: { path: ['radar', 'xM'], input: 'number', value: 1 } });
    }
    return { elements: document.body.children.length, left };
  }, PLACE);
  assert.deepEqual(left, { elements: 0, left: 0 });
  assert.equal(page.workers().length, 0);
});
