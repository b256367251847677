import type { CubeChainOptions, ImageFrameOptions } from './types.js';

/** Options of the chain alone. */
export function chainOf({ from: _from, grid: _grid, ...options }: ImageFrameOptions): CubeChainOptions {
  return { peakGrouping: false, maxDetections: 4096, ...options };
}
