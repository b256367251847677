import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { optionsModule, pythonFiles, resultsModule, snakeCase } from '../../scripts/lib/python/python-types.mjs';

test("Python's types are those of the descriptions", () => {
  for (const [name, text] of pythonFiles())
    assert.ok(readFileSync(join(root, name), 'utf8') === text, `${name} is stale: \`npm run generate\` writes it`);
});

test('options are called as in Python, and their flags as on the command line', () => {
  assert.equal(snakeCase('minSpeedMps'), 'min_speed_mps');
  assert.equal(snakeCase('xM'), 'x_m');
  const [, options] = pythonFiles()[0];
  for (const line of [
    '    "min_speed_mps": ("--min-speed", "value"),',
    '    "iaa_threshold_db": ("--iaa-threshold", "value"),',
    '    "radar_topics": ("--radar-topics", "list"),',
    '    "forward_backward": ("--forward-backward", "truth"),',
  ])
    assert.ok(options.includes(`\n${line}\n`), line);
  const schema = JSON.parse(readFileSync(join(root, 'web/lib/generated/schema.json'), 'utf8'));
  const peakGrouping = schema.$defs.DetectionOptions.properties.peakGrouping;
  const properties = { ...schema.$defs.SharedEstimatorOptions.properties, peakGrouping };
  const $defs = { ...schema.$defs, SharedEstimatorOptions: { description: '.', properties } };
  const typescript = readFileSync(join(root, 'web/lib/generated/options.ts'), 'utf8');
  assert.match(optionsModule({ $defs }, typescript, '1'), /"peak_grouping": \("--no-peak-grouping", "no"\),/);
});

test('what TypeScript says otherwise than expected is an error, and not left out', () => {
  const others = ['CalibrationOutlook', 'Source', 'Fleet'].map(
    (name) => `/** C. */\nexport interface ${name} {\n  /** D. */\n  d: number;\n}\n`,
  );
  const results = (type) =>
    `/** A. */\nexport interface CalibrationResult {\n  /** B. */\n  b: ${type};\n}\n${others.join('')}`;
  assert.match(resultsModule(results('[x: number, y: number][]')), /\n {4}b: list\[list\[float\]\]\n/);
  assert.match(resultsModule(results('string | null')), /\n {4}b: str \| None\n/);
  assert.throws(() => resultsModule(results('Map<string, number>')), /no type of Python is known for Map/);
  assert.throws(() => resultsModule(results('Absent')), /TypeScript has no Absent/);
});
