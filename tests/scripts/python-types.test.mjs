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
  assert.match(optionsModule({ $defs }, '1'), /"peak_grouping": \("--no-peak-grouping", "no"\),/);
});

test('a type that Python has no name for is an error, and not left out', () => {
  const record = (b) => ({
    type: 'object',
    description: 'A.',
    properties: { b: { ...b, description: 'B.' } },
    required: ['b'],
  });
  const plain = record({ type: 'number' });
  const results = (b) =>
    resultsModule({
      $defs: { CalibrationResult: record(b), CalibrationOutlook: plain, Source: plain, Fleet: plain },
    });
  const pairs = { type: 'array', items: { type: 'array', items: { type: 'number' } } };
  assert.match(results(pairs), /\n {4}b: list\[list\[float\]\]\n/);
  assert.match(results({ anyOf: [{ type: 'string' }, { type: 'null' }] }), /\n {4}b: str \| None\n/);
  assert.throws(() => results({ 'x-typescript': 'Map<string, number>' }), /no type of Python is known for .*Map/);
  assert.throws(() => results({ $ref: '#/$defs/Absent' }), /the schema of results has no Absent/);
});
