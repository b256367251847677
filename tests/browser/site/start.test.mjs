import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { test } from 'node:test';
import { freePort } from '../../../scripts/lib/free-port.mjs';
import { root } from '../../../scripts/lib/paths.mjs';
import { mainScript } from '../../../scripts/lib/setup-measures.mjs';

test('npm start says what it does and serves the demo', { timeout: 120_000 }, async () => {
  const port = await freePort();
  const started = spawn(
    process.execPath,
    ['scripts/start.mjs', '--host', '127.0.0.1', '--port', `${port}`, '--strictPort'],
    {
      cwd: root,
      // Vite colours the address where CI is set, which parts the colon from the port.
      env: { ...process.env, NO_COLOR: '1' },
      detached: process.platform !== 'win32',
      stdio: ['ignore', 'pipe', 'inherit'],
    },
  );
  let said = '';
  try {
    for await (const piece of started.stdout.setEncoding('utf8')) {
      said += piece;
      if (said.includes(`:${port}`)) break;
    }
    assert.match(said, /setup: .*\n(.*\n)*build: .*\n(.*\n)*start: serving/);
    const response = await fetch(`http://127.0.0.1:${port}/`);
    assert.equal(response.status, 200);
    const script = mainScript(await response.text());
    assert.ok(script, 'the page names its script');
    assert.equal((await fetch(new URL(script, response.url))).status, 200);
    assert.equal((await fetch(new URL('no/such/page', response.url))).status, 404, 'what is not there is not the page');
  } finally {
    if (started.exitCode === null) {
      // The server is a child of the script, so the whole group is ended.
      process.kill(process.platform === 'win32' ? started.pid : -started.pid);
      await once(started, 'exit');
    }
  }
});
