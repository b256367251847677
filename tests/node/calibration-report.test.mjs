// What driving on would bring, and the report of a calibration: the same here, in a worker and frame by frame.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { after, before, describe, test } from 'node:test';
import { Calibration, calibrateDrive, calibrationReport, driveFrame, init, initDrives, scanMotion } from 'boresight';
import { createPool } from 'boresight/worker';
import { throwsTyped } from './lib/assert.mjs';
import { fourRadars } from './lib/drives.mjs';
import { assertShape } from './lib/interfaces.mjs';

let pool;
let drive;
before(async () => {
  await Promise.all([init(), initDrives()]);
  pool = createPool({ workers: 1 });
  drive = fourRadars();
});
after(() => pool.terminate());

const about = {
  made: '2 January 2026',
  asked: 'by <hand>',
  sources: [{ name: 'a&b.csv', bytes: 12, sha256: 'ab'.repeat(32) }],
};
const verdictOf = (html) => /<span class="verdict [a-z]+">([^<]+)</.exec(html)?.[1];

describe('outlook', () => {
  test('is that of the frames one by one, and null where a method has none', () => {
    const found = calibrateDrive(drive, { sensor: 3, convergedDeg: 0.01 });
    const calibration = new Calibration({ ...found.mounting, method: 'recursive', convergedDeg: 0.01 });
    const motion = scanMotion(drive);
    for (const scan of found.frames.scan) calibration.addFrame(driveFrame(drive, scan, motion));
    assert.deepEqual(calibration.outlook(), found.outlook);
    calibration.free();
    assertShape(found.outlook, 'CalibrationOutlook');
    const { forecasts, sigmaDeg, neededDeg, advice } = found.outlook;
    assert.equal(sigmaDeg, found.result.sigmaDeg);
    assert.ok(neededDeg <= 0.01 && advice.length > 20, JSON.stringify(found.outlook));
    assert.deepEqual(forecasts.map(({ manoeuvre }) => manoeuvre).sort(), [
      'bends',
      'speeds',
      'stop',
      'straight',
      'turns',
    ]);
    assert.equal(calibrateDrive(drive, { sensor: 3, method: 'kabsch' }).outlook, null);
    const kabsch = new Calibration({ method: 'kabsch', xM: 3 });
    assert.equal(kabsch.outlook(), null);
    kabsch.free();
  });

  test('verdicts go with the angle', () => {
    assert.equal(calibrateDrive(drive, { sensor: 3 }).result.alignment, 'misaligned');
    const truth = drive.truth.sensors.find(({ id }) => id === 3).yawDeg;
    const near = (nominalDeg) => calibrateDrive(drive, { sensor: 3, nominalDeg }).result.alignment;
    assert.deepEqual([near(truth), near(truth + 1)], ['aligned', 'undecided']);
  });
});

describe('calibrationReport', () => {
  test('says verdict, angle and sources, and reads nothing as HTML', async () => {
    const html = calibrationReport(drive, about, { sensor: 3 });
    const { result } = calibrateDrive(drive, { sensor: 3 });
    assert.equal(verdictOf(html), 'Fail: misaligned');
    assert.ok(html.includes(`${result.angleDeg.toFixed(3)} ± ${result.sigmaDeg.toFixed(3)} deg`), html);
    assert.ok(html.includes('a&amp;b.csv') && html.includes('by &lt;hand&gt;') && html.includes('ab'.repeat(32)));
    assert.doesNotMatch(html, /<script|src=|href=|NaN/);
    assert.equal(await pool.calibrationReport(drive, about, { sensor: 3 }), html);
  });

  test('has a policy that allows its own style and nothing else', () => {
    const html = calibrationReport(drive, about, { sensor: 3 });
    const [, style] = /<style>([^<]*)<\/style>/.exec(html);
    const digest = createHash('sha256').update(style).digest('base64');
    const policy = `default-src 'none'; style-src 'sha256-${digest}'; base-uri 'none'; form-action 'none'`;
    assert.ok(html.includes(`<meta http-equiv="Content-Security-Policy" content="${policy}">`), policy);
    assert.doesNotMatch(html, / style=| on\w+=/);
  });

  test('has a section for each of several radars', () => {
    const html = calibrationReport(drive, undefined, { sensors: [2, 3] });
    assert.deepEqual(html.match(/<h2>Radar \d/g), ['<h2>Radar 2', '<h2>Radar 3']);
    assert.match(html, /with all radars of the car/);
  });

  test('is refused and stopped like a calibration', async () => {
    throwsTyped(() => calibrationReport(drive, about, { sensor: 9 }), 'out-of-range', 'sensor');
    throwsTyped(() => calibrationReport(drive, { sources: [{ name: 5 }] }, { sensor: 3 }), 'wrong-type');
    throwsTyped(() => calibrationReport(drive, { when: 'now' }, { sensor: 3 }), 'unknown-option');
    throwsTyped(() => calibrationReport(drive, about, { sensor: 3 }, () => false), 'cancelled');
    await assert.rejects(pool.calibrationReport(drive, about, { sensor: 3 }, { signal: AbortSignal.abort() }), {
      name: 'AbortError',
    });
    const steps = [];
    await pool.calibrationReport(
      drive,
      about,
      { sensor: 3 },
      { onProgress: (done, total) => steps.push([done, total]) },
    );
    assert.ok(steps.length > 1 && steps.at(-1)[0] === steps.at(-1)[1], JSON.stringify(steps));
  });
});
