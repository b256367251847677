// What is compared: methods, data and options the same on both sides.
import { makeScenes } from './data.mjs';

const range = (count) => Array.from({ length: count }, (_, k) => k);

/** Virtual elements of the preset `lrr48`, half wavelengths. */
const lrr48 = [0, 18, 30, 42, 62, 78].flatMap((tx) => [0, 3, 4, 5, 7, 8, 13, 14].map((rx) => tx + rx));

/** Three sources of 0 dB, about five beamwidths of 32 elements apart. */
const threeSources = { u: [-0.35, 0.09, 0.41], jitter: 0.05, snrDb: 20, scenes: 8 };

/** Twice as many snapshots as elements, the rule of Reed, Mallett and Brennan (1974). */
const many = { ...threeSources, positions: range(32), snapshots: 64, seed: 1 };
const single = { ...threeSources, positions: range(32), snapshots: 1, seed: 2 };

const shared = { gridPoints: 1024, dynamicRangeDb: 10, maxPeaks: 16 };
const known = { sources: 3 };
const nomp = {
  falseAlarm: 1e-2,
  noisePower: 0.01,
  oversampling: 4,
  singleRefinements: 3,
  cyclicRefinements: 3,
  maxSources: 16,
};
const learning = { gridPoints: 256, maxIterations: 100, tolerance: 1e-15 };

/**
 * `differDeg`: how far the two sides' angles may lie apart. Both go to the exact top of a spectrum,
 * or through the same iterations, so that rounding is all that is left; NOMP ends in polishing on
 * one side alone, sparse learning moves peaks differently between grid points, and IAA is single
 * precision where that is good to 0.001 deg.
 */
export const classical = [
  { method: 'bartlett', scenes: many, options: {}, differDeg: 1e-6 },
  { method: 'bartlett', scenes: single, options: {}, differDeg: 1e-6 },
  { method: 'capon', scenes: many, options: {}, differDeg: 1e-6 },
  { method: 'music', scenes: many, options: known, differDeg: 1e-6 },
  { method: 'single-snapshot-music', scenes: single, options: known, differDeg: 1e-6 },
  { method: 'root-music', scenes: many, options: known, differDeg: 1e-6 },
  { method: 'esprit', scenes: many, options: known, differDeg: 1e-6 },
  { method: 'min-norm', scenes: many, options: known, differDeg: 1e-6 },
  { method: 'iaa', scenes: single, options: { iaa: { iterations: 15 } }, differDeg: 1e-3 },
  { method: 'nomp', scenes: single, options: { nomp }, differDeg: 1e-3 },
  {
    method: 'maximum-likelihood',
    scenes: many,
    options: { ...known, maxIterations: 200, tolerance: 1e-8 },
    differDeg: 1e-4,
  },
  { method: 'sparse-bayesian', scenes: single, options: learning, differDeg: 0.05 },
].map(({ method, scenes, options, differDeg }) => ({
  name: `${method}, ${scenes.snapshots === 1 ? '1 snapshot' : `${scenes.snapshots} snapshots`}`,
  method,
  scenes,
  sources: scenes.u.length,
  differDeg,
  options: { method, array: 'ula32', ...shared, ...options },
  numpy: { method, options: { ...shared, ...known, ...options, iterations: options.iaa?.iterations } },
}));

const iaaScenes = {
  positions: lrr48,
  u: [-0.52, -0.2, 0.04, 0.31, 0.6],
  jitter: 0.05,
  snrDb: 25,
  snapshots: 1,
  scenes: 8,
  seed: 3,
};
const iaaOptions = (form) => ({ method: 'iaa', array: 'lrr48', ...shared, iaa: { iterations: 15, form } });

/** IAA, 48 elements, 1024 angles, 15 iterations. */
export const iaa48 = {
  scenes: iaaScenes,
  sources: 5,
  differDeg: 1e-3,
  batch: 64,
  cells: 500,
  fast: iaaOptions('fast'),
  dense: iaaOptions('dense'),
  numpy: (method) => ({ method, options: { ...shared, iterations: 15 } }),
};

export const scenesOf = (what) => makeScenes(what);

/** 256 samples, 128 loops, 2 x 4 channels: cells of targets as [range bin, Doppler bin]. */
export const cube = {
  loops: 128,
  channels: 8,
  samples: 256,
  amplitude: 0.05,
  seed: 4,
  cells: [
    [17, 3],
    [40, 100],
    [58, 64],
    [58, 20],
    [97, 64],
    [120, 45],
    [151, 90],
    [199, 12],
    [222, 71],
    [210, 33],
  ],
  options: {
    array: 'awr1642',
    rangeWindow: 'hann',
    dopplerWindow: 'hann',
    cfar: { kind: 'cell-averaging', axes: 'both', falseAlarm: 1e-6, guardCells: [2, 2], trainingCells: [8, 4] },
    waveform: {
      startFrequencyHz: 77e9,
      slopeHzPerS: 60e12,
      sampleRateHz: 10e6,
      samples: 256,
      adcStartS: 6e-6,
      chirpIntervalS: 45e-6,
      transmitters: 2,
      loops: 128,
      frameIntervalS: 40e-3,
    },
  },
};

/** RANSAC on frames of 100 detections of which 30 move, and an hour of them. */
export const drive = {
  frames: 64,
  hour: 3600 * 13.5,
  make: {
    detections: 100,
    moving: 0.3,
    mounting: { id: 1, xM: 3.86, yM: 0.7, yawDeg: 24, trueYawDeg: 25 },
    noise: { rangeRateMps: 0.1, azimuthDeg: 0.3 },
    seed: 6,
  },
  ransac: { inlierResidualMps: 0.3, confidence: 0.999, inlierRatioThreshold: 0.3, minInliers: 5 },
  // All refine until their inliers stay the same, most often the same ones; different draws may end in sets
  // that differ by a few detections. Cosines are single precision on one side.
  differMps: { median: 1e-4, most: 0.05 },
};
