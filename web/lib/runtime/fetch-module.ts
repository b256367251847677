import { compiled } from './compiled.js';

/** Fetches and compiles a module, in browsers. */
export const fetchModule = (address: URL): Promise<WebAssembly.Module> => compiled(address, compile);

async function compile(address: URL): Promise<WebAssembly.Module> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${response.url} answered ${response.status}`);
  // Streaming needs the right media type, which not every server sends.
  const typed = response.headers.get('Content-Type')?.startsWith('application/wasm');
  if (typed) return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}
