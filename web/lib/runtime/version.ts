import * as glue from '../../wasm/boresight.js';
import { call } from './instance.js';

/** Version of the package. */
export function version(): string {
  return call(() => glue.version());
}
