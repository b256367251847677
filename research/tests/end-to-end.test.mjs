import assert from 'node:assert/strict';
import { test } from 'node:test';
import { endToEndTables } from '../scripts/end-to-end.mjs';
import { tablesOf } from '../scripts/tables.mjs';

/** A brief record of one level, with these shares counted and right. */
function record(counted, success) {
  const scenes = [
    ['none', 0],
    ['one', 1],
    ['apart', 2],
    ['together', 2],
  ];
  return {
    counters: ['MDL', 'counting'],
    methods: ['music', 'cnn3d-1', 'cnn3d-2', 'cnn3d-paper-2'],
    conditions: scenes.map(([targets, count]) => ({
      targets,
      snrDb: -10,
      counted: [[], [0, 1, 2, 3].map((n) => (n === count ? counted : 0))],
      methods: [null, { success }, { success }, { success: success / 2 }],
    })),
  };
}

test('whole frames stand beside told regions, right ones as a share of those counted rightly', () => {
  const [counted, angles] = tablesOf(endToEndTables(record(0.9, 0.8), record(0.8, 0.6), record(0, 0)));
  assert.match(counted.rows, /two, at one range \| told \| 90\.0 \|\n\| {2}\| end to end \| 80\.0 \|/);
  assert.match(
    angles.rows,
    /one, cnn3d-1 \| told \| 80\.0 \|\n.* all \| 60\.0 \|\n\| {2}\| counted rightly \| 75\.0 \|/,
  );
  assert.match(angles.rows, /own, cnn3d-paper-2 \| told \| 40\.0 \|/);
  // Nothing is a share of none.
  assert.match(angles.rows, /around 35 deg, counted rightly \| {2}\|$/);
});
