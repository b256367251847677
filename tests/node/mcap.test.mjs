/** Recordings in MCAP: what @mcap/core writes and sees, and what the package sees, whole, in pieces and on a pool. */
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { McapStreamReader } from '@mcap/core';
import { DriveStream, init, initDrives, readDrive } from 'boresight';
import { createPool } from 'boresight/worker';
import { RADAR, recordingBytes } from '../../scripts/lib/recordings.mjs';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';

let bytes;
let pool;
before(async () => {
  await Promise.all([init(), initDrives()]);
  bytes = await recordingBytes({ seconds: 5, imageBytes: 20_000, chunkSize: 60_000 });
  pool = createPool({ workers: 2 });
});
after(() => pool.terminate());

const file = (bytes, name = 'drive.mcap') => ({ name, bytes: new Uint8Array(bytes) });

/** What @mcap/core sees: messages of each topic, and the returns of each scan. */
function theirs(bytes) {
  const reader = new McapStreamReader();
  reader.append(bytes);
  const [topics, counts, scans] = [new Map(), {}, []];
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    if (record.type === 'Channel') topics.set(record.id, record.topic);
    if (record.type !== 'Message') continue;
    const topic = topics.get(record.channelId);
    counts[topic] = (counts[topic] ?? 0) + 1;
    if (topic === RADAR.topic) scans.push(returnsOf(record.data));
  }
  return { counts, scans };
}

/** Time in ns and numbers of a RadarScan. */
function returnsOf(data) {
  const view = new DataView(data.buffer, data.byteOffset + 4, data.byteLength - 4);
  const timeNs = BigInt(view.getUint32(0, true)) * 1_000_000_000n + BigInt(view.getUint32(4, true));
  let at = 12 + view.getUint32(8, true);
  at += (4 - (at % 4)) % 4;
  const count = view.getUint32(at, true);
  const numbers = (k) => [0, 4, 12].map((offset) => view.getFloat32(at + 4 + 20 * k + offset, true));
  return { timeNs, returns: Array.from({ length: count }, (_, k) => numbers(k)) };
}

