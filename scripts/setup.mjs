// Everything a fresh checkout needs besides git, rustup and Node. Uses Node built-ins only.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { whenChanged } from './lib/build/stamp.mjs';
import { cargoTool } from './lib/cargo-tool.mjs';
import { atLeast, lockedVersion } from './lib/checks/versions.mjs';
import { root, wasmTarget } from './lib/paths.mjs';
import { isMain, main, output, run } from './lib/run.mjs';

const wasmPackVersion = '0.15.1';
const say = (text) => console.log(`setup: ${text}`);
const npm = process.platform === 'win32' ? 'npm.cmd' : 'npm';

function checkNode() {
  if (!atLeast(process.versions.node, '20.19.0')) {
    throw new Error(`Node 20.19 or newer is needed to build Boresight; this is ${process.versions.node}`);
  }
}

function checkRust() {
  const manifest = readFileSync(join(root, 'Cargo.toml'), 'utf8');
  const needed = /^rust-version = "([^"]+)"/m.exec(manifest)?.[1] ?? '0';
  const found = /^rustc (\S+)/.exec(output('rustc', ['--version']) ?? '')?.[1];
  if (!found || !output('cargo', ['--version'])) {
    throw new Error('Rust was not found: install rustup from https://rustup.rs, then run this again');
  }
  if (!atLeast(found, needed)) {
    throw new Error(`Rust ${needed} or newer is needed, this is ${found}: run \`rustup update stable\``);
  }
}

export async function javascriptPackages() {
  const done = await whenChanged(
    'packages',
    {
      inputs: ['package-lock.json', '.npmrc'],
      extra: [process.versions.modules],
      outputs: ['node_modules/vite', 'node_modules/typescript'],
    },
    () => {
      say('JavaScript packages (npm ci)');
      return run(npm, ['ci', '--no-audit', '--no-fund'], { shell: process.platform === 'win32' });
    },
  );
  if (!done) say('JavaScript packages are there');
}

/** That Node and Rust are new enough, and Rust's target for WebAssembly. */
export async function rust() {
  checkNode();
  checkRust();
  await rustTarget();
}

async function rustTarget() {
  const sysroot = output('rustc', ['--print', 'sysroot'])?.trim() ?? '';
  if (existsSync(join(sysroot, 'lib', 'rustlib', wasmTarget, 'lib'))) {
    say(`Rust target ${wasmTarget} is there`);
    return;
  }
  say(`Rust target ${wasmTarget} (rustup target add)`);
  await run('rustup', ['target', 'add', wasmTarget]);
}

/** The generator of bindings, in the version that the crates are compiled against. */
export function wasmBindgen() {
  const lock = readFileSync(join(root, 'Cargo.lock'), 'utf8');
  return cargoTool('wasm-bindgen', 'wasm-bindgen-cli', lockedVersion(lock, 'wasm-bindgen'), {
    // Tests run in Node: connections to browsers elsewhere, and with them TLS, are not needed.
    features: ['--no-default-features'],
    computes: ['gimli', 'id-arena', 'walrus', 'wasm-bindgen-cli-support', 'wasm-encoder', 'wasmparser'],
  });
}

/** For builds; the tests run wasm-pack as well. */
export async function setup({ wasmPack = false } = {}) {
  await rust();
  const cargoTools = async () => {
    await wasmBindgen();
    if (wasmPack) await cargoTool('wasm-pack', 'wasm-pack', wasmPackVersion);
  };
  await Promise.all([javascriptPackages(), cargoTools()]);
}

if (isMain(import.meta)) await main(() => setup({ wasmPack: true }));
