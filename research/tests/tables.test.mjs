import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { tablesOf, withTables } from '../scripts/tables.mjs';

const printed = `Array lrr48.

Largest F1, 15 dB

| method | 2 |
|---|---|
| iaa | 0.9 |

Standard errors: 0.001 to 0.002.

Recall, 15 dB

| method | 2 |
|---|---|
| iaa | 0.8 |
`;
const place = (what, within) => `Before.\n\n<!-- tables: ${what} -->${within}<!-- end of tables -->\n\nAfter.\n`;

test('tables take the places marked for them, again and again', () => {
  assert.deepEqual(
    tablesOf(printed).map(({ title }) => title),
    ['Largest F1, 15 dB', 'Recall, 15 dB'],
  );
  const once = withTables(place('aoa | Recall', '\nold\n'), { aoa: printed });
  const recall = '\n\n**Recall, 15 dB**\n\n| method | 2 |\n|---|---|\n| iaa | 0.8 |\n\n';
  assert.equal(once, place('aoa | Recall', recall));
  assert.equal(withTables(once, { aoa: printed }), once);
  const all = withTables(place('aoa', '\n'), { aoa: printed });
  assert.match(all, /Largest F1, 15 dB[\s\S]*0\.9 \|\n\nStandard errors: 0\.001 to 0\.002\.\n\n\*\*Recall, 15 dB/);
});

test('what another command prints stays, and a title that none has is an error', () => {
  const document = place('doa', '\nold\n') + place('aoa | Recall; Largest', '\n');
  const filled = withTables(document, { aoa: printed });
  assert.match(filled, /tables: doa -->\nold\n/);
  assert.match(filled, /Largest F1, 15 dB[\s\S]*Recall, 15 dB/);
  assert.throws(() => withTables(place('aoa | Precision', '\n'), { aoa: printed }), /no table "Precision"/);
});

test('the documents of the experiments mark places', () => {
  for (const [document, count] of [
    ['aoa', 6],
    ['arrays', 2],
    ['doa', 5],
    ['low-snr', 1],
    ['resolution', 1],
    ['straddling', 1],
    ['near-field', 2],
    ['imperfections', 2],
    ['images', 2],
  ]) {
    const text = readFileSync(join(root, 'research', 'results', `${document}.md`), 'utf8');
    assert.equal(text.match(/<!-- tables: /g).length, count);
    assert.equal(text.match(/<!-- end of tables -->/g).length, count);
  }
});
