/** Tables of pages as a reader sees them, found by the role and name of their rows. */

/** A row of a table within a page or a part of it, by what its first cell says. */
export function row(scope, name) {
  const literal = name.replaceAll(/[.*+?^${}()|[\]\\]/g, String.raw`\$&`);
  return scope.getByRole('row', { name: new RegExp(String.raw`^\s*${literal}(\s|$)`) });
}

/** Waits until a cell of a row has a text that matches, and returns it. */
export async function cellOf(scope, name, column, matches = /\d/) {
  const cell = row(scope, name).getByRole('cell').nth(column).filter({ hasText: matches });
  await cell.waitFor({ timeout: 60_000 });
  return (await cell.innerText()).trim();
}

/** A number as pages write it: with a minus sign, thin spaces between thousands and perhaps a unit. */
export const numberOf = (text) =>
  Number.parseFloat(
    text
      .replaceAll('−', '-')
      .replaceAll('±', '')
      .replaceAll(/(?<=\d)\s(?=\d)/g, ''),
  );
