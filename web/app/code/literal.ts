/** Values as JavaScript that a person reads: keys without quotes, lines of at most 100 columns. */

/** Code that stands in a literal as it is, such as the name of a variable. */
export class Expression {
  readonly text: string;

  constructor(text: string) {
    this.text = text;
  }
}

export const expression = (text: string): Expression => new Expression(text);

const COLUMNS = 100;
const STEP = '  ';
const IDENTIFIER = /^[A-Za-z_$][\w$]*$/;
/** A whole number is a key as it stands; its other spellings are keys of their own. */
const INDEX = /^(0|[1-9]\d{0,14})$/;

/** A text in single quotes. */
export function quoted(text: string): string {
  const escaped = text.replaceAll(/[\\'\p{Cc}\p{Cf}\u2028\u2029]|\p{Cs}/gu, (character) => {
    if (character === '\\' || character === "'") return `\\${character}`;
    if (character === '\n') return '\\n';
    return [...Array(character.length).keys()]
      .map((i) => `\\u${character.charCodeAt(i).toString(16).padStart(4, '0')}`)
      .join('');
  });
  return `'${escaped}'`;
}

function key(name: string): string {
  // Written otherwise it would set the object's prototype.
  if (name === '__proto__') return "['__proto__']";
  return IDENTIFIER.test(name) || INDEX.test(name) ? name : quoted(name);
}

/** Numbers keep every bit, the sign of zero too. */
export const numeral = (value: number): string => (Object.is(value, -0) ? '-0' : String(value));

type Part = [before: string, value: unknown];

/** Brackets and parts of what has parts. */
function partsOf(value: unknown): { open: string; close: string; parts: Part[]; space: string } | null {
  if (Array.isArray(value)) return { open: '[', close: ']', parts: value.map((one): Part => ['', one]), space: '' };
  if (ArrayBuffer.isView(value)) {
    const list = [...(value as Float64Array)];
    const open = `new ${value.constructor.name}([`;
    return { open, close: '])', parts: list.map((one): Part => ['', one]), space: '' };
  }
  if (typeof value !== 'object' || value === null || value instanceof Expression) return null;
  const parts = Object.entries(value).flatMap(([name, one]): Part[] => {
    if (one === undefined) return [];
    // A variable of the same name needs no second mention, and what is spread has none.
    if (one instanceof Expression && (one.text === name || one.text.startsWith('...'))) return [['', one]];
    return [[`${key(name)}: `, one]];
  });
  return { open: '{', close: '}', parts, space: ' ' };
}

function single(value: unknown): string {
  if (value instanceof Expression) return value.text;
  if (typeof value === 'string') return quoted(value);
  if (typeof value === 'number') return numeral(value);
  if (typeof value === 'bigint') return `${value}n`;
  const made = partsOf(value);
  if (!made) return String(value);
  const { open, close, parts, space } = made;
  if (!parts.length) return open + close;
  return `${open}${space}${parts.map(([before, one]) => before + single(one)).join(', ')}${space}${close}`;
}

/**
 * A value as code. `indent` is how far its lines are moved in, `before` how much of its first line is taken, and `after`
 * how much of its last.
 */
export function literal(
  value: unknown,
  { indent = '', before, after = 1 }: { indent?: string; before?: number; after?: number } = {},
): string {
  const line = single(value);
  const made = partsOf(value);
  if ((before ?? indent.length) + line.length + after <= COLUMNS || !made?.parts.length) return line;
  const { open, close, parts, space } = made;
  const inner = indent + STEP;
  // Short parts without names share lines.
  const flat = space === '' && parts.every(([, one]) => !(one instanceof Object) || single(one).length <= 24);
  if (flat)
    return `${open}\n${filled(
      parts.map(([, one]) => single(one)),
      inner,
    )}\n${indent}${close}`;
  const lines = parts.map(
    ([name, one]) => `${inner}${name}${literal(one, { indent: inner, before: inner.length + name.length })},`,
  );
  return `${open}\n${lines.join('\n')}\n${indent}${close}`;
}

/** As many to a line as fit. */
function filled(parts: readonly string[], indent: string): string {
  const lines: string[] = [];
  for (const part of parts) {
    const last = lines.at(-1);
    if (last !== undefined && last.length + part.length + 2 <= COLUMNS) lines[lines.length - 1] = `${last} ${part},`;
    else lines.push(`${indent}${part},`);
  }
  return lines.join('\n');
}

/** A call with its arguments: the last one opens on the line of the call where the line would be too long. */
export function call(start: string, values: readonly unknown[], end = ';', indent = ''): string {
  const line = `${indent}${start}(${values.map(single).join(', ')})${end}`;
  if (line.length <= COLUMNS) return line;
  const first = values
    .slice(0, -1)
    .map((one) => `${single(one)}, `)
    .join('');
  const head = `${indent}${start}(${first}`;
  if (head.length <= COLUMNS - 2) {
    const last = literal(values.at(-1), { indent, before: head.length, after: 1 + end.length });
    return `${head}${last})${end}`;
  }
  const inner = indent + STEP;
  const lines = values.map((one) => `${inner}${literal(one, { indent: inner })},`);
  return `${indent}${start}(\n${lines.join('\n')}\n${indent})${end}`;
}
