// CSV that leaves the demo opens in spreadsheets as what it says.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { transformWithOxc } from 'vite';

const source = new URL('../../web/app/plots/save.ts', import.meta.url);
const { code } = await transformWithOxc(await readFile(source, 'utf8'), source.pathname);
const { toCsv } = await import(`data:text/javascript,${encodeURIComponent(code)}`);

test('text that begins as formulas do stays text, and numbers stay numbers', () => {
  const row = ['=1+1', '+cmd|x', '-2+3', '@SUM(A1)', '\t=1', '-1.5', -1.5, '−3', 'a,"b"', null, Number.NaN];
  assert.equal(toCsv(['a'], [row]), `a\r\n'=1+1,'+cmd|x,'-2+3,'@SUM(A1),'\t=1,-1.5,-1.5,−3,"a,""b""",,\r\n`);
});
