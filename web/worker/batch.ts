// A batch of cells in pieces, and the pieces' results as one.
import type { BatchEstimate, BatchInput, BatchSpectra, BatchWarning } from '../lib/types.js';
import { split } from './split.js';

/** The cells in consecutive stretches; all in one where a worker has to say what is wrong with them. */
export function stretchesOf(input: BatchInput, most: number): { input: BatchInput; cells: number }[] {
  const { data, shape } = input?.snapshots ?? {};
  const [cells = 0, ...cell] = Array.isArray(shape) ? shape : [];
  const numbers = 2 * cell.reduce((product, n) => product * n, 1);
  const isData = data instanceof Float32Array || data instanceof Float64Array;
  if (!isData || data.length === 0 || data.length !== cells * numbers) return [{ input, cells: 1 }];
  return split(cells, most).map(({ first, count }) => {
    const part = data.subarray(first * numbers, (first + count) * numbers);
    return {
      input: { ...input, snapshots: { ...input.snapshots, data: part, shape: [count, ...cell] } },
      cells: count,
    };
  });
}

/** The estimates of consecutive stretches as one. */
export function joinedBatches([first, ...rest]: [BatchEstimate, ...BatchEstimate[]]): BatchEstimate {
  if (rest.length === 0) return first;
  const parts = [first, ...rest];
  let cells = 0;
  const cell = parts.map((part) => {
    const before = cells;
    cells += part.cells;
    return part.cell.map((index) => index + before);
  });
  const warnings = new Map<string, BatchWarning>();
  for (const warning of parts.flatMap((part) => part.warnings)) {
    const known = warnings.get(warning.code);
    if (known) known.cells += warning.cells;
    else warnings.set(warning.code, { ...warning });
  }
  const spectra = parts.flatMap((part) => part.spectra ?? []);
  return {
    method: first.method,
    cells,
    cell: filled(new Uint32Array(lengthOf(cell)), cell),
    azimuthDeg: joined(parts.map((part) => part.azimuthDeg)),
    elevationDeg: joined(parts.map((part) => part.elevationDeg)),
    powerDb: joined(parts.map((part) => part.powerDb)),
    ...(spectra[0] && { spectra: joinedSpectra(spectra[0], spectra, cells) }),
    unresolved: parts.reduce((sum, part) => sum + part.unresolved, 0),
    warnings: [...warnings.values()],
  };
}

function joinedSpectra(first: BatchSpectra, parts: BatchSpectra[], cells: number): BatchSpectra {
  const power = parts.map((part) => part.power);
  const shape: BatchSpectra['shape'] = [...first.shape];
  shape[0] = cells;
  return { ...first, power: filled(new Float32Array(lengthOf(power)), power), shape };
}

/** Arrays one after another. */
export function joined(parts: Float64Array[]): Float64Array {
  return filled(new Float64Array(lengthOf(parts)), parts);
}

function lengthOf(parts: { length: number }[]): number {
  return parts.reduce((sum, { length }) => sum + length, 0);
}

function filled<T extends Uint32Array | Float32Array | Float64Array>(whole: T, parts: T[]): T {
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
