/** Runs what the demo gives as code, where a reader would: in a folder with the package, and with the command line. */
import { execFile } from 'node:child_process';
import { mkdir, mkdtemp, rm, symlink, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { promisify } from 'node:util';
import { root } from '../../../scripts/lib/paths.mjs';
import { commandLine as boresight } from '../../../scripts/lib/programs.mjs';

const run = promisify(execFile);
const MOST_OUTPUT = 2 ** 26;

/** A folder as the code asks for: the package, the repository's files, and `files` by name. */
async function inFolder(files, work) {
  const folder = await mkdtemp(join(tmpdir(), 'boresight-code-'));
  try {
    await mkdir(join(folder, 'node_modules'));
    // A scope of its own: one above may be a package of the same name.
    await writeFile(join(folder, 'package.json'), '{ "private": true }\n');
    await symlink(root, join(folder, 'node_modules', 'boresight'), 'dir');
    for (const name of ['recordings', 'models', 'research']) await symlink(join(root, name), join(folder, name), 'dir');
    for (const [name, content] of Object.entries(files)) {
      await mkdir(dirname(join(folder, name)), { recursive: true });
      await writeFile(join(folder, name), content);
    }
    return await work(folder);
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

/** Lines that a script prints, each as its words, numbers as such. */
export const runScript = (text, files = {}) =>
  inFolder(files, async (folder) => {
    await writeFile(join(folder, 'shown.mjs'), text);
    const { stdout } = await run(process.execPath, ['shown.mjs'], { cwd: folder, maxBuffer: MOST_OUTPUT });
    return stdout
      .trimEnd()
      .split('\n')
      .map((line) => line.split(' ').map((word) => (word !== '' && !Number.isNaN(Number(word)) ? Number(word) : word)));
  });

/** What commands print: JSON values one after the other. */
export const runCommands = (text, files = {}) =>
  inFolder(files, async (folder) => {
    await mkdir(join(folder, 'bin'));
    await symlink(await boresight(), join(folder, 'bin', 'boresight'));
    const env = { ...process.env, PATH: `${join(folder, 'bin')}:${process.env.PATH}` };
    const { stdout } = await run('bash', ['-euo', 'pipefail', '-c', text], {
      cwd: folder,
      env,
      maxBuffer: MOST_OUTPUT,
    });
    // Values begin and end at the first column.
    return [...stdout.matchAll(/^(?:\[\]|[[{]\n[\s\S]*?^[\]}])$/gm)].map(([json]) => JSON.parse(json));
  });
