// The life of the wasm instance: loading, failing to load, trapping, coming back.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import {
  BoresightError,
  Estimator,
  estimate,
  init,
  initDrives,
  initDrivesSync,
  initSync,
  readDrive,
  version,
} from 'boresight';
import glue from '../../dist/wasm/boresight.js';
import drivesGlue from '../../dist/wasm/boresight_drives.js';
import { planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { golden } from './lib/drives.mjs';

const options = { method: 'bartlett', array: 'ula4' };
const input = { snapshots: planeWaves(4, 1, [10]) };
const wasm = new URL('../../dist/wasm/boresight_bg.wasm', import.meta.url);

test('before init() every call says so', () => {
  throwsTyped(() => version(), 'not-initialised');
  throwsTyped(() => new Estimator(options), 'not-initialised');
  throwsTyped(() => initSync(new Uint8Array([0, 97, 115, 109, 9])), 'not-loaded');
});

test('init() can be tried again after a failure', async () => {
  await rejectsTyped(init(Promise.reject(new Error('offline'))), 'not-loaded');
  await rejectsTyped(init(new Uint8Array(8)), 'not-loaded');
  throwsTyped(() => version(), 'not-initialised');
  await Promise.all([init(), init(readFile(wasm)), init()]);
  assert.match(version(), /^\d/);
});

test('init() again changes nothing', async () => {
  const estimator = new Estimator(options);
  await init();
  initSync(await readFile(wasm));
  assert.ok(estimator.estimate(input).sources.length > 0);
  estimator.free();
});

test('after a trap calls say so, and init() gives a fresh instance', async () => {
  const stale = new Estimator(options);
  const { memory } = await glue();
  // Nothing a caller may pass traps, so the memory under the module has to be spoilt.
  new Uint8Array(memory.buffer).fill(0xff);
  throwsTyped(() => estimate(input, options), 'trap');
  throwsTyped(() => version(), 'trap');
  throwsTyped(() => stale.estimate(input), 'trap');
  await Promise.all([init(), init()]);
  assert.ok(estimate(input, options).sources.length > 0);
  throwsTyped(() => stale.estimate(input), 'handle-stale', 'Estimator');
  stale.free();
  throwsTyped(() => stale.free(), 'handle-freed', 'Estimator');
});

test('errors show their parts as JSON', () => {
  const shown = JSON.parse(
    JSON.stringify(new BoresightError('code', 'text', { what: 'a', expected: 'b', given: 'c' })),
  );
  assert.deepEqual(shown, { code: 'code', message: 'text', what: 'a', expected: 'b', given: 'c' });
});

test('the module of drives has a life of its own', async () => {
  const files = [golden('contiguous.h5')];
  throwsTyped(() => readDrive(files), 'not-initialised');
  throwsTyped(() => initDrivesSync(new Uint8Array(8)), 'not-loaded');
  await rejectsTyped(initDrives(Promise.reject(new Error('offline'))), 'not-loaded');
  await Promise.all([initDrives(), initDrives()]);
  const whole = readDrive(files);
  const { memory } = await drivesGlue();
  new Uint8Array(memory.buffer).fill(0xff);
  throwsTyped(() => readDrive(files), 'trap');
  throwsTyped(() => readDrive(files), 'trap');
  assert.ok(estimate(input, options).sources.length > 0);
  await initDrives();
  assert.deepEqual(readDrive(files), whole);
});
