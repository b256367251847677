import * as glue from '../../wasm/boresight_drives.js';
import { drives } from '../drive/drive.js';
import type { TextInput } from '../types.js';

/**
 * Translates the configuration that mmWave Studio writes (`.mmwave.json`) into the text of a `.cfg` file. The board
 * is named in `setup` (`.setup.json`); without it, choose an array by hand.
 *
 * It is in the module that `initDrives()` loads.
 *
 * @throws BoresightError `config-value` with the path of a field that is missing or has a value that is not supported.
 */
export function studioConfig(mmwave: TextInput, setup?: TextInput): string {
  return drives.call(() => glue.studioConfig(mmwave, setup));
}
