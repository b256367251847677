/** Sums lines and covered lines by the first group of `pattern` in each path. Files without a match are left out. */
export function linesByFolder(files, pattern) {
  const sums = new Map();
  for (const { path, lines, covered } of files) {
    const name = pattern.exec(path.replaceAll('\\', '/'))?.[1];
    if (name === undefined) continue;
    const sum = sums.get(name) ?? { name, lines: 0, covered: 0 };
    sum.lines += lines;
    sum.covered += covered;
    sums.set(name, sum);
  }
  return [...sums.values()].sort((a, b) => a.name.localeCompare(b.name));
}

/** A Markdown table of the folders, with a total row. */
export function coverageTable(head, folders) {
  const total = { name: 'total', lines: 0, covered: 0 };
  for (const { lines, covered } of folders) {
    total.lines += lines;
    total.covered += covered;
  }
  const rows = [...folders, total].map(
    ({ name, lines, covered }) => `| ${name} | ${lines} | ${((100 * covered) / Math.max(lines, 1)).toFixed(1)} % |`,
  );
  return [`| ${head} | lines | covered |`, '| --- | ---: | ---: |', ...rows].join('\n');
}
