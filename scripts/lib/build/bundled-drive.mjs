// The bundled drive as the demo sends it: the radar's table without the columns that no reader takes, column by column,
// as differences from the track's row before. `tableOf` (web/app/pages/mounting/drive/compact.ts) makes the same text of it.
import { readFile } from 'node:fs/promises';
import { gunzipSync } from 'node:zlib';

const TRACK = 'track_id';
/** Columns that are read, each with the one whose row before it is compared with. */
const READ = new Map([
  ['frame', null],
  ['t_s', null],
  [TRACK, null],
  ['status', TRACK],
  ['range_m', TRACK],
  ['azimuth_rad', TRACK],
  ['range_rate_mps', TRACK],
]);
/** A column of fewer texts than this is told by their places in a list. */
const FEW = 2048;

/** The table with the columns that are read. */
export function readColumns(packed) {
  const [head, ...rows] = gunzipSync(packed).toString('utf8').trimEnd().split('\n');
  const names = head.split(',');
  const columns = [...READ.keys()].map((name) => names.indexOf(name));
  if (columns.includes(-1)) throw new Error('the bundled drive has not all columns that are read');
  const kept = rows.map((row) => {
    const cells = row.split(',');
    return columns.map((at) => cells[at]).join(',');
  });
  return [[...READ.keys()].join(','), ...kept, ''].join('\n');
}

/**
 * A line of JSON that says how many rows and which columns follow; of each column the low bytes of all its rows, then
 * the next ones. Differences have their sign in the lowest bit.
 */
export function compact(csv) {
  const [head, ...rows] = csv.trimEnd().split('\n');
  const names = head.split(',');
  const cells = rows.map((row) => row.split(','));
  const numbers = names.map((name, at) =>
    coded(
      name,
      cells.map((row) => row[at]),
    ),
  );
  const columns = [];
  const planes = [];
  for (const [at, { integers, ...how }] of numbers.entries()) {
    const by = names.indexOf(READ.get(names[at]) ?? '');
    const before = new Map();
    const differences = integers.map((value, row) => {
      const key = by < 0 ? 0 : numbers[by].integers[row];
      const difference = value - (before.get(key) ?? 0);
      before.set(key, value);
      return difference < 0 ? -2 * difference - 1 : 2 * difference;
    });
    const most = differences.reduce((a, b) => Math.max(a, b), 0);
    const bytes = [1, 2, 3].find((count) => most < 256 ** count);
    if (!bytes) throw new Error(`${names[at]} of the bundled drive differs too much from row to row`);
    columns.push({ name: names[at], by, bytes, ...how });
    for (let byte = 0; byte < bytes; byte++)
      planes.push(Uint8Array.from(differences, (value) => (value >> (8 * byte)) & 255));
  }
  const header = Buffer.from(`${JSON.stringify({ rows: rows.length, columns })}\n`);
  return Buffer.concat([header, ...planes]);
}

/** Integers that stand for a column's texts: their places in a list, or themselves without the point. */
function coded(name, texts) {
  const list = [...new Set(texts)].sort((a, b) => a - b);
  if (list.length < FEW && list.some((text) => text.includes('.'))) {
    const places = new Map(list.map((text, place) => [text, place]));
    return { list, integers: texts.map((text) => places.get(text)) };
  }
  const decimals = texts[0].split('.')[1]?.length ?? 0;
  const integers = texts.map((text) => Math.round(Number(text) * 10 ** decimals));
  const back = (integer) => (integer / 10 ** decimals).toFixed(decimals);
  const odd = texts.find((text, row) => back(integers[row]) !== text);
  if (odd !== undefined)
    throw new Error(`${name} of the bundled drive has ${odd} among numbers of ${decimals} decimals`);
  return { decimals, integers };
}

/** Puts it into the built demo in place of the file of the recordings. */
export function bundledDrive() {
  return {
    name: 'bundled-drive',
    apply: 'build',
    enforce: 'pre',
    load: {
      filter: { id: /\/recordings\/delphi\/front_radar\.csv\.gz\?url$/ },
      async handler(id) {
        const source = compact(readColumns(await readFile(id.replace(/\?url$/, ''))));
        const file = this.emitFile({ type: 'asset', name: 'front_radar.bin', source });
        return `export default '__VITE_ASSET__${file}__'`;
      },
    },
  };
}
