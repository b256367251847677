// A module of the web sources that imports nothing, as it is there.
import { readFile } from 'node:fs/promises';
import { build, transformWithOxc } from 'vite';

export async function appModule(path) {
  const source = new URL(`../../../web/${path}`, import.meta.url);
  const { code } = await transformWithOxc(await readFile(source, 'utf8'), source.pathname);
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}

/** One that imports others, with them. */
export async function appBundle(path) {
  const entry = new URL(`../../../web/${path}`, import.meta.url).pathname;
  const options = { write: false, minify: false, lib: { entry, formats: ['es'] } };
  const [{ output }] = await build({ configFile: false, logLevel: 'silent', build: options });
  return import(`data:text/javascript,${encodeURIComponent(output[0].code)}`);
}
