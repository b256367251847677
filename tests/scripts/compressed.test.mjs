import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, utimesSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { brotliDecompressSync, gunzipSync } from 'node:zlib';
import { compressFolder } from '../../scripts/lib/compressed.mjs';

test('files that gain are compressed both ways, once of the same bytes, and kept no longer than used', async () => {
  const [site, keep] = ['site', 'keep'].map((name) => mkdtempSync(join(tmpdir(), `boresight-${name}-`)));
  try {
    const file = join(site, 'page.js');
    writeFileSync(file, 'radar '.repeat(500));
    writeFileSync(join(site, 'weights.onnx'), 'radar '.repeat(500));
    await compressFolder(site, keep);
    const both = () => ['br', 'gz'].map((ending) => readFileSync(`${file}.${ending}`));
    const [small, wide] = both();
    assert.equal(brotliDecompressSync(small).toString(), readFileSync(file, 'utf8'));
    assert.equal(gunzipSync(wide).toString(), readFileSync(file, 'utf8'));
    assert.ok(!existsSync(join(site, 'weights.onnx.br')));
    const names = readdirSync(keep);
    assert.equal(names.length, 2);
    // It is taken as it was kept.
    for (const name of names) writeFileSync(join(keep, name), name.slice(-2));
    await compressFolder(site, keep);
    assert.deepEqual(both().map(String), ['br', 'gz']);
    const old = new Date(Date.now() - 40 * 24 * 3600e3);
    for (const name of names) utimesSync(join(keep, name), old, old);
    writeFileSync(file, 'other '.repeat(500));
    await compressFolder(site, keep);
    assert.equal(brotliDecompressSync(both()[0]).toString(), readFileSync(file, 'utf8'));
    assert.ok(readdirSync(keep).every((name) => !names.includes(name)));
  } finally {
    for (const folder of [site, keep]) rmSync(folder, { recursive: true });
  }
});
