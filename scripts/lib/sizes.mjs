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
export const coreLimits = { brotli: 410_000 };
export const neuralLimits = { brotli: 3_000_000 };
/**
 * Of the core, drives and pool in one file. Readers of MCAP, ROS messages, point clouds and MATLAB arrays, and what finds out
 * signs, took it from 822 KB to 963 with HDF5 compiled for size; the limit was 950.
 */
export const inlineLimits = { raw: 1_400_000, brotli: 970_000 };
/** That with the elements: what a notebook sends for each widget. */
export const notebookLimits = { raw: 1_600_000 };
/** Of the extension for viewers, which is a ZIP archive: what is installed. */
export const foxgloveLimits = { raw: 700_000 };

/** What is wrong with a size, or null. */
export const overLimit = (size, limits = coreLimits) =>
  Object.entries(limits)
    .filter(([form, limit]) => size[form] > limit)
    .map(([form, limit]) => `${kilobytes(size[form])} ${form}, the limit is ${kilobytes(limit)}`)
    .join('; ') || null;
