import { environment, tool, tools } from './paths.mjs';
import { output, run } from './run.mjs';

/** Installs a program from crates.io into .tools, unless this version of it is there. */
export async function cargoTool(binary, crate, version, variables = {}) {
  const found = output(tool(binary), ['--version'])?.trim().split(/\s+/)[1];
  if (found === version) {
    console.log(`setup: ${binary} ${version} is there`);
    return;
  }
  console.log(`setup: ${crate} ${version} into .tools (about two minutes)`);
  // Without --locked: the lock file these crates carry may name versions a registry mirror lacks.
  await run('cargo', ['install', '--quiet', '--root', tools, crate, '--version', `=${version}`], {
    env: { ...environment, ...variables },
  });
}
