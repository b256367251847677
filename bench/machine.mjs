// What the figures were measured on, and the module they are about.

import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { arch, cpus, loadavg, platform, release } from 'node:os';
import { brotliCompressSync, constants } from 'node:zlib';
import { median } from './measure.mjs';

export const machine = () => ({
  cpu: cpus()[0]?.model ?? 'unknown',
  cores: cpus().length,
  // Processes that wanted a core over the last minute: medians are trusted below the core count.
  load: loadavg()[0],
  system: `${platform()} ${release()} ${arch()}`,
  node: process.versions.node,
  v8: process.versions.v8,
});

export function wasmModule(path) {
  const bytes = readFileSync(path);
  const quality = { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length };
  return {
    bytes: bytes.length,
    brotliBytes: brotliCompressSync(bytes, { params: quality }).length,
    sha256: createHash('sha256').update(bytes).digest('hex'),
  };
}

/** Seconds from an imported package to one ready to use, in fresh processes. */
export function initSeconds(entry, runs) {
  const script = `
    const { init } = await import(${JSON.stringify(entry)});
    const start = process.hrtime.bigint();
    await init();
    console.log(Number(process.hrtime.bigint() - start) / 1e9);`;
  const once = () =>
    Number(execFileSync(process.execPath, ['--input-type=module', '-e', script], { encoding: 'utf8' }));
  return median(Array.from({ length: runs }, once));
}
