/** The service as a process of a runtime, with data and settings of its own. */
import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { on, once } from 'node:events';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { delimiter, join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = fileURLToPath(new URL('../..', import.meta.url));
/** A program of npm's, here or in a folder above, else of the path. */
function program(name) {
  const folders = [
    join(here, 'node_modules'),
    join(here, '..', 'node_modules'),
    join(here, '..', '..', 'node_modules'),
  ];
  return folders.map((folder) => join(folder, '.bin', name)).find(existsSync) ?? name;
}

const COMMANDS = {
  node: () => [process.execPath, ['src/serve.js']],
  deno: () => [program('deno'), ['run', '--no-prompt', ...permissions(), 'src/serve.js']],
  bun: () => [program('bun'), ['src/serve.js']],
};
const permissions = () => JSON.parse(readFileSync(join(here, 'deno.json'), 'utf8')).tasks.start.match(/--allow-\S+/g);

export const RUNTIMES = ['node', 'deno', 'bun', 'workerd'];
/** Tokens by what they may, of the tenant `test`, and one of another tenant. */
export const TOKENS = { write: 'w'.repeat(43), read: 'r'.repeat(43), other: 'o'.repeat(43) };

const digest = (token) => createHash('sha256').update(token).digest('hex');
const settings = (more) => ({
  tenants: {
    test: { tokens: ['write', 'read'].map((role) => ({ sha256: digest(TOKENS[role]), role })) },
    other: { tokens: [{ sha256: digest(TOKENS.other), role: 'write' }] },
  },
  ...more,
});

/** The service on a runtime; `config` is put into its settings. */
export class Service {
  #child;
  #folder = mkdtempSync(join(tmpdir(), 'boresight-edge-'));
  #runtime;
  #environment;
  #inspector;
  errors = '';

  constructor(runtime, { config = {}, environment = {}, inspector } = {}) {
    this.#inspector = inspector;
    this.#runtime = runtime;
    this.#environment = environment;
    mkdirSync(join(this.#folder, 'data'));
    writeFileSync(join(this.#folder, 'config.json'), JSON.stringify(settings(config)));
    if (runtime !== 'workerd') return;
    const from = (path) => join(relative(this.#folder, here), path);
    const text = readFileSync(join(here, 'config.capnp'), 'utf8')
      .replaceAll('embed "dist/', `embed "${from('dist/')}`)
      .replace('disk = (path = "data/workerd"', `disk = (path = "${join(this.#folder, 'data')}"`);
    writeFileSync(join(this.#folder, 'config.capnp'), text);
  }

  /** The folder of its data. */
  get data() {
    return join(this.#folder, 'data');
  }

  get pid() {
    return this.#child.pid;
  }

  async start() {
    const [command, args] = COMMANDS[this.#runtime]?.() ?? [
      program('workerd'),
      [
        'serve',
        join(this.#folder, 'config.capnp'),
        '--socket-addr=http=127.0.0.1:0',
        '--control-fd=3',
        ...(this.#inspector ? [`-i127.0.0.1:${this.#inspector}`] : []),
      ],
    ];
    const env = {
      ...process.env,
      PATH: [join(here, 'node_modules', '.bin'), process.env.PATH].join(delimiter),
      PORT: '0',
      DATA: join(this.#folder, 'data'),
      CONFIG: join(this.#folder, 'config.json'),
      ...this.#environment,
    };
    const child = spawn(command, args, { cwd: here, env, stdio: ['ignore', 'pipe', 'pipe', 'pipe'] });
    this.#child = child;
    child.stderr.setEncoding('utf8').on('data', (piece) => (this.errors += piece));
    this.url = await new Promise((resolve, reject) => {
      child.once('error', reject);
      child.once('exit', (code) => reject(new Error(`${this.#runtime} ended with ${code}\n${this.errors}`)));
      child.stdio[3].setEncoding('utf8').on('data', (told) => {
        const listening = told
          .split('\n')
          .filter(Boolean)
          .map((line) => JSON.parse(line))
          .find(({ event }) => event === 'listen');
        if (listening) resolve(`http://127.0.0.1:${listening.port}`);
      });
      child.stdout.setEncoding('utf8').on('data', (told) => {
        const address = /http:\/\/\S+:\d+/.exec(told)?.[0];
        if (address) resolve(address);
      });
    });
    return this;
  }

  /** Ends the process as a power cut or a lack of memory does. */
  async kill() {
    const ended = new Promise((resolve) => this.#child.once('exit', resolve));
    this.#child.kill('SIGKILL');
    await ended;
  }

  async stop() {
    if (this.#child?.exitCode === null && this.#child.signalCode === null) await this.kill();
    rmSync(this.#folder, { recursive: true, force: true });
  }

  /** Asks with the token that may write; gives status, headers, and the body where it is JSON. */
  async ask(path, { method = 'GET', body, headers = {}, token = TOKENS.write, ...more } = {}) {
    const response = await fetch(this.url + path, {
      method,
      body,
      headers: { ...(token && { authorization: `Bearer ${token}` }), ...headers },
      ...(body instanceof ReadableStream && { duplex: 'half' }),
      ...more,
    });
    const text = await response.text();
    const isJson = response.headers.get('content-type') === 'application/json' && text !== '';
    return { status: response.status, headers: response.headers, text, json: isJson ? JSON.parse(text) : undefined };
  }

  put(vehicle, radar, options) {
    const headers = { 'content-type': 'application/json' };
    const path = `/v1/vehicles/${encodeURIComponent(vehicle)}/radars/${encodeURIComponent(radar)}`;
    return this.ask(path, { method: 'PUT', body: JSON.stringify(options), headers });
  }

  frames(vehicle, body, more = {}) {
    const headers = { 'content-type': 'application/x-ndjson' };
    return this.ask(`/v1/vehicles/${encodeURIComponent(vehicle)}/frames`, { method: 'POST', body, headers, ...more });
  }

  about(vehicle) {
    return this.ask(`/v1/vehicles/${encodeURIComponent(vehicle)}`);
  }

  /** Processor time of the process and its threads so far, ms. */
  cpuMs() {
    const fields = readFileSync(`/proc/${this.pid}/stat`, 'utf8').split(') ')[1].split(' ');
    return (Number(fields[11]) + Number(fields[12])) * 10;
  }

  /** Memory of workerd's isolate after its garbage is collected, bytes: JavaScript's heap, and what WebAssembly and buffers hold. */
  async isolate() {
    const [{ webSocketDebuggerUrl }] = await (await fetch(`http://127.0.0.1:${this.#inspector}/json`)).json();
    const { WebSocket } = await import('ws');
    const socket = new WebSocket(webSocketDebuggerUrl);
    await once(socket, 'open');
    const ask = async (id, method) => {
      socket.send(JSON.stringify({ id, method }));
      for await (const [message] of on(socket, 'message')) {
        const answer = JSON.parse(message);
        if (answer.id === id) return answer.result;
      }
    };
    await ask(1, 'HeapProfiler.collectGarbage');
    const usage = await ask(2, 'Runtime.getHeapUsage');
    socket.terminate();
    return usage;
  }

  /** Memory of the process, bytes: now, and at most so far. */
  memory() {
    const status = readFileSync(`/proc/${this.pid}/status`, 'utf8');
    const of = (name) => 1024 * Number(new RegExp(`${name}:\\s+(\\d+)`).exec(status)[1]);
    return { now: of('VmRSS'), most: of('VmHWM') };
  }
}
