// A recording of ROS 2 read in pieces, beside @mcap/core: images for the most part, a radar and the car's motion between.
import { closeSync, mkdtempSync, openSync, readSync, rmSync, writeSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import unpackLz4 from '@foxglove/wasm-lz4';
import { McapStreamReader } from '@mcap/core';
import { RADAR, writeRecording } from '../scripts/lib/recordings.mjs';
import { quantile } from './measure.mjs';

const PIECE = 4 * 1024 * 1024;
const MEGABYTE = 1e6;

/** The bytes of a file in pieces of one buffer. */
function* piecesOf(path) {
  const file = openSync(path, 'r');
  const piece = Buffer.alloc(PIECE);
  try {
    for (let count = readSync(file, piece); count > 0; count = readSync(file, piece)) yield piece.subarray(0, count);
  } finally {
    closeSync(file);
  }
}

const summary = (values) => ({
  median: quantile(values, 0.5),
  low: quantile(values, 0.1),
  high: quantile(values, 0.9),
});

/** Seconds of `work`. */
function seconds(work) {
  const start = process.hrtime.bigint();
  work();
  return Number(process.hrtime.bigint() - start) / 1e9;
}

/** Ours, which makes a drive: messages of the radar's topic. */
function ours({ DriveStream }, path) {
  const stream = new DriveStream();
  for (const piece of piecesOf(path)) stream.push(piece);
  const drive = stream.finish();
  stream.free();
  return drive.topics.find(({ name }) => name === RADAR.topic).messages;
}

/** Theirs: messages of the radar's topic, none of them decoded. */
function theirs(path) {
  const unpack = (bytes, size) => unpackLz4(bytes, Number(size));
  const reader = new McapStreamReader({ decompressHandlers: { lz4: unpack }, validateCrcs: true });
  let [channel, messages] = [-1, 0];
  for (const piece of piecesOf(path)) {
    reader.append(piece);
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
      if (record.type === 'Channel' && record.topic === RADAR.topic) channel = record.id;
      if (record.type === 'Message' && record.channelId === channel) messages += 1;
    }
  }
  return messages;
}

/** Rows for recordings of `mostBytes`, unpacked and packed with LZ4. */
export async function recordingRows({ row, boresight, quick }) {
  const mostBytes = quick ? 100 * MEGABYTE : 1000 * MEGABYTE;
  await unpackLz4.isLoaded;
  for (const compression of ['', 'lz4']) {
    const name = `a recording of ${mostBytes / MEGABYTE} MB, ${compression || 'not packed'}: DriveStream beside @mcap/core`;
    await row(name, { unit: 's', otherName: '@mcap/core' }, async () => {
      const folder = mkdtempSync(join(tmpdir(), 'boresight-recording-'));
      try {
        const path = join(folder, 'drive.mcap');
        const file = openSync(path, 'w');
        const options = { seconds: 1e6, imageBytes: 1_000_000, chunkSize: 4 * MEGABYTE, compression, mostBytes };
        const { bytes, counts } = await writeRecording((piece) => void writeSync(file, piece), options);
        closeSync(file);
        const times = { ours: [], theirs: [] };
        for (let round = 0; round < (quick ? 1 : 3); round++) {
          for (const [side, read] of [
            ['ours', () => ours(boresight, path)],
            ['theirs', () => theirs(path)],
          ]) {
            let messages = 0;
            times[side].push(
              seconds(() => {
                messages = read();
              }),
            );
            if (messages !== counts[RADAR.topic])
              throw new Error(`${side}: ${messages} of ${counts[RADAR.topic]} scans`);
          }
        }
        const ratios = times.theirs.map((time, round) => time / times.ours[round]);
        const [own, other, ratio] = [times.ours, times.theirs, ratios].map(summary);
        return { ours: own, other, ratio, readBytes: bytes, value: own.median };
      } finally {
        rmSync(folder, { recursive: true, force: true });
      }
    });
  }
}
