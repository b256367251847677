/** MCAP files of the command line, read by the reader of MCAP's own package. */
import assert from 'node:assert/strict';
import { open } from 'node:fs/promises';
import { join } from 'node:path';
import { test } from 'node:test';
import { McapIndexedReader } from '@mcap/core';
import { root } from '../../scripts/lib/paths.mjs';
import { boresight, exported, inFolder, points } from './lib/exported.mjs';

const log = `${root}/recordings/delphi`;

/** All messages of a file by topic, in order of time, with its summary. */
async function read(path) {
  const file = await open(path);
  try {
    const { size } = await file.stat();
    const readable = {
      size: async () => BigInt(size),
      read: async (offset, length) => {
        const bytes = new Uint8Array(Number(length));
        await file.read(bytes, 0, bytes.length, Number(offset));
        return bytes;
      },
    };
    const reader = await McapIndexedReader.Initialize({ readable });
    const got = new Map();
    for await (const { channelId, logTime, data } of reader.readMessages({ validateCrcs: true })) {
      const { topic } = reader.channelsById.get(channelId);
      if (!got.has(topic)) got.set(topic, []);
      got.get(topic).push({ logTime, message: JSON.parse(new TextDecoder().decode(data)) });
    }
    for (const { name, encoding, data } of reader.schemasById.values()) {
      assert.deepEqual([encoding, JSON.parse(new TextDecoder().decode(data)).title], ['jsonschema', name]);
    }
    for (const { id, topic } of reader.channelsById.values()) {
      const counted = reader.statistics.channelMessageCounts.get(id) ?? 0n;
      assert.equal(Number(counted), (got.get(topic) ?? []).length, topic);
    }
    return { got, chunks: reader.chunkIndexes, dataEnd: reader.footer };
  } finally {
    await file.close();
  }
}

test('a drive and its calibration are in a file, with the numbers of the tables', () =>
  inFolder(async (folder) => {
    const path = join(folder, 'angles.mcap');
    const printed = await boresight('calibrate', log, '--min-speed', '3', '--json', '--mcap', path);
    const angle = JSON.parse(printed);
    const drive = await exported(log);
    const { got, chunks } = await read(path);
    assert.ok(chunks.length > 10 && chunks.every(({ compression }) => compression === ''));
    const clouds = got.get('/radar/1/detections').map(({ message }) => points(message));
    assert.equal(clouds.length, angle.frames.given);
    assert.deepEqual(
      clouds.filter((scan) => scan.length > 0),
      drive.scans,
    );
    const motion = got.get('/car/motion').map(({ message }) => message);
    assert.deepEqual(
      motion.map(({ speedMps, pose }) => [speedMps, pose.xM]),
      drive.motion.map((sample) => [sample.speed_mps, sample.x_m]),
    );
    const verdicts = got.get('/radar/1/frame').map(({ message }) => message.verdict);
    assert.equal(verdicts.filter((verdict) => verdict === 'used').length, angle.frames.used);
    const last = got.get('/radar/1/mounting').at(-1).message;
    assert.equal(last.angleDeg, angle.angleDeg);
    assert.deepEqual(last.frames, angle.frames);

    // Files that are there are kept.
    await assert.rejects(boresight('log', log, '--mcap', path), /is there already/);
    await boresight('log', log, '--mcap', path, '--force');
    const alone = await read(path);
    assert.deepEqual([...alone.got.keys()].sort(), [
      '/car/motion',
      '/car/scene',
      '/car/transform',
      '/radar/1/detections',
      '/radar/1/transform',
    ]);
    assert.deepEqual(
      alone.got.get('/radar/1/detections').map(({ message }) => points(message)),
      clouds,
    );
  }));
