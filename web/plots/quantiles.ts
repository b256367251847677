/** Values below and above which a share lies, of what is finite; of at most about 20,000. */
export function quantiles(values: ArrayLike<number>, low: number, high: number): [number, number] | null {
  const every = Math.max(Math.floor(values.length / 20_000), 1);
  const all = new Float64Array(Math.ceil(values.length / every));
  let size = 0;
  for (let i = 0; i < values.length; i += every) if (Number.isFinite(values[i])) all[size++] = values[i] as number;
  if (!size) return null;
  const some = all.subarray(0, size).sort();
  return [some[Math.floor(low * (size - 1))] as number, some[Math.ceil(high * (size - 1))] as number];
}
