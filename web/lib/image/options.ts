import { own } from '../runtime/errors.js';
import type { CubeChainOptions, ImageFrameOptions } from '../types.js';

/** Options of the chain alone. */
export function chainOf(options: ImageFrameOptions): CubeChainOptions {
  const { from: _from, grid: _grid, ...chain } = own(options, 'options') as unknown as ImageFrameOptions;
  return { peakGrouping: false, maxDetections: 4096, ...chain };
}
