import assert from 'node:assert/strict';
import {
  existsSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  rmSync,
  symlinkSync,
  utimesSync,
  writeFileSync,
} from 'node:fs';
import { rm, stat } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { brotliDecompressSync, gunzipSync } from 'node:zlib';
import { brotli, compressFolder, serveFolder } from '../../scripts/lib/build/compressed.mjs';
import { publish } from '../../scripts/lib/build/publish.mjs';

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

test('another build may throw away what this one reads', async () => {
  const [site, keep] = ['site', 'keep'].map((name) => mkdtempSync(join(tmpdir(), `boresight-${name}-`)));
  try {
    const page = Buffer.from('radar '.repeat(20));
    const made = await brotli(page, keep);
    const [name] = readdirSync(keep);
    // Gone after it was listed.
    symlinkSync(join(keep, 'gone'), join(keep, 'link'));
    await compressFolder(site, keep);
    // Gone at any moment of being read: after none to seven other calls.
    for (let round = 0; round < 400; round++) {
      writeFileSync(join(keep, name), made);
      const [got] = await Promise.all([
        brotli(page, keep),
        (async () => {
          for (let i = 0; i < round % 8; i++) await stat(keep);
          await rm(join(keep, name), { force: true });
        })(),
      ]);
      assert.deepEqual(brotliDecompressSync(got), page);
    }
  } finally {
    for (const folder of [site, keep]) rmSync(folder, { recursive: true });
  }
});

test('a demo that is built again while it is served is served anew, without a restart', async () => {
  const [site, next] = ['site', 'next'].map((name) => mkdtempSync(join(tmpdir(), `boresight-${name}-`)));
  const write = (folder, files) => {
    for (const [name, text] of Object.entries(files)) {
      mkdirSync(dirname(join(folder, name)), { recursive: true });
      writeFileSync(join(folder, name), text);
    }
  };
  write(site, { 'index.html': 'first', 'index.html.br': 'packed', 'assets/first.js': '1' });
  const serve = serveFolder(site);
  const server = createServer((request, response) => serve(request, response, () => response.writeHead(404).end()));
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  const get = async (path) => {
    const headers = { 'Accept-Encoding': 'identity', Connection: 'close' };
    const response = await fetch(`http://127.0.0.1:${server.address().port}/${path}`, { headers });
    return response.ok ? response.text() : response.status;
  };
  try {
    assert.equal(await get(''), 'first');
    write(next, { 'index.html': 'the second, which is longer', 'assets/second.js': '2' });
    publish(next, site);
    assert.equal(await get(''), 'the second, which is longer');
    assert.equal(await get('assets/second.js'), '2');
    assert.equal(await get('assets/first.js'), 404);
    assert.deepEqual(readdirSync(site).sort(), ['assets', 'index.html']);
    assert.ok(!existsSync(next));
  } finally {
    await new Promise((closed) => server.close(closed));
    for (const folder of [site, next]) rmSync(folder, { recursive: true, force: true });
  }
});
