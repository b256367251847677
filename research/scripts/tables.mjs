// Puts tables that a command printed where a document marks their place:
//
//     <!-- tables: aoa | Largest F1; Recall -->
//     <!-- end of tables -->
//
// stands for the tables of `aoa` whose titles begin with one of these, in the order they are printed; without titles for
// all of them.

const PLACE = /(<!-- tables: ([\w-]+)(?: \| ([^>]*?))? -->)[\s\S]*?(<!-- end of tables -->)/g;

/** How the paragraph after a table begins that states its standard errors. */
const ERRORS = 'Standard errors: ';

/**
 * Title and rows of each table of a text: paragraphs that begin with `|`, the one before each, and the one after it where
 * that states standard errors.
 */
export function tablesOf(text) {
  const paragraphs = text.trim().split(/\n{2,}/);
  return paragraphs.flatMap((table, i) => {
    if (!table.startsWith('|')) return [];
    const next = paragraphs[i + 1] ?? '';
    const rows = next.startsWith(ERRORS) ? `${table}\n\n${next}` : table;
    return [{ title: paragraphs[i - 1] ?? '', rows }];
  });
}

/** The document with the tables of `printed`, a text by name, in their places; other names keep what they have. */
export function withTables(document, printed) {
  return document.replace(PLACE, (all, begin, name, titles, end) => {
    if (!(name in printed)) return all;
    const tables = tablesOf(printed[name]);
    const wanted = titles?.split(';').map((title) => title.trim()) ?? [''];
    for (const title of wanted)
      if (!tables.some((table) => table.title.startsWith(title))) throw new Error(`${name} has no table "${title}"`);
    const shown = tables.filter(({ title }) => wanted.some((one) => title.startsWith(one)));
    return [begin, ...shown.map(({ title, rows }) => `**${title}**\n\n${rows}`), end].join('\n\n');
  });
}
