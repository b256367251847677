import { files as built } from '../dist/page.js';
import { Problem } from './reply.js';

/** @type {Record<string, { type: string, text: string }>} */
const files = built;

const POLICY =
  "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/** A file of the page, which build.mjs has put into one module. @param {string} path */
export function page(path) {
  const file = Object.hasOwn(files, path) ? files[path] : undefined;
  if (!file) throw new Problem(404, 'not-found', { what: 'path', expected: 'a file of the page', given: 'another' });
  const headers = {
    'content-type': `${file.type}; charset=utf-8`,
    'cache-control': 'no-cache',
    'content-security-policy': POLICY,
    'referrer-policy': 'no-referrer',
  };
  return new Response(file.text, { headers });
}
