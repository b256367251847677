import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { before, describe, test } from 'node:test';
import {
  BoardLogStream,
  init,
  initDrives,
  parseBoardLog,
  parseConfig,
  readDetectionsCsv,
  readNpy,
  readSnapshotsCsv,
  recordingParts,
  studioConfig,
  subFrameConfig,
  waveformSummary,
  writeDetectionsCsv,
  writeNpy,
  writeSnapshotsCsv,
} from 'boresight';
import { throwsTyped } from './lib/assert.mjs';

const recording = (name) => readFileSync(new URL(`../../recordings/awr1642/${name}`, import.meta.url));
const cfg = recording('profile.cfg');
const dat = recording('xwr16xx_crw_demo_visualizer_2018_1015v2.dat');

before(() => Promise.all([init(), initDrives()]));

describe('configurations', () => {
  test('give waveform, channels and derived numbers', () => {
    const config = parseConfig(cfg);
    assert.deepEqual(parseConfig(cfg.toString()), config);
    assert.equal(config.array, 'awr1642');
    assert.deepEqual([config.transmitters, config.receivers], [2, 4]);
    assert.equal(config.frameBytes, 16 * 2 * 4 * 256 * 4);
    assert.equal(config.waveform.samples, 256);
    assert.equal(config.waveform.startFrequencyHz, 77e9);
    // c / 2B with B = 60 MHz/us * 256 / 5.209 Msps.
    assert.ok(Math.abs(config.summary.rangeResolutionM - 0.05083) < 1e-4);
    assert.deepEqual(waveformSummary(config.waveform), config.summary);
  });

  test('of advanced frames have sub-frames, one of which is chosen', () => {
    assert.deepEqual([parseConfig(cfg).subFrames, parseConfig(cfg).subFrame], [1, 0]);
    const advanced = cfg
      .toString()
      .replace('dfeDataOutputMode 1', 'dfeDataOutputMode 3')
      .replace(
        /frameCfg .*/,
        'advFrameCfg 2 0 0 1 0\nsubFrameCfg 0 0 0 2 16 0 0 1 1 40\nsubFrameCfg 1 0 2 2 8 0 0 1 1 20',
      )
      .concat('\nchirpCfg 2 3 0 0 0 0 0 3\nbpmCfg 1 1 2 3\n');
    const first = parseConfig(advanced);
    const second = parseConfig(subFrameConfig(advanced, 1));
    assert.deepEqual([first.subFrames, first.subFrame, first.waveform.loops], [2, 0, 16]);
    assert.deepEqual([second.subFrames, second.subFrame, second.waveform.loops], [2, 1, 8]);
    assert.deepEqual([first.waveform.multiplexing, second.waveform.multiplexing], [undefined, 'binary-phase']);
    assert.equal(first.frameBytes, (16 + 8) * 2 * 4 * 256 * 4);
    assert.equal(second.frameBytes, first.frameBytes);
    throwsTyped(() => subFrameConfig(advanced, 2), 'out-of-range', 'sub-frame');
    throwsTyped(() => subFrameConfig(advanced, 0.5), 'out-of-range', 'subFrame');
  });

  test('of mmWave Studio say the same as the .cfg of the same settings', () => {
    const golden = (kind) => readFileSync(new URL(`../golden/mmwave-studio/awr1642.${kind}.json`, import.meta.url));
    const text = studioConfig(golden('mmwave'), golden('setup'));
    const wanted = { ...parseConfig(cfg), platform: 'awr1642', sdkVersion: null };
    assert.deepEqual(parseConfig(text), wanted);
    // Without the setup, the board is unknown.
    const unnamed = { ...wanted, platform: null, array: null };
    assert.deepEqual(parseConfig(studioConfig(golden('mmwave'))), unnamed);
    throwsTyped(() => parseConfig(golden('mmwave')), 'config-value', 'the text');
    throwsTyped(() => studioConfig('{}'), 'config-value', 'mmWaveDevices');
    throwsTyped(() => studioConfig(golden('mmwave'), null), 'wrong-type', 'setup');
    throwsTyped(() => studioConfig('no JSON'), 'malformed-json', '.mmwave.json');
  });

  test('files of a recording are put in order by their names', () => {
    assert.deepEqual(recordingParts(['raw_3.bin', 'raw_0.bin']), {
      order: [1, 0],
      cascade: false,
      missing: ['raw_1.bin to raw_2.bin'],
    });
    throwsTyped(() => recordingParts(['left_0.bin', 'right_1.bin']), 'recording-parts', 'files of the recording');
  });

  test('that cannot be say where', () => {
    throwsTyped(() => parseConfig(''), 'config-incomplete', 'configuration');
    throwsTyped(() => parseConfig(cfg.toString().replace('profileCfg 0 77', 'profileCfg 0 NaN')), 'config-value');
    throwsTyped(() => parseConfig(5), 'wrong-type', 'configuration');
    throwsTyped(() => parseConfig(), 'wrong-type', 'configuration');
    const { waveform } = parseConfig(cfg);
    throwsTyped(() => waveformSummary({ ...waveform, samples: 0 }), 'out-of-range', 'samples');
    throwsTyped(() => waveformSummary({ ...waveform, slopeHzPerS: -1 }), 'out-of-range', 'slopeHzPerS');
    throwsTyped(() => waveformSummary({ ...waveform, chirp: 0 }), 'unknown-option', 'waveform.chirp');
    throwsTyped(() => waveformSummary({}), 'missing', 'waveform.startFrequencyHz');
  });
});

