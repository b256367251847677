// HDF5 files whose structure runs in circles, or that claim more than they hold: each ends, with a drive or a typed error.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { init, initDrives, readDrive } from 'boresight';
import { golden } from './lib/drives.mjs';

before(() => Promise.all([init(), initDrives()]));

const detections = (file) => readDrive([file]).detections.azimuthDeg.length;

test('links in circles are refused, and groups that hold themselves are not walked', () => {
  for (const name of ['links_in_circles', 'latest_links_in_circles'])
    assert.throws(() => readDrive([golden(`${name}.h5`)]), { code: 'malformed-hdf5', message: /radar_data/ }, name);
  assert.equal(detections(golden('groups_in_themselves.h5')), detections(golden('contiguous.h5')));
});

test('rows beyond what a file can hold are refused before they are unpacked', () => {
  for (const name of ['rows_of_nothing', 'a_chunk_of_zeros'])
    assert.throws(
      () => readDrive([golden(`${name}.h5`)]),
      { code: 'malformed-hdf5', message: /no more rows than the file can hold/ },
      name,
    );
});

/** Nodes of trees in a file: where each begins, its kind (0 groups, 1 chunks), its children. */
function* nodesOf(bytes) {
  for (let at = bytes.indexOf('TREE'); at >= 0; at = bytes.indexOf('TREE', at + 4))
    yield { at, kind: bytes[at + 4], level: at + 5, left: at + 8, right: at + 16, entries: bytes.readUInt16LE(at + 6) };
}

test('trees whose nodes are their own children or neighbours end', () => {
  const { name, bytes: whole } = golden('chunked.h5');
  let tried = 0;
  for (const { at, kind, level, left, right, entries } of nodesOf(whole)) {
    const own = BigInt(at);
    const child = Buffer.from(whole);
    child[level] += 1;
    // A key stands before each child: an address, or the size, filters and offsets of a chunk.
    const [key, first] = kind === 0 ? [8, at + 24] : [24, at + 24];
    for (let i = 0; i < entries; i++) child.writeBigUInt64LE(own, first + i * (key + 8) + key);
    assert.throws(
      () => readDrive([{ name, bytes: child }]),
      { code: 'malformed-hdf5', message: /deep|depth/ },
      `at ${at}`,
    );
    const neighbour = Buffer.from(whole);
    for (const side of [left, right]) neighbour.writeBigUInt64LE(own, side);
    assert.equal(detections({ name, bytes: neighbour }), detections({ name, bytes: whole }));
    tried += 1;
  }
  assert.ok(tried >= 3, 'a tree of groups, and one of each table’s chunks');
});
