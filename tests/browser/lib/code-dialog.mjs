/**
 * “Copy as code” as a reader uses it, and what of a page its code has to give. What the dialog gives is run (code-run.mjs):
 * JavaScript has to give every bit of the page's numbers; the command line is another program, and gives them to `close`.
 */
import assert from 'node:assert/strict';
import { patient } from './trial.mjs';

const WAYS = [
  ['javascript', 'JavaScript'],
  ['commandLine', 'Command line'],
];

/** Opens the dialog. */
export async function openCode(page) {
  await page.locator('[data-action="show-code"]').click();
  const dialog = page.locator('[data-dialog="code"]');
  await dialog.waitFor();
  return dialog;
}

/** What the dialog shows, by way: the text, what it needs, and what of the page is not in it. */
export async function codeOf(page) {
  const dialog = await openCode(page);
  const shown = {};
  for (const [name, title] of WAYS) {
    await dialog.getByRole('tab', { name: title }).click();
    const panel = dialog.locator(`[data-code="${name}"]`);
    await panel.waitFor();
    const [text = ''] = await panel.locator('pre').allTextContents();
    const [needs = ''] = await panel.locator('[data-needs]').allTextContents();
    shown[name] = { text, needs, lacks: await panel.locator('.lacks li').allTextContents() };
  }
  await page.keyboard.press('Escape');
  await dialog.waitFor({ state: 'detached' });
  return shown;
}

/** Rows of a table by name, each with its numbers (and truths) by field; those of several targets are lists. */
export const tableOf = (page, table) =>
  page.locator(`[data-table="${table}"] [data-row]`).evaluateAll((rows) => {
    const all = {};
    for (const row of rows) {
      all[row.dataset.row] ??= {};
      const fields = all[row.dataset.row];
      for (const { dataset } of row.querySelectorAll('[data-field]')) {
        if (dataset.value === undefined) continue;
        fields[dataset.field] ??= [];
        fields[dataset.field].push(Number.isNaN(Number(dataset.value)) ? dataset.value : Number(dataset.value));
      }
    }
    return all;
  });

/** Waits until rows are there and of the present state. */
export const settled = (page, table, names, done = '[data-value]') =>
  page.waitForFunction(
    ([table, names, done]) =>
      names.every((name) => {
        const rows = [...document.querySelectorAll(`[data-table="${table}"] [data-row="${name}"]`)];
        return rows.some((row) => row.querySelector(done)) && rows.every((row) => !row.matches('[aria-busy="true"]'));
      }),
    [table, names, done],
    patient,
  );

/** Lines of a script by their first word, without it. */
export function linesBy(lines) {
  const by = new Map();
  for (const [name, ...values] of lines) by.set(name, [...(by.get(name) ?? []), values]);
  return by;
}

export function assertNear(actual, expected, close, what) {
  assert.ok(Math.abs(actual - expected) <= close, `${what}: ${actual} and ${expected}`);
}

/** Sources that the command line lists, beside the lines that a script printed. */
export function assertListed(listed, printed, close, what) {
  assert.equal(listed.length, printed.length, what);
  listed.forEach(({ azimuthDeg, powerDb }, k) => {
    assertNear(azimuthDeg, printed[k][0], close, `${what}, azimuth`);
    assertNear(powerDb, printed[k][1], close, `${what}, power`);
  });
}
