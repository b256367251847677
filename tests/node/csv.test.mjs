// CSV that leaves the demo opens in spreadsheets as what it says.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { appModule } from './lib/app-module.mjs';

const { toCsv } = await appModule('plots/save.ts');

test('text that begins as formulas do stays text, and numbers stay numbers', () => {
  const row = ['=1+1', '+cmd|x', '-2+3', '@SUM(A1)', '\t=1', '-1.5', -1.5, '−3', 'a,"b"', null, Number.NaN];
  assert.equal(toCsv(['a'], [row]), `a\r\n'=1+1,'+cmd|x,'-2+3,'@SUM(A1),'\t=1,-1.5,-1.5,−3,"a,""b""",,\r\n`);
});
