// Puts tables that a command printed where a document marks their place:
//
//     <!-- tables: aoa | Largest F1; Recall -->
//     <!-- end of tables -->
//
// stands for the tables of `aoa` whose titles begin with one of these, in the order they are printed; without titles for
// all of them.

const PLACE = /(<!-- tables: ([\w-]+)(?: \| ([^>]*?))? -->)[\s\S]*?(<!-- end of tables -->)/g;

/** Title and rows of each table of a text: paragraphs that begin with `|`, and the one before each. */
export function tablesOf(text) {
  const paragraphs = text.trim().split(/\n{2,}/);
  return paragraphs.flatMap((rows, i) => (rows.startsWith('|') ? [{ title: paragraphs[i - 1] ?? '', rows }] : []));
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
