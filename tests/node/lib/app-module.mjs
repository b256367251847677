// A module of the web sources that imports nothing, as it is there.
import { readFile } from 'node:fs/promises';
import { transformWithOxc } from 'vite';

export async function appModule(path) {
  const source = new URL(`../../../web/${path}`, import.meta.url);
  const { code } = await transformWithOxc(await readFile(source, 'utf8'), source.pathname);
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}
