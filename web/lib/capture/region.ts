import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { ComplexData, RegionOfInterest, RegionOptions } from '../types.js';

/** The range bins around the strongest of a cube of one frame, as networks take them (Sang et al. 2021). */
export function strongestRegion(cube: ComplexData, options?: RegionOptions): RegionOfInterest {
  return call(() => glue.strongestRegion(cube, options) as RegionOfInterest);
}
