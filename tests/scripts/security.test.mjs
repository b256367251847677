// The defaults that SECURITY.md states are those of the code.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { configOf } from '../../examples/edge/src/config.js';
import { root } from '../../scripts/lib/paths.mjs';

const read = (path) => readFileSync(join(root, path), 'utf8');
const page = read('SECURITY.md').replace(/\s+/g, ' ');
/** The first group of a pattern in a file. */
function found(path, pattern) {
  const match = pattern.exec(read(path));
  assert.ok(match, `${path} has no ${pattern}`);
  return match[1].replaceAll('_', '');
}
const states = (text) => assert.ok(page.includes(text), `SECURITY.md does not state ${text}`);

test('the addresses of the servers', () => {
  const options = 'crates/live/src/foxglove/options.rs';
  const serve = [found(options, /default = "([\d.]+)"\.into/), found(options, /default = (\d+)\)\]\s+pub port/)];
  states(`\`boresight serve\` | \`${serve.join(':')}\` | none`);
  const bridge = 'crates/cli/src/arguments/bridge.rs';
  const host = found(bridge, /default_value = "([\d.]+)"/);
  const port = found(bridge, /default_value_t = (\d+)\)\]\s+pub port/);
  states(`clients | \`${host}:${port}\` | none`);
  const address = (name) => found(bridge, new RegExp(`${name}: IpAddr = .*new\\(([\\d, ]+)\\)`)).replaceAll(', ', '.');
  states(`UDP \`${address('HOST')}:${found(bridge, /PORT: u16 = (\d+)/)}\``);
  states(`accepted from ${address('CARD')} only`);
  const edge = 'examples/edge/src/serve.js';
  states(`\`examples/edge\` | \`${found(edge, /HOST = '(.+?)'/)}:${found(edge, /PORT = '(\d+)'/)}\``);
  // Vite's own defaults hold where nothing sets others.
  states('`localhost:4173`');
  assert.doesNotMatch(read('vite.config.ts'), /\b(host|port|preview):/);
  assert.doesNotMatch(read('scripts/start.mjs'), /'--(host|port)'/);
});

test('the limits of serve and bridge', () => {
  const options = 'crates/live/src/foxglove/options.rs';
  states(`${found(options, /default = (\d+), .*\]\s+pub clients/)} by default`);
  const queue = found(options, /default = (\d+), .*\]\s+pub queue/);
  const bytes = found('crates/live/src/foxglove/queue.rs', /MOST_BYTES: usize = (\d+) << 20/);
  states(`up to ${queue} messages and ${bytes} MiB`);
  states(`at most ${found('crates/live/src/bridge/server.rs', /MOST_CLIENTS: usize = (\d+)/)} clients`);
  states(`Up to ${found('crates/live/src/bridge/clients.rs', /MOST_WAITING: usize = (\d+)/)} frames`);
  const handshake = 'crates/live/src/handshake.rs';
  states(`at most ${2 ** (Number(found(handshake, /LONGEST: usize = 1 << (\d+)/)) - 10)} KiB per message`);
  states(`a handshake ${found(handshake, /LONGEST_WAIT: Duration = Duration::from_secs\((\d+)\)/)} s`);
  const admission = 'crates/live/src/admission.rs';
  states(`${found(admission, /MOST_PENDING: usize = (\d+)/)} connections in their handshake`);
  states(`silent for ${found(admission, /SILENT: Duration = Duration::from_secs\((\d+)\)/)} s`);
});

test('the limits and open addresses of the edge service', () => {
  const { limits, origins } = configOf('{}');
  assert.deepEqual(origins, []);
  states(`${limits.requests.perS} requests per second`);
  states(`limited to ${limits.bodyBytes / 2 ** 20} MiB and a line of frames to ${limits.lineBytes / 2 ** 10} KiB`);
  states(`${limits.operations.toExponential().replace('+', '')} operations and ${limits.callBytes / 2 ** 20} MiB`);
  const open = [...read('examples/edge/src/routes.js').matchAll(/path: '([^']+)',\s+role: null/g)];
  const paths = open.map(([, path]) => path.replace('{file}', ''));
  assert.equal(paths.length, 4);
  for (const path of paths) states(`\`${path}\``);
});
