// Where a pool has its modules from.
import { BoresightError, failure, own, wrong } from '../lib/runtime/errors.js';
import { compileResponse } from '../lib/runtime/fetch-module.js';
import type { WasmSource } from '../lib/runtime/module.js';
import { registeredNetworks } from '../lib/runtime/networks-module.js';

/** A module: its address, a response, bytes, compiled, or a function that gives one of these when it is first needed. */
export type ModuleSource = WasmSource | Promise<WasmSource> | (() => WasmSource | Promise<WasmSource>);

/** Where a pool has its modules from; by default what comes with the package. */
export interface PoolModules {
  /** The package's `boresight.wasm`. */
  core?: ModuleSource;
  /** The package's `boresight_drives.wasm`. */
  drives?: ModuleSource;
  /** The package's `boresight_neural.wasm`; by default what importing `boresight/neural` registers. */
  networks?: ModuleSource;
}

/** The modules with the names of their files. */
const FILES = {
  core: 'boresight_bg.wasm',
  drives: 'boresight_drives_bg.wasm',
  networks: 'boresight_neural_bg.wasm',
} as const;
export type ModuleName = keyof typeof FILES;
const NAMES = Object.keys(FILES) as ModuleName[];

/** Compiles a module once; after a failure the next call tries again. */
class Loader {
  readonly #compile: () => Promise<WebAssembly.Module>;
  readonly #file: string;
  #pending: Promise<WebAssembly.Module> | undefined;
  module: WebAssembly.Module | undefined;

  constructor(compile: () => Promise<WebAssembly.Module>, file: string) {
    this.#compile = compile;
    this.#file = file;
  }

  async load(): Promise<void> {
    this.#pending ??= this.#compile();
    try {
      this.module = await this.#pending;
    } catch (cause) {
      this.#pending = undefined;
      if (cause instanceof BoresightError) throw cause;
      const given = cause instanceof Error ? cause.message : String(cause);
      const details = { what: 'WebAssembly module', expected: `the ${this.#file} of this package`, given };
      throw failure('not-loaded', details, cause);
    }
  }
}

export type Loaders = Record<ModuleName, Loader>;

/** The modules that options name before those that a runtime has; `fetched` compiles what is at an address. */
export function loadersOf(
  given: PoolModules | undefined,
  packaged: () => PoolModules,
  fetched: (address: URL) => Promise<WebAssembly.Module>,
): Loaders {
  const sources = own(given, 'modules', NAMES) as PoolModules;
  const loaders = NAMES.map((name) => {
    const source = sources[name];
    const compile = async (): Promise<WebAssembly.Module> => {
      const chosen = source ?? packaged()[name] ?? (name === 'networks' ? registeredNetworks() : undefined);
      if (chosen === undefined) throw absent(name);
      return compiledOf(await (typeof chosen === 'function' ? chosen() : chosen), `modules.${name}`, fetched);
    };
    return [name, new Loader(compile, FILES[name])];
  });
  return Object.fromEntries(loaders) as Loaders;
}

function absent(name: ModuleName): BoresightError {
  const how = name === 'networks' ? "an import of 'boresight/neural', or " : '';
  const details = {
    what: `the module of ${name}`,
    expected: `${how}\`modules.${name}\` of createPool`,
    given: 'absent',
  };
  return failure('no-module', details);
}

async function compiledOf(
  source: WasmSource,
  what: string,
  fetched: (address: URL) => Promise<WebAssembly.Module>,
): Promise<WebAssembly.Module> {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source === 'string' || source instanceof URL)
    return fetched(new URL(source, globalThis.document?.baseURI ?? globalThis.location?.href));
  if (source instanceof Request) return compileResponse(await fetch(source));
  if (source instanceof Response) return compileResponse(source);
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  throw wrong(what, 'an address, a Response, bytes or a compiled module', source);
}
