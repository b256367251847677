import { spawn, spawnSync } from 'node:child_process';
import { realpathSync } from 'node:fs';
import { constants as osConstants, setPriority } from 'node:os';
import { createInterface } from 'node:readline';
import { pathToFileURL } from 'node:url';
import { environment, root } from './paths.mjs';

/** Commands that somebody waits for. */
const running = new Set();

function started(command, args, options) {
  const child = spawn(command, args, { cwd: root, env: environment, stdio: 'inherit', ...options });
  running.add(child);
  return child;
}

/** Resolves where a child ends well; `detail` ends the message of the error. */
function ended(child, command, args, detail = () => '') {
  return new Promise((resolve, reject) => {
    child.once('error', (error) => {
      running.delete(child);
      reject(new Error(`${command} could not be started: ${error.message}`));
    });
    child.once('close', (code, signal) => {
      if (!running.delete(child)) return;
      if (code === 0) resolve();
      else reject(new Error(`${[command, ...args].join(' ')} ended with ${signal ?? `status ${code}`}${detail()}`));
    });
  });
}

/** Runs a command in the checkout, showing its output; rejects if it fails. */
export function run(command, args, options = {}) {
  return ended(started(command, args, options), command, args);
}

/** Runs a command at low priority, giving its output line by line; the error has the last of it. */
export function runBehind(command, args, onLine) {
  const child = started(command, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  try {
    if (child.pid) setPriority(child.pid, osConstants.priority.PRIORITY_BELOW_NORMAL);
  } catch {
    // It has ended already, or runs as fast as all else.
  }
  const last = [];
  for (const stream of [child.stdout, child.stderr])
    createInterface({ input: stream }).on('line', (line) => {
      if (line.trim() === '') return;
      last.push(line);
      if (last.length > 20) last.shift();
      onLine(line);
    });
  return ended(child, command, args, () => `:\n${last.join('\n')}`);
}

const isWindows = process.platform === 'win32';

/** Kills a command that leads a process group, with its descendants; Windows knows these without a group. */
function killTree({ pid }) {
  if (pid === undefined) return;
  if (isWindows) {
    spawnSync('taskkill', ['/pid', String(pid), '/t', '/f']);
    return;
  }
  try {
    process.kill(-pid, 'SIGKILL');
  } catch (error) {
    if (error.code !== 'ESRCH') throw error;
  }
}

const ENDING = ['SIGINT', 'SIGTERM', 'SIGHUP'];

/**
 * Runs a command keeping what it prints; gives status and text. `show` is given each piece and where it was printed.
 * After `timeout` ms the command is killed with its descendants, and nothing more is waited for.
 */
export function runKeeping(command, args, { timeout, ...options } = {}, show = () => {}) {
  return new Promise((resolve) => {
    // A process group can be killed as a whole. It does not get the terminal's Ctrl+C, which is passed on below.
    const grouped = timeout !== undefined && !isWindows;
    const stdio = ['ignore', 'pipe', 'pipe'];
    const child = spawn(command, args, { cwd: root, env: environment, stdio, detached: grouped, ...options });
    let text = '';
    const pass = (signal) => {
      killTree(child);
      finish({ ok: false, text });
      process.kill(process.pid, signal);
    };
    const timer =
      timeout === undefined
        ? undefined
        : setTimeout(() => {
            killTree(child);
            // Descendants that left the group may still hold the pipes.
            for (const stream of [child.stdout, child.stderr]) stream?.destroy();
            const note = `${command} was killed after ${timeout / 1000} s\n`;
            show(note, 'stderr');
            finish({ ok: false, text: text + note });
          }, timeout);
    if (grouped) for (const signal of ENDING) process.once(signal, pass);
    function finish(result) {
      clearTimeout(timer);
      for (const signal of ENDING) process.removeListener(signal, pass);
      resolve(result);
    }
    for (const name of ['stdout', 'stderr']) {
      child[name]?.setEncoding('utf8').on('data', (piece) => {
        text += piece;
        show(piece, name);
      });
    }
    child.once('error', (error) => finish({ ok: false, text: `${text}${command}: ${error.message}\n` }));
    child.once('close', (code, signal) =>
      finish({ ok: code === 0, text: signal ? `${text}${command} ended with ${signal}\n` : text }),
    );
  });
}

/** Runs a command showing its output and keeping a copy; gives status and text. */
export const runTee = (command, args, options) =>
  runKeeping(command, args, options, (piece, name) => process[name].write(piece));

/** Output of a command, or null if it is missing or fails. */
export function output(command, args, options = {}) {
  const result = spawnSync(command, args, {
    cwd: root,
    env: environment,
    encoding: 'utf8',
    maxBuffer: 1 << 28,
    stdio: ['ignore', 'pipe', 'ignore'],
    ...options,
  });
  return result.status === 0 ? result.stdout : null;
}

/** Runs the main function of a script: one line and status 1 on failure. Commands that still run beside it end with it. */
export async function main(body) {
  try {
    await body();
  } catch (error) {
    console.error(`\n${error.message}`);
    process.exitCode = 1;
  } finally {
    const rest = [...running];
    running.clear();
    for (const child of rest) child.kill();
  }
}

/** Whether a module is the script that Node was started with. */
export const isMain = (meta) =>
  process.argv[1] !== undefined && meta.url === pathToFileURL(realpathSync(process.argv[1])).href;
