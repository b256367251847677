/** examples/edge as it stands there: installed, built, and held to what it promises, on Node, workerd and Deno. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openMetrics } from '../../examples/edge/src/metrics.js';
import { root } from '../../scripts/lib/paths.mjs';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch, openPage } from '../browser/lib/session.mjs';
import { consumer, run } from './consumer.mjs';

const timeout = 120_000;

let project;
let edge;
const at = (...path) => join(project.folder, 'edge', ...path);
/** A part of the project's own tests, on a runtime. */
const part = async (name, runtime, options) => {
  const args = [at('tests', 'all.mjs'), '--only', name, '--runtimes', runtime, '--with', JSON.stringify(options)];
  const { stdout } = await project.run(process.execPath, args);
  return JSON.parse(stdout.slice(stdout.indexOf('{')));
};

before(
  async () => {
    project = await consumer({
      from: join(root, 'examples'),
      examples: ['edge'],
      packages: { deno: '~2.9.6' },
    });
    await project.run(process.execPath, [join('node_modules', 'deno', 'install.cjs')]);
    await project.script('edge', 'build');
    edge = await import(at('tests', 'lib', 'service.mjs'));
  },
  { timeout },
);
after(() => project?.remove());

test('its JavaScript has the types that it says', { timeout }, () => project.script('edge', 'check'));

