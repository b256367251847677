// The recorded capture of an AWR1642 board and what is known of it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

const file = (name) => readFileSync(new URL(`../../../recordings/awr1642/${name}`, import.meta.url));
export const cfg = file('profile.cfg');
export const bin = file('xwr16xx_crw_dca_module_2018_1015v2.bin');
export const dat = file('xwr16xx_crw_demo_visualizer_2018_1015v2.dat');

/** The board itself lists targets at 2.95 m, 10.8 deg to its right, and at 4.94 m, 1.8 deg to its left. */
export function assertTargets(detections) {
  const near = (range) => detections.find(({ rangeM }) => Math.abs(rangeM - range) <= 0.05);
  const [first, second] = [near(2.95), near(4.94)];
  assert.ok(first && second, JSON.stringify(detections));
  assert.ok(Math.abs(first.azimuthDeg + 10.8) <= 1, `first at ${first.azimuthDeg} deg`);
  assert.ok(Math.abs(second.azimuthDeg - 1.8) <= 3, `second at ${second.azimuthDeg} deg`);
}
