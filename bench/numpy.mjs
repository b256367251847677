// The NumPy process that stays up beside the bench, and the checkout's Python for it.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

const server = fileURLToPath(new URL('./numpy/server.py', import.meta.url));
const oneThread = Object.fromEntries(
  ['OPENBLAS', 'OMP', 'MKL', 'BLIS', 'NUMEXPR', 'VECLIB_MAXIMUM'].map((name) => [`${name}_NUM_THREADS`, '1']),
);

export class NumPy {
  #process;
  #waiting = [];
  #folder = mkdtempSync(join(tmpdir(), 'boresight-bench-'));

  /** Starts the server; throws if the interpreter cannot run it. */
  static async start(interpreter) {
    const numpy = new NumPy(interpreter);
    numpy.versions = await numpy.ask({ do: 'versions' });
    return numpy;
  }

  constructor(interpreter) {
    this.#process = spawn(interpreter, ['-u', server], {
      stdio: ['pipe', 'pipe', 'inherit'],
      env: { ...process.env, ...oneThread },
    });
    createInterface({ input: this.#process.stdout }).on('line', (line) => {
      const { resolve, reject } = this.#waiting.shift();
      const answer = JSON.parse(line);
      if (answer.error) reject(new Error(`NumPy: ${answer.error}`));
      else resolve(answer);
    });
    const fail = (error) => this.#waiting.splice(0).forEach(({ reject }) => reject(error));
    this.#process.on('error', fail);
    this.#process.stdin.on('error', fail);
    this.#process.on('exit', (code) => fail(new Error(`the NumPy process ended with ${code}`)));
  }

  ask(request) {
    return new Promise((resolve, reject) => {
      this.#waiting.push({ resolve, reject });
      this.#process.stdin.write(`${JSON.stringify(request)}\n`);
    });
  }

  /** Hands data over in a file, and has a method planned for it. */
  async prepare(what, id, arrays, request) {
    const path = join(this.#folder, `${id}.bin`);
    writeFileSync(path, Buffer.concat(arrays.map((a) => Buffer.from(a.buffer, a.byteOffset, a.byteLength))));
    await this.ask({ do: what, id, data: path, ...request });
  }

  async seconds(id, calls) {
    return (await this.ask({ do: 'time', id, calls })).seconds;
  }

  stop() {
    this.#process.stdin.end();
    rmSync(this.#folder, { recursive: true, force: true });
  }
}
