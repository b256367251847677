// Runs tests/python: the package of python/boresight from its sources, and the wheel that is built of its source distribution.
import { existsSync, mkdirSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { whenChanged } from './lib/build/stamp.mjs';
import { root } from './lib/paths.mjs';
import { pytest, virtualEnvironment } from './lib/python/python.mjs';
import { preparePackage, source } from './lib/python/python-package.mjs';
import { main, run } from './lib/run.mjs';

const requirements = 'tests/python/requirements.txt';
const folder = '.tools/python-package';

/**
 * Makes the source distribution and the wheel of it, where sources or crates changed. The profile is that which tests have, whose dependencies are
 * compiled for the most part; the crates themselves are not optimised, since from another folder they are compiled anew. Unpacked files have the times of
 * now, by which Cargo sees what changed.
 */
async function packaged(python) {
  const made = join(root, folder);
  preparePackage();
  const inputs = [source, 'crates', 'Cargo.toml', 'Cargo.lock', requirements];
  await whenChanged('python-package', { inputs, outputs: [`${folder}/wheel`] }, async () => {
    rmSync(made, { recursive: true, force: true });
    mkdirSync(join(made, 'source'), { recursive: true });
    const maturin = ['-m', 'maturin'];
    await run(python, [...maturin, 'sdist', '--out', made], { cwd: join(root, source) });
    const [archive] = readdirSync(made).filter((name) => name.endsWith('.tar.gz'));
    const unpack = ['tar', '-x', '-z', '-m', '-f', archive, '-C', 'source', '--strip-components=1'];
    await run(unpack[0], unpack.slice(1), { cwd: made });
    const crates = readdirSync(join(made, 'source', 'crates'));
    const unoptimised = crates.map((name) => `[profile.dev.package.boresight-${name}]\nopt-level = 0\n`);
    mkdirSync(join(made, 'source', '.cargo'), { recursive: true });
    writeFileSync(join(made, 'source', '.cargo', 'config.toml'), unoptimised.join('\n'));
    const target = resolve(root, process.env.CARGO_TARGET_DIR ?? 'target');
    const build = ['build', '--quiet', '--profile', 'dev', '--auditwheel', 'skip', '--compression-level', '1'];
    const places = ['--target-dir', target, '--out', join(made, 'wheel')];
    await run(python, [...maturin, ...build, ...places], { cwd: join(made, 'source') });
  });
  return made;
}

await main(async () => {
  const made = await packaged(await virtualEnvironment('python', requirements));
  const report = `${folder}/report.xml`;
  const variables = {
    PYTHONPATH: join(root, source),
    BORESIGHT_PACKAGE: made,
    PYTEST_ADDOPTS: `--junit-xml=${report}`,
  };
  const test = () => pytest('python', requirements, 'tests/python', variables);
  rmSync(join(root, report), { force: true });
  await test().catch((error) => {
    // Seen once, right after a worker of Ray was killed: pytest ended with status 1 without a word. Why was not found.
    if (existsSync(join(root, report))) throw error;
    console.log('tests: pytest ended without its report; once more');
    return test();
  });
});
