import { promisify } from 'node:util';
import { brotliCompress, constants, gzip } from 'node:zlib';

const packers = [promisify(gzip), promisify(brotliCompress)];

/** Bytes raw, with gzip -9 and with Brotli at quality 11, which takes half a minute of the module of networks. */
export async function sizes(content) {
  const params = { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: content.length };
  const [gzipped, brotli] = await Promise.all(packers.map((pack) => pack(content, { level: 9, params })));
  return { raw: content.length, gzip: gzipped.length, brotli: brotli.length };
}

const kilobytes = (bytes) => `${(bytes / 1000).toFixed(1)} KB`;

export const describeSize = (name, { raw, gzip, brotli }) =>
  `${name}: ${kilobytes(raw)} raw, ${kilobytes(gzip)} gzip, ${kilobytes(brotli)} brotli`;

/** Of the core module: what a page loads at once. */
export const brotliLimit = 410_000;
export const neuralBrotliLimit = 3_000_000;

/** What is wrong with a size, or null. */
export const overLimit = ({ brotli }, limit = brotliLimit) =>
  brotli > limit ? `${kilobytes(brotli)} brotli, the limit is ${kilobytes(limit)}` : null;