describe('board logs', () => {
  test('hold what the board detected', () => {
    const log = parseBoardLog(dat, cfg);
    assert.equal(log.frames.length, 250);
    // The recording ends inside its last packet.
    assert.equal(log.damagedPackets, 1);
    assert.deepEqual(
      log.frames.filter(({ complete }) => !complete),
      log.frames.slice(-1),
    );
    for (const { objects } of log.frames) {
      // The board's first object: x = 283/512 m to the right, y = 1485/512 m ahead.
      const first = objects.find(({ rangeBin }) => rangeBin === 58);
      assert.ok(Math.abs(first.rangeM - Math.hypot(283, 1485) / 512) < 0.01);
      assert.ok(Math.abs(first.azimuthDeg + 10.79) < 0.01, `${first.azimuthDeg}`);
      assert.equal(typeof first.rateMps, 'number');
    }
    assert.ok(parseBoardLog(dat).frames[0].objects.every(({ rateMps }) => rateMps === null));
  });

  test('come piece by piece too', () => {
    const stream = new BoardLogStream(cfg);
    const frames = [];
    for (let at = 0; at < dat.length; at += 1000) frames.push(...stream.push(dat.subarray(at, at + 1000)));
    frames.push(...stream.finish());
    const log = parseBoardLog(dat, cfg);
    assert.deepEqual(frames, log.frames);
    assert.equal(stream.counts().skippedBytes, log.skippedBytes);
    stream.free();
  });

  test('that are damaged are read as far as they go', () => {
    assert.deepEqual(parseBoardLog(new Uint8Array(0)).frames, []);
    const log = parseBoardLog(dat.subarray(3, 20_000));
    assert.ok(log.skippedBytes > 0 && log.frames.length > 0);
    assert.ok(log.warnings.length > 0);
    throwsTyped(() => parseBoardLog('text'), 'wrong-type', 'board log');
    throwsTyped(() => parseBoardLog(dat, 'sensorStart'), 'config-incomplete');
  });
});

describe('npy', () => {
  const arrays = [
    { kind: 'real', data: new Float64Array([1, 2.5, -3, 4, 5, 6]), shape: [2, 3] },
    { kind: 'real', data: new Float32Array([1, 2.5]), shape: [2] },
    { kind: 'complex', data: new Float64Array([1, 2, 3, 4]), shape: [1, 2] },
    { kind: 'complex', data: new Float32Array([1, 2, 3, 4]), shape: [2, 1, 1] },
  ];

  test('reads what it writes', () => {
    for (const array of arrays) assert.deepEqual(readNpy(writeNpy(array)), array);
  });

  test('takes an ArrayBuffer as well', () => {
    const { buffer } = writeNpy(arrays[0]);
    assert.deepEqual(readNpy(buffer), arrays[0]);
  });

  test('refuses what is none', () => {
    const bytes = writeNpy(arrays[0]);
    throwsTyped(() => readNpy(new Uint8Array(0)), 'malformed-file');
    throwsTyped(() => readNpy(bytes.subarray(0, bytes.length - 1)), 'malformed-file');
    throwsTyped(() => readNpy(bytes.map((b, i) => (i === 0 ? 0 : b))), 'malformed-file');
    throwsTyped(() => readNpy([1, 2]), 'wrong-type', 'npy file');
    throwsTyped(() => writeNpy({ ...arrays[0], kind: 'imaginary' }), 'unknown-name', 'array.kind');
    throwsTyped(() => writeNpy({ ...arrays[0], shape: [7] }), 'shape', 'array.data');
    throwsTyped(() => writeNpy({ ...arrays[0], shape: [2 ** 31, 2 ** 31] }), 'shape', 'array.data');
  });
});

describe('tables', () => {
  const detection = {
    frame: 1,
    rangeM: 2.95,
    rateMps: -0.1,
    azimuthDeg: -10.8,
    elevationDeg: 0,
    // Where range and angles put it.
    xM: 2.95 * Math.cos((10.8 * Math.PI) / 180),
    yM: -2.95 * Math.sin((10.8 * Math.PI) / 180),
    zM: 0,
    powerDb: -30.25,
    snrDb: 25,
    rangeBin: 58,
    dopplerBin: 8,
    dopplerFold: -1,
    foldProbability: 0.995,
  };

  test('of detections keep every number', () => {
    const [read] = readDetectionsCsv(writeDetectionsCsv([detection]));
    assert.deepEqual(Object.keys(read), Object.keys(detection));
    for (const [key, value] of Object.entries(detection)) assert.ok(Math.abs(read[key] - value) < 1e-12, key);
    assert.deepEqual(readDetectionsCsv(writeDetectionsCsv([])), []);
  });

  test('of snapshots keep every number', () => {
    const snapshots = { data: new Float64Array([1, 2, 3, 4, 5, 6, 7, 8]), shape: [2, 2] };
    assert.deepEqual(readSnapshotsCsv(writeSnapshotsCsv(snapshots)), snapshots);
  });

  test('that are wrong say where', () => {
    throwsTyped(() => readDetectionsCsv('range_m\n1'), 'malformed-table');
    throwsTyped(() => readSnapshotsCsv('snapshot,element,re,im\n0,0,x,0'), 'malformed-table');
    throwsTyped(() => readSnapshotsCsv(''), 'malformed-table');
    throwsTyped(
      () => writeDetectionsCsv([{ ...detection, rangeM: Number.NaN }]),
      'out-of-range',
      'detections[0].rangeM',
    );
    throwsTyped(() => writeDetectionsCsv({}), 'wrong-type', 'detections');
  });
});
