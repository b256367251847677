/** The bundled drive's table out of the form in which it is sent (scripts/lib/build/bundled-drive.mjs). */

interface Column {
  name: string;
  /** The column whose row before a row is compared with, or -1 for the row before. */
  by: number;
  bytes: number;
  /** Texts by number; without them a number is one of so many decimals. */
  list?: string[];
  decimals?: number;
}

/** What a column's texts take at most, with a comma. */
const WIDEST = 16;

/** The table as CSV. As the development server sends it, it is that already. */
export function tableOf(sent: Uint8Array): Uint8Array {
  const end = sent.indexOf(10);
  if (sent[0] !== 0x7b) return sent;
  const { rows, columns } = JSON.parse(new TextDecoder().decode(sent.subarray(0, end))) as {
    rows: number;
    columns: Column[];
  };
  const values: Int32Array[] = [];
  let at = end + 1;
  for (const { by, bytes } of columns) {
    const column = new Int32Array(rows);
    const before = new Int32Array(1 << 16);
    for (let row = 0; row < rows; row++) {
      let coded = 0;
      for (let byte = 0; byte < bytes; byte++) coded |= (sent[at + byte * rows + row] as number) << (8 * byte);
      const key = by < 0 ? 0 : ((values[by] as Int32Array)[row] as number);
      const value = (before[key] as number) + (coded & 1 ? -(coded + 1) / 2 : coded / 2);
      before[key] = value;
      column[row] = value;
    }
    values.push(column);
    at += bytes * rows;
  }
  const encoder = new TextEncoder();
  const lists = columns.map(({ list }) => list?.map((text) => encoder.encode(text)));
  const head = encoder.encode(`${columns.map(({ name }) => name).join(',')}\n`);
  const table = new Uint8Array(head.length + rows * columns.length * WIDEST);
  table.set(head);
  let to = head.length;
  for (let row = 0; row < rows; row++) {
    for (let i = 0; i < columns.length; i++) {
      const value = (values[i] as Int32Array)[row] as number;
      const text = lists[i]?.[value];
      if (text) {
        for (let k = 0; k < text.length; k++) table[to++] = text[k] as number;
      } else to = write(table, to, value, columns[i]?.decimals ?? 0);
      table[to++] = i + 1 < columns.length ? 44 : 10;
    }
  }
  return table.slice(0, to);
}

/** Writes an integer with a point before its last digits; gives where it ends. */
function write(into: Uint8Array, start: number, value: number, decimals: number): number {
  let to = start;
  let rest = Math.abs(value);
  if (value < 0) into[to++] = 45;
  let digits = 1;
  for (let ten = 10; ten <= rest || digits <= decimals; ten *= 10) digits += 1;
  const end = to + digits + (decimals > 0 ? 1 : 0);
  for (let k = 0, place = end - 1; place >= to; k++, place--) {
    if (decimals > 0 && k === decimals) into[place] = 46;
    else {
      into[place] = 48 + (rest % 10);
      rest = Math.floor(rest / 10);
    }
  }
  return end;
}
