/** Packs the package and installs it into empty projects in a temporary folder. */
import { execFile } from 'node:child_process';
import { copyFileSync, cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';
import { root } from '../../scripts/lib/paths.mjs';

const execute = promisify(execFile);
const npm = process.platform === 'win32' ? 'npm.cmd' : 'npm';
const here = dirname(fileURLToPath(import.meta.url));
const exampleFolder = join(root, 'docs', 'examples');
const manifest = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));

/** Runs a program; on failure the error holds what it printed. */
export async function run(program, args, options = {}) {
  try {
    return await execute(program, args, {
      maxBuffer: 1 << 26,
      shell: program === npm && npm.endsWith('.cmd'),
      ...options,
    });
  } catch (error) {
    throw new Error(`${program} ${args.join(' ')} failed\n${error.stdout ?? ''}\n${error.stderr ?? error.message}`);
  }
}

export const temporaryFolder = () => mkdtempSync(join(tmpdir(), 'boresight-'));

/** Packs what `npm publish` would upload; gives the tarball and the list of its files. */
export async function pack(folder) {
  const { stdout } = await run(npm, ['pack', '--json', '--ignore-scripts', '--pack-destination', folder], {
    cwd: root,
  });
  const [packed] = JSON.parse(stdout);
  return { tarball: join(folder, packed.filename), files: packed.files.map(({ path }) => path), size: packed.size };
}

/**
 * An empty project with the packed package installed. `files` maps a name to its text; `fixtures`
 * are copied from this folder; `examples` are folders of docs/examples, or of `from`, workspaces of the project;
 * `tools` are packages at the version that this checkout uses, `packages` others with their versions.
 */
export async function consumer({
  files = {},
  fixtures = [],
  examples = [],
  from = exampleFolder,
  tools = [],
  packages = {},
}) {
  const parent = temporaryFolder();
  const folder = join(parent, 'project');
  mkdirSync(folder);
  const { tarball } = await pack(parent);
  const devDependencies = {
    ...Object.fromEntries(tools.map((name) => [name, manifest.devDependencies[name]])),
    ...packages,
  };
  const all = {
    'package.json': JSON.stringify({
      name: 'consumer',
      private: true,
      type: 'module',
      dependencies: { boresight: `file:${tarball}` },
      devDependencies,
      workspaces: examples,
    }),
    ...files,
  };
  for (const [name, text] of Object.entries(all)) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), text);
  }
  // What was installed or built in an example is left there.
  const filter = (path) => !['node_modules', 'dist'].includes(basename(path));
  for (const name of examples) cpSync(join(from, name), join(folder, name), { recursive: true, filter });
  for (const name of fixtures) copyFileSync(join(here, 'fixtures', name), join(folder, name));
  // Vite sets NODE_ENV where it serves, and npm would then leave these out.
  await run(npm, ['install', '--include=dev', '--prefer-offline', '--no-audit', '--no-fund', '--no-package-lock'], {
    cwd: folder,
  });
  return {
    folder,
    tarball,
    run: (program, args) => run(program, args, { cwd: folder }),
    /** Runs a script of an example, as one does who has copied it. */
    script: (example, name) => run(npm, ['run', name], { cwd: join(folder, example) }),
    bin: (name) => join(folder, 'node_modules', '.bin', name),
    remove: () => rmSync(parent, { recursive: true, force: true }),
  };
}
