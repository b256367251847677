// What a worker can do: the plain functions of the package, and pieces of the batch helpers.
import * as api from '../lib/api.js';
import type { Estimate, EstimateInput, EstimatorOptions } from '../lib/api.js';

/** Estimates of many inputs with one estimator. */
function estimateMany(inputs: readonly EstimateInput[], options: EstimatorOptions): Estimate[] {
  const estimator = new api.Estimator(options);
  try {
    return inputs.map((input) => estimator.estimate(input));
  } finally {
    estimator.free();
  }
}

export const operations = {
  version: api.version,
  methods: api.methods,
  arrayPresets: api.arrayPresets,
  array: api.array,
  estimate: api.estimate,
  countSources: api.countSources,
  cramerRaoBound: api.cramerRaoBound,
  waveformSummary: api.waveformSummary,
  parseConfig: api.parseConfig,
  parseBoardLog: api.parseBoardLog,
  readNpy: api.readNpy,
  writeNpy: api.writeNpy,
  readDetectionsCsv: api.readDetectionsCsv,
  writeDetectionsCsv: api.writeDetectionsCsv,
  readSnapshotsCsv: api.readSnapshotsCsv,
  writeSnapshotsCsv: api.writeSnapshotsCsv,
  estimateMany,
};
