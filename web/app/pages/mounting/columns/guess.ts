/** What columns hold, by their names and, where these are silent, by their numbers. */
import { DATE, FIELDS, type Field, type GroupName, PLACE } from './fields.ts';
import { numberOf, type Table } from './table.ts';

/** A column and how to take it. */
export interface Pick {
  column: string;
  unit: string;
  flipped: boolean;
}

/** By the name of the field; `table` is null where there is none. */
export interface Choice {
  table: string | null;
  picks: Readonly<Record<string, Pick>>;
}

export type Choices = Readonly<Record<GroupName, Choice>>;

/** In small letters, words apart: of `rangeRate_mps [m/s]` "range rate mps m/s". */
const wordsOf = (name: string): string =>
  name
    .replace(/([a-z])([A-Z])/g, '$1 $2')
    .toLowerCase()
    .replace(/[^a-z0-9°µ/]+/g, ' ')
    .trim();

/** Largest number that is usual in the unit a general table has; what exceeds it is in another. */
const UNUSUAL: Record<string, readonly [number, string, string]> = {
  azimuth_deg: [Math.PI, 'deg', 'rad'],
  yaw_rate_degps: [1.5, 'deg/s', 'rad/s'],
  yaw_rad: [2 * Math.PI, 'deg', 'rad'],
  range_rate_mps: [90, 'km/h', 'm/s'],
  speed_mps: [70, 'km/h', 'm/s'],
};
/** Between two scans, s. */
const USUAL_STEP = 0.05;

const valuesOf = (table: Table, column: string): string[] => {
  const at = table.columns.indexOf(column);
  return table.sample.map((row) => row[at] ?? '');
};

function timeUnit(field: Field, texts: readonly string[], comma: boolean): string {
  const numbers = texts.map((text) => numberOf(text, comma)).filter(Number.isFinite);
  if (numbers.length === 0 && texts.some((text) => Number.isFinite(Date.parse(text)))) return DATE;
  const steps = numbers.slice(1).flatMap((t, i) => (t > (numbers[i] as number) ? [t - (numbers[i] as number)] : []));
  const step = steps.sort((a, b) => a - b)[steps.length >> 1];
  if (step === undefined) return 's';
  const far = ({ factor }: { factor: number }): number => Math.abs(Math.log(step * factor) - Math.log(USUAL_STEP));
  return field.units.filter(({ name }) => name !== DATE).reduce((best, one) => (far(one) < far(best) ? one : best))
    .name;
}

function unitOf(field: Field, table: Table, column: string): string {
  const words = wordsOf(column);
  const texts = valuesOf(table, column);
  const isTime = field.name === 'time_s';
  const named = field.units.find((unit) => unit.words.test(words));
  // A date is told by its look; its column may well be called a time.
  if (named && !(isTime && named.name === DATE)) return named.name;
  if (isTime) return timeUnit(field, texts, table.comma);
  const usual = UNUSUAL[field.name];
  if (!usual) return field.units[0]?.name ?? '';
  const [most, above, below] = usual;
  return texts.some((text) => Math.abs(numberOf(text, table.comma)) > most) ? above : below;
}

/** How a field would be taken from a column that the user names. */
export const pick = (field: Field, table: Table, column: string): Pick => ({
  column,
  unit: unitOf(field, table, column),
  flipped: field.signs !== undefined && /\b(right|clockwise|cw|approaching|closing)\b/.test(wordsOf(column)),
});

export function guess(group: GroupName, table: Table): Choice {
  const picks: Record<string, Pick> = {};
  const free = new Set(table.columns);
  for (const field of FIELDS[group]) {
    if (field.place && picks.azimuth_deg) continue;
    // A general table's own columns are what they say, in whichever of its units.
    const column =
      table.columns.find((name) => free.has(name) && name === field.name) ??
      table.columns.find((name) => {
        const words = wordsOf(name);
        return free.has(name) && field.words.test(words) && !/\b(elevation|label|id|std|sigma|rms|count)\b/.test(words);
      }) ??
      (field.names && table.columns.find((name) => free.has(name) && field.words.test(wordsOf(name))));
    if (column === undefined) continue;
    free.delete(column);
    picks[field.name] = pick(field, table, column);
  }
  return { table: table.name, picks };
}

/** Whether azimuths, and ranges that have no column, follow from places. */
export const fromPlace = ({ picks }: Choice, { name }: Field): boolean =>
  !picks[name] && (name === 'azimuth_deg' || name === 'range_m') && PLACE.every((part) => picks[part]);

const lacks = (choice: Choice, field: Field): boolean =>
  field.required && !choice.picks[field.name] && !fromPlace(choice, field);

const missing = (group: GroupName, choice: Choice): number =>
  FIELDS[group].filter((field) => lacks(choice, field)).length;

/** Each group from the table that has most of what it needs; no motion where no table has a yaw rate. */
export function guessAll(tables: readonly Table[]): Choices {
  const best = (group: GroupName): Choice =>
    tables
      .map((table) => guess(group, table))
      .reduce((best, choice) => (missing(group, choice) < missing(group, best) ? choice : best));
  const motion = best('motion');
  return {
    detections: best('detections'),
    motion: missing('motion', motion) === 0 ? motion : { table: null, picks: {} },
  };
}

/** What is still to be said, in words. */
export function lacking({ detections, motion }: Choices): string[] {
  const ask = (group: GroupName, choice: Choice): string[] =>
    FIELDS[group].flatMap((field) => (lacks(choice, field) ? [`${field.label.toLowerCase()} of the ${group}`] : []));
  return [...ask('detections', detections), ...(motion.table === null ? [] : ask('motion', motion))];
}
