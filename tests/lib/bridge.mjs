/** `boresight bridge` with the recorded capture in place of a card. */
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { join } from 'node:path';
import { root } from '../../scripts/lib/paths.mjs';
import { commandLine } from '../../scripts/lib/programs.mjs';

const folder = join(root, 'recordings', 'awr1642');

/** The command line: what the environment variable BORESIGHT names, else it is built. */
export async function startBridge(...more) {
  const child = spawn(
    await commandLine(),
    [
      ...['bridge', '--config', join(folder, 'profile.cfg'), '--port', '0', '--listen', '127.0.0.1:0', '--json'],
      ...['--replay', join(folder, 'xwr16xx_crw_dca_module_2018_1015v2.bin'), ...more],
    ],
    { stdio: ['ignore', 'pipe', 'pipe'] },
  );
  let [said, printed] = ['', ''];
  child.stderr.on('data', (text) => {
    said += text;
  });
  child.stdout.on('data', (text) => {
    printed += text;
  });
  const address = () => /ws:\/\/127\.0\.0\.1:(\d+)/.exec(said);
  for (let tries = 0; !address(); tries++) {
    assert.ok(tries < 400 && child.exitCode === null, said);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  return {
    address: address()[0],
    port: Number(address()[1]),
    /** As Ctrl-C does; the exit status, and what came. */
    end: async () => {
      child.kill('SIGINT');
      const [code] = await once(child, 'close');
      return { code, counts: JSON.parse(printed) };
    },
  };
}
