/** What the controls of a page call the fields of its state. */
const labels = new WeakMap<object, Map<string, string>>();

export function remember(fields: object, name: string, label: string, unit: string | undefined): void {
  const known = labels.get(fields) ?? new Map<string, string>();
  labels.set(fields, known.set(name, unit ? `${label} (${unit})` : label));
}

/** Known once the control was drawn. */
export const labelOf = (fields: object, name: string): string | undefined => labels.get(fields)?.get(name);
