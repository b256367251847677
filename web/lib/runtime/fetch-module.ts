import { compiled } from './compiled.js';

/** Fetches and compiles a module, in browsers. */
export const fetchModule = (address: URL): Promise<WebAssembly.Module> =>
  compiled(address, async (address) => compileResponse(await fetch(address)));

/** Compiles what a server answered. */
export async function compileResponse(response: Response): Promise<WebAssembly.Module> {
  if (!response.ok) throw new Error(`${response.url} answered ${response.status}`);
  // Streaming needs the right media type, which not every server sends.
  const typed = response.headers.get('Content-Type')?.startsWith('application/wasm');
  if (typed) return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}
