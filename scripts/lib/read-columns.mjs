// The bundled drive as the demo sends it: the radar's table without the columns that no reader takes, and without the
// numbers of tracks, which are read only to leave out a second row of a track in a frame (docs/formats.md); here is none.
// Rows and other numbers stay as they are, so the drive that is read is the same (tests/node/bundled-drive.test.mjs).
import { readFile } from 'node:fs/promises';
import { gunzipSync, gzipSync } from 'node:zlib';

const READ = ['frame', 't_s', 'status', 'range_m', 'azimuth_rad', 'range_rate_mps'];

/** A packed table of the Delphi format with the columns that are read. */
export function readColumns(packed) {
  const [head, ...rows] = gunzipSync(packed).toString('utf8').trimEnd().split('\n');
  const names = head.split(',');
  const columns = READ.map((name) => names.indexOf(name));
  if (columns.includes(-1)) throw new Error(`the bundled drive has no column ${READ[columns.indexOf(-1)]}`);
  const kept = rows.map((row) => {
    const cells = row.split(',');
    return columns.map((at) => cells[at]).join(',');
  });
  return gzipSync([READ.join(','), ...kept, ''].join('\n'), { level: 9 });
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
        const source = readColumns(await readFile(id.replace(/\?url$/, '')));
        const file = this.emitFile({ type: 'asset', name: 'front_radar.csv.gz', source });
        return `export default '__VITE_ASSET__${file}__'`;
      },
    },
  };
}
