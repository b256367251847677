/** What `npm run measure:setup` measures: name, part it belongs to, and the most seconds it may take; none for some. */
export const MEASURES = [
  { part: 'start', name: 'npm start: the demo is served', target: 300 },
  { part: 'start', name: 'npm start: networks are ready' },
  { part: 'cli', name: 'the command line, from nothing', target: 240 },
  { part: 'test', name: 'npm test, from nothing', target: 900 },
  { part: 'test', name: 'npm test, again', target: 240 },
  { part: 'edit', name: 'a line of crates/aoa changed, its tests run', target: 60 },
];

export const PARTS = [...new Set(MEASURES.map(({ part }) => part))];

/** The arguments of the command, or an error that names what is wrong with them. */
export function settings(args) {
  const given = { only: PARTS, cold: false, keep: false };
  for (let at = 0; at < args.length; at += 1) {
    if (args[at] === '--cold') given.cold = true;
    else if (args[at] === '--keep') given.keep = true;
    else if (args[at] === '--only') {
      at += 1;
      given.only = (args[at] ?? '').split(',');
    } else throw new Error(`unknown argument ${args[at]}; there are --only ${PARTS.join(',')}, --cold and --keep`);
  }
  const unknown = given.only.filter((part) => !PARTS.includes(part));
  if (unknown.length > 0) throw new Error(`no part “${unknown.join(', ')}”; there are ${PARTS.join(', ')}`);
  return given;
}

/** What a measure came to: `ok`, `missed` or `failed`. */
export function verdict({ target, seconds, problem }) {
  if (problem !== undefined) return 'failed';
  return target !== undefined && seconds > target ? 'missed' : 'ok';
}

/** Table of what was measured. */
export function table(measured) {
  const rows = [
    ['step', 'seconds', 'target', 'CPU seconds', ''],
    ...measured.map((one) => [
      one.name,
      one.seconds.toFixed(1),
      one.target?.toFixed(0) ?? '–',
      one.cpuSeconds.toFixed(1),
      verdict(one),
    ]),
  ];
  const widths = rows[0].map((_, column) => Math.max(...rows.map((row) => row[column].length)));
  return rows
    .map((row) => row.map((cell, k) => (k === 0 || k === 4 ? cell.padEnd(widths[k]) : cell.padStart(widths[k]))))
    .map((row) => row.join('  ').trimEnd())
    .join('\n');
}

/** Rust code with a statement more at the beginning of its first public function, which compiles to something. */
export function edited(source, number) {
  const body = /^ *pub fn [^{;]*\{\n/m.exec(source);
  if (!body) throw new Error('the file has no public function');
  const at = body.index + body[0].length;
  return `${source.slice(0, at)}        std::hint::black_box(${number}_u64);\n${source.slice(at)}`;
}

/** Address of the script that a page names first, or null. */
export const mainScript = (page) => /<script[^>]* src="([^"]+)"/.exec(page)?.[1] ?? null;

/** Seconds that all processors have worked, from `os.cpus()`. */
export const processorSeconds = (processors) =>
  processors.reduce((sum, { times }) => sum + times.user + times.nice + times.sys + times.irq, 0) / 1000;
