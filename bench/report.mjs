// The table, and the verdicts it ends with.

/** What a row is worth: its `target` is `{ most }` or `{ least }` of `value`. */
export function verdict({ value, target, error, missing }) {
  if (error) return 'error';
  if (missing) return 'not measured';
  if (!target) return '';
  return (target.most === undefined || value <= target.most) && (target.least === undefined || value >= target.least)
    ? 'met'
    : 'MISSED';
}

export function formatTime(seconds) {
  if (seconds === undefined) return '';
  const [scale, unit] = seconds < 1e-3 ? [1e6, 'us'] : seconds < 1 ? [1e3, 'ms'] : [1, 's'];
  return `${(seconds * scale).toPrecision(3)} ${unit}`;
}

/** A time, or where bytes were read in it, how fast they were. */
const formatSpeed = ({ readBytes }, seconds) =>
  readBytes && seconds ? `${(readBytes / seconds / 1e6).toPrecision(3)} MB/s` : formatTime(seconds);

const formatTarget = ({ target, unit }) => {
  if (!target) return '';
  const text = (value) => (unit === 's' ? formatTime(value) : unit === 'bytes' ? `${value / 1000} KB` : `${value} x`);
  return target.most === undefined ? `>= ${text(target.least)}` : `<= ${text(target.most)}`;
};

const formatSpread = ({ median, low, high }) =>
  `${median.toPrecision(3)} x (${low.toPrecision(3)} to ${high.toPrecision(3)})`;

function cells(row) {
  const figure =
    row.unit === 'bytes' ? `${(row.value / 1000).toFixed(1)} KB` : formatSpeed(row, row.ours?.median ?? row.value);
  return [
    row.name,
    row.error ? `error: ${row.error}` : figure,
    row.missing ? row.missing : row.other ? `${row.otherName} ${formatSpeed(row, row.other.median)}` : '',
    row.ratio ? formatSpread(row.ratio) : '',
    formatTarget(row),
    verdict(row),
  ];
}

export function table(rows) {
  const lines = [['', 'Boresight', 'beside it', 'ratio (10 to 90 %)', 'target', 'verdict'], ...rows.map(cells)];
  const widths = lines[0].map((_, column) => Math.max(...lines.map((line) => line[column].length)));
  const text = lines.map((line) =>
    line
      .map((cell, column) => cell.padEnd(widths[column]))
      .join('  ')
      .trimEnd(),
  );
  return [text[0], '-'.repeat(Math.max(...text.map((line) => line.length))), ...text.slice(1)].join('\n');
}

export function tally(rows) {
  const count = (wanted) => rows.filter((row) => verdict(row) === wanted).length;
  return { met: count('met'), missed: count('MISSED'), errors: count('error'), notMeasured: count('not measured') };
}
