import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { typingProblems } from '../../scripts/lib/checks/typing-rules.mjs';

const folder = new URL('../browser/', import.meta.url);

test('browser tests fill in fields key by key', () => {
  const files = readdirSync(folder, { recursive: true }).filter((name) => name.endsWith('.mjs'));
  assert.ok(files.length > 20);
  const found = files.flatMap((name) =>
    typingProblems(readFileSync(new URL(name, folder), 'utf8')).map((problem) => `${name}:${problem}`),
  );
  assert.deepEqual(found, []);
});

test('each way around the keys is found, and what only reads is not', () => {
  for (const line of [
    "await page.locator('input').fill('3');",
    "await page.fill('input', '3');",
    '  .fill (text);',
    "await field['fill'](text);",
    "await field.evaluate((input) => { input.value = '3'; });",
    "document.querySelector('input').value='3';",
    'input.value += 3;',
    'input.value ??= 3;',
    'input.valueAsNumber = 3;',
    'box.checked = true;',
    'list.selectedIndex = 2;',
    "Object.assign(input, { value: '3' });",
    "await page.keyboard.insertText('3');",
    'input.stepUp();',
    "input.dispatchEvent(new Event('input', { bubbles: true }));",
    "input.dispatchEvent(new InputEvent('change'));",
  ])
    assert.equal(typingProblems(`\n${line}\n`).length > 0, true, line);
  for (const line of [
    "await typeNumber(field, '3');",
    "await field.press('ControlOrMeta+a');",
    "assert.equal(await page.locator('input').inputValue(), '3');",
    "page.waitForFunction(() => document.querySelector('select').value === 'files');",
    'const { value, max } = button.parentElement.querySelector("progress");',
    'cells.map((cell) => cell.dataset.value)',
    'const filled = (value) => value >= 3 || value <= 2;',
    '// What fill( ) would hide.',
    " * `input.value = '3'` is what this is about.",
    "window.dispatchEvent(new DragEvent('drop', { dataTransfer }));",
  ])
    assert.deepEqual(typingProblems(line), [], line);
  assert.match(typingProblems('\n\ninput.value = 3;')[0], /^3: /);
});
