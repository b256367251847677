/** “Copy as code” of what is live. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { init, parseBoardLog } from 'boresight';
import { assertNear, codeOf } from '../lib/code-dialog.mjs';
import { runCommands, runScript } from '../lib/code-run.mjs';
import { recording } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

browserTest(
  'code: a board’s recording',
  { path: '#/live?play=bundled&pace=fast', timeout: 240_000 },
  async ({ page }) => {
    await page.waitForSelector('[data-live-state="ended"]');
    const code = await codeOf(page);
    await init();
    const log = parseBoardLog(
      Uint8Array.from(recording('xwr16xx_crw_demo_visualizer_2018_1015v2.dat')),
      recording('profile.cfg'),
    );
    const expected = log.frames.flatMap(({ frameNumber, objects }) =>
      objects.map(({ rangeM, rateMps, azimuthDeg }) => [frameNumber, rangeM, rateMps, azimuthDeg]),
    );
    assert.deepEqual(await runScript(code.javascript.text), expected);
    const [listed] = await runCommands(code.commandLine.text);
    assert.equal(listed.length, expected.length);
    for (const [k, { frame, rangeM, rateMps, azimuthDeg }] of listed.entries()) {
      const [number, ...own] = expected[k];
      assert.equal(frame, number);
      [rangeM, rateMps, azimuthDeg].forEach((value, i) => {
        assertNear(value, own[i], 1e-9, `row ${k}`);
      });
    }
  },
);

browserTest(
  'code: raw frames of a bridge, with what is not as by default',
  { path: '#/live?source=raw&bridge=9000&falseAlarm=1e-3&clutter=1&angle=capon' },
  async ({ page }) => {
    const { javascript, commandLine } = await codeOf(page);
    assert.match(javascript.text, /bridgeFrames\('ws:\/\/127\.0\.0\.1:9000'\)/);
    assert.match(
      javascript.text,
      /staticClutterRemoval: true,\s+cfar: \{ falseAlarm: 0\.001 \},\s+angle: \{ method: 'capon' \}/,
    );
    assert.match(commandLine.text, /^boresight bridge --config profile\.cfg --port 9000$/m);
    assert.match(commandLine.text, /--static-clutter-removal \\\n\s+--cfar-false-alarm 0\.001 --method capon$/m);
    const folder = mkdtempSync(join(tmpdir(), 'boresight-code-'));
    writeFileSync(join(folder, 'shown.mjs'), javascript.text);
    execFileSync(process.execPath, ['--check', join(folder, 'shown.mjs')]);
    rmSync(folder, { recursive: true });
  },
);