describe('recordings', () => {
  test('hold what @mcap/core sees in them, to the last digit', () => {
    const drive = readDrive([file(bytes)]);
    const { counts, scans } = theirs(bytes);
    assert.deepEqual(Object.fromEntries(drive.topics.map(({ name, messages }) => [name, messages])), counts);
    assert.equal(drive.format, 'mcap');
    assert.equal(drive.mountings, 'tf-static');
    assert.deepEqual(drive.sensors, [{ id: 1, xM: RADAR.xM, yM: 0, yawDeg: 0 }]);
    assert.equal(drive.scans.timeS.length, scans.length);
    const { offsets, timeS } = drive.scans;
    for (const [i, { timeNs, returns }] of scans.entries()) {
      assert.equal(timeS[i], Number(timeNs - scans[0].timeNs) / 1e9);
      assert.equal(offsets[i + 1] - offsets[i], returns.length);
      returns.forEach(([range, azimuth, rate], k) => {
        const at = offsets[i] + k;
        assert.equal(drive.detections.rangeM[at], range);
        assert.equal(drive.detections.rangeRateMps[at], rate);
        assert.ok(Math.abs(drive.detections.azimuthDeg[at] - (azimuth * 180) / Math.PI) < 1e-12);
      });
    }
    assert.equal(drive.motion.timeS.length, counts['/vehicle/twist']);
    assert.equal(drive.startS, Number(scans[0].timeNs) / 1e9);
    assert.deepEqual(drive.warnings, []);
    const used = Object.fromEntries(drive.topics.map(({ name, usedAs }) => [name, usedAs]));
    const expected = {
      [RADAR.topic]: 'radar',
      '/camera/image': 'unused',
      '/tf_static': 'mountings',
      '/vehicle/twist': 'motion',
    };
    assert.deepEqual(used, expected);
  });

  test('are the same packed, in pieces, and on a pool', async () => {
    const drive = readDrive([file(bytes)]);
    const packed = await recordingBytes({ seconds: 5, imageBytes: 20_000, chunkSize: 60_000, compression: 'lz4' });
    assert.ok(packed.length < 0.7 * bytes.length);
    assert.deepEqual(readDrive([file(packed)]), drive);
    for (const size of [1000, 65_537]) {
      const stream = new DriveStream();
      for (let at = 0; at < packed.length; at += size) stream.push(packed.subarray(at, at + size));
      assert.deepEqual(stream.finish(), drive);
      stream.free();
    }
    const told = [];
    const onProgress = (done, total) => told.push([done, total]);
    assert.deepEqual(await pool.readDriveStream(new Blob([packed]), undefined, { onProgress }), drive);
    assert.deepEqual(told.at(-1), [packed.length, packed.length]);
    async function* given() {
      for (let at = 0; at < packed.length; at += 100_000) yield packed.subarray(at, at + 100_000);
    }
    assert.deepEqual(await pool.readDriveStream(given()), drive);
    const here = createPool({ workers: 0 });
    assert.deepEqual(await here.readDriveStream(new Blob([packed])), drive);
    here.terminate();
  });

  test('of several parts are one drive, and several are read at a time', async () => {
    const whole = await pool.readDriveStream([new Blob([bytes]), new Blob([bytes])]);
    const once = readDrive([file(bytes)]);
    assert.deepEqual(readDrive([file(bytes, 'a_0.mcap'), file(bytes, 'a_1.mcap')]), whole);
    assert.equal(whole.detections.rangeM.length, 2 * once.detections.rangeM.length);
    const many = await Promise.all(Array.from({ length: 5 }, () => pool.readDriveStream(new Blob([bytes]))));
    for (const one of many) assert.deepEqual(one, once);
  });

  test('can be left on the way, and the pool goes on', async () => {
    const control = new AbortController();
    const job = { signal: control.signal, onProgress: () => control.abort() };
    const large = new Blob([bytes, ...Array.from({ length: 20 }, () => new Uint8Array(1 << 20))]);
    await assert.rejects(pool.readDriveStream(large, {}, job), { name: 'AbortError' });
    assert.equal((await pool.readDriveStream(new Blob([bytes]))).format, 'mcap');
    const thrown = new Error('of the callback');
    const throws = () => {
      throw thrown;
    };
    await assert.rejects(pool.readDriveStream(new Blob([bytes]), {}, { onProgress: throws }), thrown);
  });

  test('that are cut or none are told', async () => {
    const cut = readDrive([file(bytes.subarray(0, bytes.length / 2))]);
    assert.deepEqual(
      cut.warnings.map(({ code }) => code),
      ['cut-file'],
    );
    assert.ok(cut.scans.timeS.length > 30 && cut.scans.timeS.length < 70);
    throwsTyped(() => readDrive([file(Buffer.from('PK and so on'))]), 'malformed-file');
    const stream = new DriveStream();
    throwsTyped(() => stream.push(new Uint8Array(40)), 'malformed-file');
    stream.free();
    const gone = new (class extends Blob {
      slice() {
        return { arrayBuffer: () => Promise.reject(new DOMException('the file was moved', 'NotFoundError')) };
      }
    })([bytes]);
    await rejectsTyped(pool.readDriveStream(gone), 'unreadable-file', 'recording');
    await rejectsTyped(pool.readDriveStream(new Blob(['no recording at all'])), 'malformed-file');
    await rejectsTyped(pool.readDriveStream(new Blob([])), 'no-drive-log');
    await rejectsTyped(pool.readDriveStream('drive.mcap'), 'wrong-type');
    await rejectsTyped(pool.readDriveStream(new Blob([bytes]), { radarTopics: ['/rear'] }), 'unknown-topic');
    throwsTyped(() => new DriveStream({ format: 'csv' }), 'no-drive-log');
    const named = readDrive([file(bytes)], { radarTopics: [RADAR.topic], baseFrame: 'map' });
    assert.deepEqual(named.sensors, [{ id: 1, xM: null, yM: null, yawDeg: null }]);
  });
});
