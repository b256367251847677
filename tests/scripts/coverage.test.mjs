import assert from 'node:assert/strict';
import { test } from 'node:test';
import { coverageTable, linesByFolder } from '../../scripts/lib/coverage.mjs';

test('coverage is added up by crate', () => {
  const files = [
    { path: '/checkout/crates/math/src/fft.rs', lines: 60, covered: 60 },
    { path: '/checkout/crates/math/src/linalg/small.rs', lines: 40, covered: 30 },
    { path: 'C:\\checkout\\crates\\aoa\\src\\lib.rs', lines: 10, covered: 0 },
    { path: '/registry/serde/src/lib.rs', lines: 1000, covered: 0 },
  ];
  const folders = linesByFolder(files, /\/crates\/(.+?)\/src\//);
  assert.deepEqual(folders, [
    { name: 'aoa', lines: 10, covered: 0 },
    { name: 'math', lines: 100, covered: 90 },
  ]);
  assert.match(coverageTable('crate', folders), /\| math \| 100 \| 90\.0 % \|\n\| total \| 110 \| 81\.8 % \|$/);
  assert.match(coverageTable('crate', []), /\| total \| 0 \| 0\.0 % \|$/);
});
