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
/**
 * Of the core, drives and pool in one file. The limits were 1.4 MB and 970 KB before the core grew, and 1.1 MB before the drives
 * module checked HDF5 headers and handled clock resets, which take 12 KB.
 */
export const inlineLimits = { raw: 1_560_000, brotli: 1_110_000 };
/** That with the elements: what a notebook sends for each widget. It was 1.6 MB before the core grew. */
export const notebookLimits = { raw: 1_740_000 };
/**
 * Of the extension for viewers, which is a ZIP archive: what is installed. The limit was 700 KB before drives of a vehicle were put together with
 * errors of their own (`calibrate::merge_drives`), which `mergeCalibrations` of the module of drives is one radar of, and 715 KB before
 * the drives module checked HDF5 headers and handled clock resets.
 */
export const foxgloveLimits = { raw: 730_000 };

/** What is wrong with a size, or null. */
export const overLimit = (size, limits = coreLimits) =>
  Object.entries(limits)
    .filter(([form, limit]) => size[form] > limit)
    .map(([form, limit]) => `${kilobytes(size[form])} ${form}, the limit is ${kilobytes(limit)}`)
    .join('; ') || null;
