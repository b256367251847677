/**
 * One process for a folder. The lock is a Unix socket in it that its holder listens on. The kernel closes it with the
 * process, however that ends, so nothing is left that would have to be removed by hand.
 *
 * Entries are numbered. A process links its socket, already listening, under the number after the highest one, which fails
 * where another process did. The entry with the highest number is never removed, so numbers only grow, and whoever finds
 * no higher one than its own holds the folder.
 */
import { createHash, randomBytes } from 'node:crypto';
import { linkSync, readdirSync, realpathSync, rmSync } from 'node:fs';
import { createConnection, createServer } from 'node:net';
import { hostname } from 'node:os';
import { join, relative } from 'node:path';
import process from 'node:process';

/** Longest path of a socket, bytes. */
const LONGEST = 100;
/** A holder that says nothing within this time is stopped or busy, and still holds. */
const ANSWER_MS = 1000;
const OTHER = 'a process that does not answer';

/** The holder that listens at a path, or null where none does. @param {string} path @returns {Promise<string | null>} */
function holderAt(path) {
  return new Promise((resolve) => {
    let told = '';
    const socket = createConnection(path);
    const timer = setTimeout(() => socket.destroy(), ANSWER_MS);
    socket.setEncoding('utf8').on('data', (piece) => (told += piece));
    socket.on('error', (/** @type {any} */ { code }) => {
      if (code === 'ECONNREFUSED' || code === 'ENOENT') resolve(null);
    });
    socket.on('close', () => {
      clearTimeout(timer);
      resolve(told || OTHER);
    });
  });
}

/** @param {string} path @returns {Promise<import('node:net').Server>} */
function listening(path) {
  const server = createServer((socket) => {
    socket.on('error', () => {});
    socket.end(`process ${process.pid} on ${hostname()}`);
  });
  return new Promise((resolve, reject) => {
    server.once('error', reject);
    server.listen(path, () => resolve(server.unref()));
  });
}

/** @param {string} folder @param {string | null} holder */
const held = (folder, holder) => new Error(`${folder} is in use by ${holder}; a data folder is for one process`);

/** Takes the folder for this process until it ends. Throws where another one has it. @param {string} folder */
export async function lockFolder(folder) {
  if (process.platform === 'win32') {
    const pipe = `\\\\?\\pipe\\boresight-${createHash('sha256').update(realpathSync(folder)).digest('hex')}`;
    await listening(pipe).catch(async (error) => {
      throw error.code === 'EADDRINUSE' ? held(folder, await holderAt(pipe)) : error;
    });
    return;
  }
  const near = relative(process.cwd(), folder) || '.';
  const at = (/** @type {string} */ name) => join(near.length < folder.length ? near : folder, name);
  const numbers = () =>
    readdirSync(folder)
      .flatMap((name) => /^lock\.(\d+)$/.exec(name)?.[1] ?? [])
      .map(Number)
      .sort((a, b) => a - b);
  const own = `lock.${randomBytes(6).toString('hex')}.new`;
  if (Buffer.byteLength(at(own)) > LONGEST) {
    throw new Error(`the path of the data folder is too long to lock it: ${folder}; expected ${LONGEST - 24} bytes`);
  }
  const server = await listening(at(own));
  try {
    for (;;) {
      const last = numbers().at(-1) ?? 0;
      const holder = last > 0 ? await holderAt(at(`lock.${last}`)) : null;
      if (holder !== null) throw held(folder, holder);
      const taken = `lock.${last + 1}`;
      try {
        linkSync(at(own), at(taken));
      } catch (error) {
        if (/** @type {any} */ (error).code === 'EEXIST') continue;
        throw error;
      }
      if (numbers().at(-1) === last + 1) break;
      // Others came and went since the numbers were read.
      rmSync(at(taken));
    }
  } catch (error) {
    server.close();
    throw error;
  }
  // Entries of processes that ended, and the name under which this one began.
  const last = numbers().at(-1);
  for (const name of readdirSync(folder).filter(
    (name) => /^lock\.\w+(\.new)?$/.test(name) && name !== `lock.${last}`,
  )) {
    if (name === own || (await holderAt(at(name))) === null) rmSync(at(name), { force: true });
  }
}
