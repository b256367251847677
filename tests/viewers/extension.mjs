/** The extension for Foxglove and Lichtblick as it is installed. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { strFromU8, unzipSync } from 'fflate';
import { foxeName, foxgloveFolder } from '../../scripts/lib/build/foxglove.mjs';

/** What is in the file: text by name. */
export const files = Object.fromEntries(
  Object.entries(unzipSync(readFileSync(join(foxgloveFolder, foxeName())))).map(([name, bytes]) => [
    name,
    strFromU8(bytes),
  ]),
);
/** The script. */
export const source = files['dist/extension.js'];

/** Asserts that a number is another, within a tolerance. */
export const near = (given, wanted, within = 1e-5) =>
  assert.ok(Math.abs(given - wanted) <= within, `${given} is ${wanted} to ${within}`);
