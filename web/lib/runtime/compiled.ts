const modules = new Map<string, Promise<WebAssembly.Module>>();

/**
 * The module at an address, compiled once for all that need it: the instance of this thread, and the pools that hand it to
 * their workers. After a failure the next call tries again.
 */
export function compiled(
  address: URL,
  compile: (address: URL) => Promise<WebAssembly.Module>,
): Promise<WebAssembly.Module> {
  const key = address.href;
  const module =
    modules.get(key) ??
    compile(address).catch((error: unknown) => {
      modules.delete(key);
      throw error;
    });
  modules.set(key, module);
  return module;
}
