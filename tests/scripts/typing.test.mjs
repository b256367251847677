import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';

const folder = new URL('../browser/', import.meta.url);

test('browser tests type into fields key by key: fill() hides what a re-render does to half a number', () => {
  const files = readdirSync(folder).filter((name) => name.endsWith('.mjs'));
  assert.ok(files.length > 5);
  for (const name of files) assert.doesNotMatch(readFileSync(new URL(name, folder), 'utf8'), /\.fill\(/, name);
});
