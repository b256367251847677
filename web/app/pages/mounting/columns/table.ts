/** Tables of any columns: their beginning to look at, and all of them as general tables. */
import Papa from 'papaparse';
import { FileProblem } from '../../../data.ts';
import type { NamedFile } from '../../../ui/entries.ts';
import { DATE, FIELDS, type Field, type GroupName, PLACE, POSE } from './fields.ts';
import { type Choice, fromPlace } from './guess.ts';

export interface Table {
  name: string;
  text: Blob;
  columns: readonly string[];
  /** Its first rows. */
  sample: readonly (readonly string[])[];
  /** Rows before those of numbers. */
  head: number;
  /** Decimals stand after a comma. */
  comma: boolean;
}

const SAMPLE = 1000;
/** The most that a table may unpack to. */
const LARGEST_BYTES = 1024 ** 3;
const MOST_SENSORS = 255;

async function unpacked({ name, file }: NamedFile): Promise<Blob> {
  const start = new Uint8Array(await file.slice(0, 2).arrayBuffer());
  if (start[0] !== 0x1f || start[1] !== 0x8b) return file;
  let total = 0;
  const bounded = new TransformStream<Uint8Array, Uint8Array>({
    transform(part, controller) {
      total += part.length;
      if (total > LARGEST_BYTES)
        throw new FileProblem('too-large', name, `it unpacks to more than ${LARGEST_BYTES / 2 ** 20} MiB`);
      controller.enqueue(part);
    },
  });
  const stream = file.stream().pipeThrough(new DecompressionStream('gzip')).pipeThrough(bounded);
  return new Response(stream).blob();
}

/** Calls for the rows of a text, many at a time. */
const rowsOf = (text: Blob, take: (rows: string[][], delimiter: string) => void, most = 0): Promise<void> =>
  new Promise((resolve, reject) => {
    Papa.parse<string[], File>(text as File, {
      skipEmptyLines: 'greedy',
      preview: most,
      chunk: ({ data, meta }, parser) => {
        try {
          take(data, meta.delimiter);
        } catch (error) {
          parser.abort();
          reject(error);
        }
      },
      complete: () => resolve(),
      error: reject,
    });
  });

export function numberOf(text: string, comma: boolean): number {
  const plain = text.trim();
  if (plain === '') return Number.NaN;
  return Number(comma ? plain.replace(',', '.') : plain);
}

