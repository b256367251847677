// The demo's form of the bundled drive says what the recording says.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { initDrives, readDrive } from 'boresight';
import { readColumns } from '../../scripts/lib/read-columns.mjs';
import { delphi } from './lib/drives.mjs';

test('the bundled drive without the columns that are not read is the same drive in fewer bytes', async () => {
  await initDrives();
  const [radar, pose] = delphi();
  const bytes = readColumns(radar.bytes);
  assert.ok(bytes.length < 0.8 * radar.bytes.length, `${bytes.length} of ${radar.bytes.length} bytes`);
  assert.deepEqual(readDrive([{ ...radar, bytes }, pose]), readDrive([radar, pose]));
});
