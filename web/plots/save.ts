/** What leaves a plot or table as a file. */

/** A field as RFC 4180 wants it. Spreadsheets would run text that begins as formulas do; an apostrophe keeps it text. */
function field(value: unknown): string {
  const given = value == null || (typeof value === 'number' && !Number.isFinite(value)) ? '' : String(value);
  const text =
    typeof value === 'string' && /^[=+\-@\t\r]/.test(given) && Number.isNaN(Number(given)) ? `'${given}` : given;
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** One header row, then the rows; the header names the units. */
export function toCsv(header: readonly string[], rows: Iterable<readonly unknown[]>): string {
  const lines = [header.map(field).join(',')];
  for (const row of rows) lines.push(row.map(field).join(','));
  return `${lines.join('\r\n')}\r\n`;
}

export function download(content: Blob | string, name: string): void {
  const blob = typeof content === 'string' ? new Blob([content], { type: 'text/csv;charset=utf-8' }) : content;
  const address = URL.createObjectURL(blob);
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Images side by side, as many in a row as go into about two screens' width at twice their resolution. */
export async function sideBySide(images: readonly Blob[]): Promise<Blob> {
  const all = await Promise.all(images.map((image) => createImageBitmap(image)));
  const [width, height] = [Math.max(...all.map((one) => one.width)), Math.max(...all.map((one) => one.height))];
  const columns = Math.min(all.length, Math.max(Math.floor(6400 / width), 1));
  const canvas = new OffscreenCanvas(width * columns, height * Math.ceil(all.length / columns));
  const ctx = canvas.getContext('2d');
  if (!ctx) throw new Error('This browser gives no 2-D canvas to draw the image on.');
  all.forEach((one, i) => ctx.drawImage(one, (i % columns) * width, Math.floor(i / columns) * height));
  return canvas.convertToBlob({ type: 'image/png' });
}

/** A safe, readable file name. */
export function fileName(parts: readonly (string | number | undefined)[], extension: string): string {
  const stem = parts
    .filter((part) => part !== undefined && part !== '')
    .join('-')
    .toLowerCase()
    .replace(/[^a-z0-9.+-]+/g, '-')
    .replace(/^-+|-+$/g, '');
  return `boresight-${stem.slice(0, 90)}.${extension}`;
}
