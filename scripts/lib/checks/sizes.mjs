import { brotli, gzip } from '../build/compressed.mjs';

/** Bytes raw, and with gzip and Brotli as they are served. */
export async function sizes(content) {
  const [gzipped, packed] = await Promise.all([gzip(content), brotli(content)]);
  return { raw: content.length, gzip: gzipped.length, brotli: packed.length };
}

const kilobytes = (bytes) => `${(bytes / 1000).toFixed(1)} KB`;

export const describeSize = (name, { raw, gzip, brotli }) =>
  `${name}: ${kilobytes(raw)} raw, ${kilobytes(gzip)} gzip, ${kilobytes(brotli)} brotli`;

/**
 * Of the core module: what a page loads at once. Array calibration, folds, other multiplexings, layouts of boards and explained
 * cells took it from 408 KB to 527; the limit was 410.
 */
export const coreLimits = { brotli: 535_000 };
export const neuralLimits = { brotli: 3_000_000 };
/** Of the core, drives and pool in one file, which holds its modules as gzip in base64. */
export const inlineLimits = { raw: 2_100_000, brotli: 1_510_000 };
/** That with the elements: what a notebook sends for each widget. */
export const notebookLimits = { raw: 2_280_000 };
/** Of the extension for viewers, which is a ZIP archive: what is installed. */
export const foxgloveLimits = { raw: 900_000 };

/** What is wrong with a size, or null. */
export const overLimit = (size, limits = coreLimits) =>
  Object.entries(limits)
    .filter(([form, limit]) => size[form] > limit)
    .map(([form, limit]) => `${kilobytes(size[form])} ${form}, the limit is ${kilobytes(limit)}`)
    .join('; ') || null;
