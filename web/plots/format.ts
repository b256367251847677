/** Numbers for people: a true minus sign, fixed digits, engineering prefixes. */

export function fixed(value: number, digits = 1): string {
  if (!Number.isFinite(value)) return '–';
  const text = value.toFixed(digits);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

/** A signed number, for differences and angles. */
export function signed(value: number, digits = 1): string {
  const text = fixed(value, digits);
  return Number.isFinite(value) && Number(value.toFixed(digits)) > 0 ? `+${text}` : text;
}

/** At least `digits` significant figures, never in exponent form. */
export function significant(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(value))));
  return fixed(value, Math.min(decimals, 6));
}

const PREFIXES: [number, string][] = [
  [1e9, 'G'],
  [1e6, 'M'],
  [1e3, 'k'],
  [1, ''],
  [1e-3, 'm'],
  [1e-6, 'µ'],
  [1e-9, 'n'],
];

/** A number as it is, and `1e-6` as a power of ten. */
export function power(value: number | string): string {
  const [, sign, digits] = /^1e([+-]?)(\d+)$/.exec(String(value)) ?? [];
  if (!digits) return String(value).replaceAll('-', '−');
  return `10${sign === '-' ? '⁻' : ''}${[...digits].map((digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)]).join('')}`;
}

/** A value with an SI prefix and its unit: `3.07 GHz`. */
export function engineering(value: number, unit: string, digits = 3): string {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  const [scale, prefix] = PREFIXES.find(([limit]) => size >= limit) ?? (size === 0 ? [1, ''] : [1e-9, 'n']);
  return `${significant(value / scale, digits)}\u00a0${prefix}${unit}`;
}

/** Tick labels with as many decimals as their step needs. */
export function ticks(splits: number[], step: number): string[] {
  let decimals = 0;
  for (let scaled = step; decimals < 6 && Math.abs(scaled - Math.round(scaled)) > 1e-6 * scaled; scaled *= 10)
    decimals += 1;
  return splits.map((value) => (value == null ? '' : fixed(value, decimals)));
}

/** A ratio that may be of nothing. */
export function decibels(value: number): string {
  return value === Number.NEGATIVE_INFINITY ? 'nothing' : `${fixed(value, 1)}\u00a0dB`;
}

/** A duration of a computation. */
export function milliseconds(value: number | undefined): string {
  if (value === undefined || !Number.isFinite(value)) return '–';
  if (value < 0.1) return '<0.1\u00a0ms';
  if (value < 10) return `${fixed(value, 1)}\u00a0ms`;
  if (value < 10_000) return `${fixed(value, 0)}\u00a0ms`;
  return `${fixed(value / 1000, 1)}\u00a0s`;
}

/** A file's size. */
export function byteSize(bytes: number): string {
  return bytes < 1024
    ? `${bytes} B`
    : bytes < 1024 ** 2
      ? `${(bytes / 1024).toFixed(0)} KiB`
      : `${(bytes / 1024 ** 2).toFixed(2)} MiB`;
}

/** A count with its thousands apart. */
export function count(value: number): string {
  return value.toLocaleString('en').replaceAll(',', '\u202f');
}

/** A share as a percentage. */
export function percentage(share: number): string {
  return `${significant(100 * share, 2)}\u00a0%`;
}
