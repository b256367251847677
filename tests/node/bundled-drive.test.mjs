// The demo's form of the bundled drive says what the recording says.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { brotliCompressSync } from 'node:zlib';
import { initDrives, readDrive } from 'boresight';
import { compact, readColumns } from '../../scripts/lib/build/bundled-drive.mjs';
import { appModule } from './lib/app-module.mjs';
import { delphi } from './lib/drives.mjs';

const { tableOf } = await appModule('app/pages/mounting/drive/compact.ts');

test('the bundled drive comes back from its compact form in a third of the bytes', async () => {
  const [radar, pose] = delphi();
  const csv = readColumns(radar.bytes);
  const sent = compact(csv);
  const bytes = tableOf(sent);
  assert.equal(Buffer.from(bytes).toString('utf8'), csv);
  const { length } = brotliCompressSync(sent, { params: { 1: 9, 2: 24 } });
  assert.ok(length < radar.bytes.length / 3, `${length} of ${radar.bytes.length} bytes`);
  await initDrives();
  assert.deepEqual(readDrive([{ ...radar, name: 'front_radar.csv', bytes }, pose]), readDrive([radar, pose]));
});

test('tables come back with signs, decimals and tracks that come and go', () => {
  const csv = 'track_id,range_m,t_s\n3,-0.05,7\n70,1.00,-12\n3,12.34,0\n70,-100.00,65536\n';
  assert.equal(Buffer.from(tableOf(compact(csv))).toString('utf8'), csv);
  const plain = new Uint8Array([0x1f, 0x8b, 8]);
  assert.equal(tableOf(plain), plain);
});