/** The names of columns stand in the first row of several fields none of which is a number. */
export async function look(given: NamedFile): Promise<Table> {
  const text = await unpacked(given);
  const rows: string[][] = [];
  let delimiter = ',';
  await rowsOf(
    text,
    (some, by) => {
      rows.push(...some);
      delimiter = by;
    },
    SAMPLE,
  );
  const comma = delimiter !== ',';
  const isHead = (row: readonly string[]): boolean =>
    row.length > 1 && row.every((one) => Number.isNaN(numberOf(one, comma)));
  const at = rows.slice(0, 50).findIndex(isHead);
  const width = Math.max(...rows.map((row) => row.length), 0);
  if (width < 2) throw new FileProblem('no-table', given.name, 'it has no columns');
  const names = at < 0 ? [] : (rows[at] as string[]);
  const columns: string[] = [];
  for (let i = 0; i < width; i++) {
    const name = (names[i] ?? '').replace(/^\uFEFF?[#%\s]*/, '').trim() || `column ${i + 1}`;
    columns.push(columns.includes(name) ? `${name} (${i + 1})` : name);
  }
  return { name: given.name, text, columns, sample: rows.slice(at + 1), head: at + 1, comma };
}

/** Turns a field's text into the number that the general table holds. */
export function reader(table: Table, field: Field, choice: Choice): (row: readonly string[]) => number {
  if (fromPlace(choice, field)) return placeReader(table, field, choice);
  const pick = choice.picks[field.name];
  if (!pick) return () => Number.NaN;
  const at = table.columns.indexOf(pick.column);
  const sign = pick.flipped ? -1 : 1;
  if (pick.unit === DATE) return (row) => Date.parse((row[at] ?? '').trim()) / 1000;
  const factor = sign * (field.units.find(({ name }) => name === pick.unit)?.factor ?? 1);
  return (row) => numberOf(row[at] ?? '', table.comma) * factor;
}

/** Azimuth or range of a place in the radar's frame. */
function placeReader(table: Table, { name }: Field, choice: Choice): (row: readonly string[]) => number {
  const [x, y] = FIELDS.detections
    .filter((field) => PLACE.includes(field.name))
    .map((field) => reader(table, field, choice)) as [Reads, Reads];
  return name === 'range_m'
    ? (row) => Math.hypot(x(row), y(row))
    : (row) => (Math.atan2(y(row), x(row)) * 180) / Math.PI;
}

type Reads = (row: readonly string[]) => number;

/** Sensors by number where all are numbers that may be, else numbered in the order in which their names come. */
export function sensorReader(table: Table, field: Field, choice: Choice): (row: readonly string[]) => number {
  const number = reader(table, field, choice);
  const fits = (value: number): boolean => Number.isInteger(value) && value >= 0 && value <= MOST_SENSORS;
  if (table.sample.every((row) => fits(number(row))))
    return (row) => {
      const value = number(row);
      return fits(value) ? value : Number.NaN;
    };
  const at = table.columns.indexOf(choice.picks[field.name]?.column ?? '');
  const known = new Map<string, number>();
  return (row) => {
    const name = (row[at] ?? '').trim();
    if (name === '') return Number.NaN;
    const id = known.get(name) ?? known.size + 1;
    known.set(name, id);
    if (id > MOST_SENSORS)
      throw new FileProblem('too-many', table.name, `more than ${MOST_SENSORS} sensors are in ${field.name}`);
    return id;
  };
}

/** Fields of a group that its general table will have. */
const written = (group: GroupName, choice: Choice): Field[] => {
  const { picks } = choice;
  const pose = group === 'detections' || POSE.every((name) => picks[name]);
  return FIELDS[group].filter(
    (field) => !field.place && (picks[field.name] || fromPlace(choice, field)) && (pose || !POSE.includes(field.name)),
  );
};

/**
 * The group as a general table. What is no number becomes NaN where the reader must have one, which leaves the row out
 * and counts it. `shared`: the rows are those of detections, each with the motion at its time.
 */
export async function rewrite(
  group: GroupName,
  table: Table,
  choice: Choice,
  shared: boolean,
  signal: AbortSignal,
): Promise<NamedFile> {
  const fields = written(group, choice);
  const readers = fields.map((field) =>
    field.names ? sensorReader(table, field, choice) : reader(table, field, choice),
  );
  const parts: string[] = [`${fields.map(({ name }) => name).join(',')}\n`];
  const motion: Row[] = [];
  let head = table.head;
  await rowsOf(table.text, (some) => {
    signal.throwIfAborted();
    for (const row of some.slice(head)) {
      const numbers = readers.map((read) => read(row));
      const nameless = fields.some(({ names }, i) => names && Number.isNaN(numbers[i]));
      const text = fields.map(({ names, required }, i) => {
        const number = numbers[i] as number;
        if (names) return nameless ? 0 : number;
        if (required) return nameless ? 'NaN' : number;
        return Number.isFinite(number) ? number : '';
      });
      const line = `${text.join(',')}\n`;
      if (!shared) parts.push(line);
      else if (fields.every(({ required }, i) => !required || Number.isFinite(numbers[i])))
        motion.push({ time: numbers[0] as number, line });
    }
    head = Math.max(head - some.length, 0);
  });
  const name = `${group}.csv`;
  return { name, file: new File([...parts, ...once(motion)], name) };
}

interface Row {
  time: number;
  line: string;
}

/** One row a time, in order of time. */
function once(rows: readonly Row[]): string[] {
  const sorted = [...rows].sort((a, b) => a.time - b.time);
  return sorted.filter(({ time }, i) => time !== sorted[i - 1]?.time).map(({ line }) => line);
}
