import { join } from 'node:path';
import { root, tool, tools } from './paths.mjs';
import { output, run } from './run.mjs';

/**
 * Installs a program from crates.io into .tools, unless this version of it is there. Only the crates of `computes` are
 * optimised: to compile all else costs more than it would ever gain.
 */
export async function cargoTool(binary, crate, version, { features = [], computes = [] } = {}) {
  const found = output(tool(binary), ['--version'])?.trim().split(/\s+/)[1];
  if (found === version) {
    console.log(`setup: ${binary} ${version} is there`);
    return;
  }
  console.log(`setup: ${crate} ${version} into .tools (about a minute)`);
  const settings = [
    'profile.release.opt-level=0',
    ...computes.map((name) => `profile.release.package.${name}.opt-level=1`),
  ];
  // Without --locked: the lock file these crates carry may name versions a registry mirror lacks.
  await run('cargo', [
    'install',
    '--quiet',
    '--root',
    tools,
    // Kept, since tools share many crates.
    '--target-dir',
    join(root, 'target', 'tools'),
    ...settings.flatMap((setting) => ['--config', setting]),
    ...features,
    crate,
    '--version',
    `=${version}`,
  ]);
}
