/** The dialog of “Copy as code”, as a reader uses it. */

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
