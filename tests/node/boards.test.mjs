/** Bytes of each kind of board, simulated, and the order of I and Q. */
import assert from 'node:assert/strict';
import { before, describe, test } from 'node:test';
import { Capture, init, joinCascade, parseConfig } from 'boresight';
import { createPool } from 'boresight/worker';
import { cascadeFiles, configOf, fourLane, framesOf, indexOf, ROW, twoLane } from '../lib/boards.mjs';
import { throwsTyped } from './lib/assert.mjs';
import { assertTargets, bin, cfg } from './lib/recording.mjs';

before(() => init());

/** Finds the one target, and nothing else beyond the coupling, which reaches into the last bins from below. */
function assertOne(capture) {
  const { detections } = capture.processFrame(1, { region: { rangeM: [1, 12] } });
  assert.equal(detections.length, 1, JSON.stringify(detections));
  assert.ok(Math.abs(detections[0].rangeM - 2.5) < 0.03, `${detections[0].rangeM} m`);
  assert.ok(Math.abs(detections[0].azimuthDeg + 20) < 0.5, `${detections[0].azimuthDeg} deg`);
}

describe('simulated bytes', () => {
  for (const [name, lanes, write, layout] of [
    ['two lanes', 2, twoLane, 'two-lane'],
    ['four lanes', 4, fourLane, 'four-lane'],
  ]) {
    for (const real of [false, true]) {
      test(`of ${name}, ${real ? 'real' : 'complex'}`, () => {
        const text = configOf({ lanes, real });
        const { waveform, summary, ...config } = parseConfig(text);
        assert.equal(waveform.sampling, real ? 'real' : 'complex');
        assert.ok(Math.abs(summary.maxRangeM - (real ? 6.5 : 13)) < 0.1);
        assert.equal(config.layout, layout);
        const cube = framesOf(waveform, 'awr1642');
        const capture = new Capture(write(cube, real), text);
        assert.equal(capture.info.frames, 2);
        assert.deepEqual(capture.info.warnings, []);
        assert.equal(capture.info.iqSwapped, real ? null : false);
        const { detections } = capture.processFrame(1, { array: 'awr1642', region: { rangeM: [1, 12] } });
        assert.equal(detections.length, 1);
        assert.ok(Math.abs(detections[0].rangeM - 2.5) < 0.03, `${detections[0].rangeM} m`);
        assert.ok(Math.abs(detections[0].azimuthDeg + 20) < 0.6, `${detections[0].azimuthDeg} deg`);
        capture.free();
      });
    }
  }

  test('of a cascade', async () => {
    const text = configOf({ cascade: true, transmitters: ROW, loops: 4 });
    const { waveform, array, layout, receivers } = parseConfig(text);
    assert.deepEqual([array, layout, receivers], ['cascade86', 'cascade', 16]);
    const files = cascadeFiles(framesOf(waveform, 'cascade86'));
    const indices = files.map((file) => indexOf(file, 2));
    const { bytes, warnings } = joinCascade([...indices, ...files].reverse(), text);
    assert.deepEqual(warnings, []);
    const capture = new Capture(bytes, text);
    assert.equal(capture.info.array.positions.length, 86);
    assertOne(capture);
    capture.free();
    const pool = createPool({ workers: 1 });
    assert.deepEqual((await pool.joinCascade(files, text)).bytes, bytes);
    pool.terminate();

    throwsTyped(() => joinCascade(files.slice(1), text), 'recording-parts', 'the cascade');
    throwsTyped(() => joinCascade([], text), 'recording-parts', 'files of the cascade');
    throwsTyped(() => joinCascade(files, cfg), 'recording-parts', 'the configuration');
    const short = [{ ...files[0], bytes: files[0].bytes.subarray(2) }, ...files.slice(1)];
    throwsTyped(() => joinCascade(short, text), 'recording-parts', "bytes of the chips' files");
    const cut = [...files, { ...indices[0], bytes: indices[0].bytes.subarray(0, 100) }];
    throwsTyped(
      () => joinCascade(cut, text),
      'malformed-file',
      'cascade index at byte 12: number of frames of master_0000_idx.bin',
    );
    const lost = [...files, ...indices.slice(1), indexOf({ ...files[0], bytes: files[0].bytes.subarray(64) }, 2)];
    assert.deepEqual(
      joinCascade(lost, text).warnings.map(({ code }) => code),
      ['cascade-index'],
    );
  });
});

describe('the order of I and Q of the recording', () => {
  const swapped = cfg.toString('utf8').replace('adcbufCfg -1 0 0 1 0', 'adcbufCfg -1 0 1 1 0');
  const codes = ({ info }) => info.warnings.map(({ code }) => code);

  test('is told where the configuration has it wrong', () => {
    const right = new Capture(bin, cfg);
    const wrong = new Capture(bin, swapped);
    assert.deepEqual([right.info.iqSwapped, codes(right)], [false, []]);
    assert.deepEqual([wrong.info.iqSwapped, codes(wrong)], [true, ['iq-swapped']]);
    assert.ok(right.info.beatAsymmetryDb > 20 && wrong.info.beatAsymmetryDb < -20);
    const asked = new Capture(bin, { text: cfg, iqOrder: 'qi' });
    assert.deepEqual([asked.info.config.iqOrder, codes(asked)], ['qi', ['iq-swapped']]);
    const mended = new Capture(bin, { text: swapped, iqOrder: 'iq' });
    assertTargets(mended.processFrame(0).detections);
    for (const one of [right, wrong, asked, mended]) one.free();
  });

  test('is found, and of all frames alike', async () => {
    const auto = { text: swapped, iqOrder: 'auto' };
    const capture = new Capture(bin, auto);
    assert.deepEqual([capture.info.config.iqOrder, codes(capture)], ['iq', ['iq-order-found']]);
    assertTargets(capture.processFrame(0).detections);
    const pool = createPool({ workers: 2 });
    const kept = await pool.loadCapture(bin, auto);
    assert.deepEqual(await kept.processFrame(3), capture.processFrame(3));
    const each = await pool.processFrames(bin, auto);
    assert.deepEqual(each[3], capture.processFrame(3));
    pool.terminate();
    capture.free();
  });

  test('and lanes that do not fit are told', () => {
    const four = new Capture(bin, { text: cfg, lanes: 'four' });
    assert.deepEqual(codes(four), ['other-lanes']);
    four.free();
    throwsTyped(() => new Capture(bin, { text: cfg, lanes: 'three' }), undefined, 'configuration.lanes');
  });
});
