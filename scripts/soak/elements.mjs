// A dashboard of elements that are fed with live frames.
import { root } from '../lib/paths.mjs';

const SAMPLE_MS = 4000;
/** Noise: bytes of a heap, elements of a page, listeners. */
const LEAST = { 'heap bytes': 3e6, nodes: 50, listeners: 20 };
const IMPORTS = { boresight: '/lib/browser.js', 'boresight/worker': '/worker/browser.js' };

const PAGE = `<!doctype html><title>dashboard</title><link rel="icon" href="data:,">
<script type="importmap">${JSON.stringify({ imports: IMPORTS })}</script>
<style>body { display: grid; grid-template-columns: repeat(3, 1fr); gap: 8px; }</style>
<boresight-spectrum heading="Spectrum"></boresight-spectrum>
<boresight-range-doppler heading="Range and Doppler"></boresight-range-doppler>
<boresight-point-cloud heading="Detections"></boresight-point-cloud>
<boresight-doppler-azimuth heading="Rates"></boresight-doppler-azimuth>
<boresight-mounting-angle heading="Angle" nominal-deg="30"></boresight-mounting-angle>
<script type="module">
  import '/elements/index.js';
  import * as boresight from 'boresight';

  await Promise.all([boresight.init(), boresight.initDrives()]);
  const place = { xM: 3.6, yM: 0.7 };
  const drive = boresight.simulateDrive({ durationS: 30, seed: 1, sensors: [{ id: 1, ...place, yawDeg: 30 }] });
  const motion = boresight.scanMotion(drive);
  const scans = drive.scans.timeS.length;
  const waveform = boresight.waveformPreset('3dcnn-simulated');
  const calibration = new boresight.Calibration({ method: 'recursive', ...place, nominalDeg: 30 });
  const element = (name) => document.querySelector('boresight-' + name);
  let count = 0;
  let timeS = 0;
  /** One frame of each kind, computed anew, as a live source has it. */
  window.step = () => {
    const scene = boresight.simulateSnapshots({ array: 'ula8', targets: [{ azimuthDeg: 30 * Math.sin(count / 20) }], snapshots: 20, snrDb: 15, seed: count });
    const snapshots = { data: scene.data, shape: scene.shape.slice(1) };
    element('spectrum').estimates = [boresight.estimate({ snapshots }, { array: 'ula8', method: 'capon' })];
    const targets = [{ rangeM: 60 + 30 * Math.sin(count / 30), rateMps: 4, azimuthDeg: 5 }];
    const cube = boresight.simulateCube({ waveform, array: 'ula8', targets, snrDb: 10, seed: count });
    element('range-doppler').frame = boresight.processCube(cube, { waveform, array: 'ula8' })[0];
    const scan = boresight.driveFrame(drive, count % scans, motion);
    timeS += 0.05;
    const outcome = calibration.addFrame({ ...scan, timeS });
    element('point-cloud').points = { ...scan, weights: outcome.weights };
    element('point-cloud').mounting = { ...place, yawDeg: 30 };
    const [vxMps, vyMps] = outcome.motion?.velocityMps ?? [0, 0];
    element('doppler-azimuth').frame = { ...scan, weights: outcome.weights, motion: { vxMps, vyMps } };
    element('mounting-angle').add(timeS, calibration.estimate());
    count += 1;
  };
  window.frames = () => count;
  window.live = (hz) => setInterval(window.step, 1000 / hz);
  window.ready = true;
</script>`;

/** Feeds five elements with `hz` frames a second for so long. */
export async function soakElements({ milliseconds, hz = 20, sampleMs = SAMPLE_MS }) {
  const { launch, openPage, serve } = await import('../../tests/browser/lib/session.mjs');
  // The built package is the site.
  const server = await serve(root);
  const browser = await launch();
  const { page, context, problems } = await openPage(browser, server.url, { path: 'about:blank' });
  const series = Object.fromEntries(Object.keys(LEAST).map((name) => [name, []]));
  const counts = { frames: 0, samples: 0 };
  try {
    await page.route('**/dashboard.html', (route) => route.fulfill({ contentType: 'text/html', body: PAGE }));
    await page.goto(`${server.url}dashboard.html`);
    await page.waitForFunction(() => window.ready);
    const devtools = await context.newCDPSession(page);
    await devtools.send('Performance.enable');
    await page.evaluate((rate) => window.live(rate), hz);
    const until = performance.now() + milliseconds;
    while (performance.now() < until && problems.length < 10) {
      await page.waitForTimeout(sampleMs);
      await devtools.send('HeapProfiler.collectGarbage');
      const { metrics } = await devtools.send('Performance.getMetrics');
      const metric = (name) => metrics.find((one) => one.name === name)?.value ?? Number.NaN;
      const row = [metric('JSHeapUsedSize'), metric('Nodes'), metric('JSEventListeners')];
      Object.values(series).forEach((samples, at) => samples.push(row[at]));
      counts.samples += 1;
    }
    counts.frames = await page.evaluate(() => window.frames());
    if (counts.frames < (0.5 * hz * milliseconds) / 1000) problems.push(`only ${counts.frames} frames came`);
    const words = await page.locator('boresight-mounting-angle .alternative').textContent();
    if (!/^After \d+ s: /.test(words)) problems.push(`the angle says: ${words}`);
  } catch (error) {
    problems.push(String(error));
  }
  await browser.close();
  await server.close();
  return { counts, series, least: LEAST, problems };
}