test('its parts work', { timeout }, async () => {
  // Node leaves out tests that a test runs, unless it is not told of them.
  const { NODE_TEST_CONTEXT: _, ...env } = process.env;
  const files = ['unit', 'faults'].map((name) => at('tests', `${name}.test.mjs`));
  const { stdout } = await run(process.execPath, ['--test', '--test-reporter=tap', ...files], { cwd: at('.'), env });
  assert.match(stdout, /^# pass 2\d$/m);
  assert.match(stdout, /^# fail 0$/m);
});

for (const runtime of ['node', 'workerd', 'deno']) {
  test(`${runtime}: kill -9 while a drive is sent changes no digit`, { timeout }, async () => {
    const { frames, killed, repeated } = await part('kill', runtime, { durationS: 20, kills: [4] });
    assert.ok(frames > 200 && killed === 1 && repeated > 0);
  });
}

for (const runtime of ['node', 'workerd']) {
  test(`${runtime}: hostile requests touch no other vehicle`, { timeout }, async () => {
    const { requests, counts } = await part('hostile', runtime, { requests: 320, durationS: 8 });
    assert.equal(requests, 320);
    assert.ok(Object.keys(counts).length > 15);
  });
}

test('node: sockets, bodies, files and processes that misbehave leave the service to others', { timeout }, async () => {
  const { halfOpen, streams, lock, quarantine } = await part('limits', 'node', {});
  assert.ok(halfOpen > 0 && streams > 0 && lock > 0);
  // Newer versions of Node have SQLite, and no files.
  if (!('sqlite' in process.versions)) assert.ok(quarantine > 0);
});

test('it answers as HTTP has it, works out what the package does, and its page shows it', { timeout }, async () => {
  const { Service, TOKENS } = edge;
  const { frames, line, RADAR, reference } = await import(at('tests', 'lib', 'drive.mjs'));
  const service = await new Service('node', { config: { origins: ['https://good.example'] } }).start();
  const json = { 'content-type': 'application/json' };
  try {
    const post = (path, body, more = {}) => service.ask(path, { method: 'POST', body, headers: json, ...more });
    const statusOf = async (answer) => (await answer).status;
    for (const [status, answer] of [
      [401, service.ask('/metrics', { token: null })],
      [401, service.ask('/metrics', { token: `${TOKENS.read}x` })],
      [200, service.ask('/metrics', { token: TOKENS.read })],
      [403, service.ask('/v1/vehicles/x', { method: 'DELETE', token: TOKENS.read })],
      [404, service.ask('/v1/vehicles/x')],
      [404, service.ask('/nothing')],
      [400, service.ask('/v1/vehicles/%E0%A4%A')],
      [405, service.ask('/v1/estimate')],
      [400, post('/v1/estimate', '{')],
      [411, post('/v1/estimate', new Blob(['{}']).stream())],
      [413, post('/v1/estimate', 'x'.repeat((8 << 20) + 1))],
      [415, post('/v1/estimate', '{}', { headers: { 'content-type': 'text/plain' } })],
      [
        422,
        post('/v1/estimate', '{"snapshots":{"data":[1,0],"shape":[1,1]},"options":{"method":"no","array":"ula8"}}'),
      ],
    ]) {
      assert.equal(await statusOf(answer), status);
    }
    assert.equal((await service.ask('/v1/estimate')).headers.get('allow'), 'POST, OPTIONS');
    const head = await service.ask('/metrics', { method: 'HEAD' });
    assert.deepEqual([head.status, head.text], [200, '']);
    for (const [origin, allowed] of [
      ['https://good.example', 'https://good.example'],
      ['https://bad.example', null],
    ]) {
      const { status, headers } = await service.ask('/v1/estimate', {
        method: 'OPTIONS',
        headers: { origin },
        token: null,
      });
      assert.deepEqual([status, headers.get('access-control-allow-origin')], [204, allowed]);
      assert.equal(headers.get('access-control-allow-methods'), allowed && 'POST, OPTIONS');
    }
    const described = (await service.ask('/openapi.json', { token: null })).json;
    assert.ok(described.paths['/v1/vehicles/{vehicle}/frames'].post.requestBody.content['application/x-ndjson']);

    const data = Array.from({ length: 16 }, (_, i) => (i % 2 ? 0 : 1));
    const body = { snapshots: { data, shape: [8, 1] }, options: { method: 'bartlett', array: 'ula8', sources: 1 } };
    const { json: estimated } = await post('/v1/estimate', JSON.stringify(body));
    assert.ok(Math.abs(estimated.sources[0].azimuthDeg) < 0.1, JSON.stringify(estimated.sources));

    const recorded = (name) => readFileSync(join(root, 'recordings', 'awr1642', name));
    const form = new FormData();
    // Two frames of 128 chirps of 4 receivers, each of 256 complex samples, will do.
    form.set(
      'capture',
      new Blob([recorded('xwr16xx_crw_dca_module_2018_1015v2.bin').subarray(0, 2 << 20)]),
      'capture.bin',
    );
    form.set('config', recorded('profile.cfg').toString());
    form.set('options', '{"frame":0}');
    const processed = await service.ask('/v1/capture', { method: 'POST', body: form });
    assert.equal(processed.status, 200, processed.text);
    assert.ok(processed.json.detections.length > 0);

    const all = await frames({ durationS: 20 });
    const listed = all.map((frame) => JSON.parse(line('front', frame)));
    const once = await post(
      '/v1/calibrate',
      JSON.stringify({ options: { method: 'recursive', ...RADAR }, frames: listed }),
    );
    assert.deepEqual(once.json.result, await reference(all));

    await service.put('car "1"', 'front', RADAR);
    await service.frames('car "1"', all.map((frame) => line('front', frame)).join(''));
    const limited = await service.ask('/metrics');
    assert.match(limited.headers.get('content-type'), /^application\/openmetrics-text; version=1\.0\.0/);
    assert.match(limited.text, /^boresight_misaligned\{vehicle="car \\"1\\"",radar="front"\} 0$/m);
    if (!skipWithoutBrowser) await page(service, TOKENS.read);
  } finally {
    await service.stop();
  }
});

/** Signs in by keys, and reads what is there. */
async function page(service, token) {
  const browser = await launch();
  const { page, problems, close } = await openPage(browser, service.url);
  try {
    await page.getByLabel('Token').pressSequentially('wrong');
    await page.keyboard.press('Enter');
    await page.getByText('This token is not one of a tenant.').waitFor();
    await page.getByLabel('Token').pressSequentially(token);
    await page.keyboard.press('Enter');
    await page.getByRole('link', { name: /car "1"/ }).waitFor();
    const { json } = await service.about('car "1"');
    const { angleDeg } = json.radars[0].result;
    const shown = () => document.querySelector('boresight-mounting-angle')?.history.angleDeg.at(-1);
    assert.equal(await (await page.waitForFunction(shown)).jsonValue(), angleDeg);
    await page.getByRole('button', { name: 'Change token' }).press('Enter');
    assert.ok(await page.getByLabel('Token').isVisible());
    // The refused token is in the console, as browsers have it.
    assert.deepEqual(
      problems.filter((problem) => !/401/.test(problem)),
      [],
    );
  } finally {
    await close();
    await browser.close();
  }
}

test('the dashboard asks for metrics that the service has', () => {
  const dashboard = JSON.parse(readFileSync(join(root, 'examples', 'edge', 'grafana', 'dashboard.json'), 'utf8'));
  const families = [...openMetrics([]).matchAll(/^# TYPE (\w+) (\w+)$/gm)];
  const known = new Set(families.map(([, name, type]) => (type === 'counter' ? `${name}_total` : name)));
  const asked = dashboard.panels.flatMap(({ targets }) =>
    targets.flatMap(({ expr }) => expr.match(/boresight_\w+(?=\{)/g)),
  );
  assert.ok(asked.length > 10);
  for (const name of asked) assert.ok(known.has(name), name);
  assert.equal(new Set(dashboard.panels.map(({ id }) => id)).size, dashboard.panels.length);
});
