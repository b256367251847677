/** A plot as a picture to save. */
import { drawSwatch, SWATCH } from './layers.ts';
import { type SeriesStyle, THEMES, type ThemeName } from './theme.ts';

export interface LegendEntry {
  label: string;
  style: SeriesStyle;
  line: boolean;
  hollow?: boolean;
}

/** Where the entries of a legend go, row by row, from the widths of their labels. */
function legendPlaces(widths: readonly number[], available: number, ratio: number): { x: number; row: number }[] {
  let x = 0;
  let row = 0;
  return widths.map((width) => {
    const size = width + (SWATCH.width + 22) * ratio;
    if (x > 0 && x + size > available) {
      x = 0;
      row += 1;
    }
    const place = { x, row };
    x += size;
    return place;
  });
}

export interface Picture {
  heading: string;
  legend: readonly LegendEntry[];
  remarks: readonly string[];
  /** Pixels of the canvas for one of the page. */
  ratio: number;
  theme: ThemeName;
}

/** A canvas with a heading above, a legend and remarks below, as PNG. */
export function picture(
  source: HTMLCanvasElement,
  { heading, legend, remarks, ratio, theme: name }: Picture,
): Promise<Blob> {
  const theme = THEMES[name];
  const canvas = document.createElement('canvas');
  const ctx = canvas.getContext('2d');
  if (!ctx) return Promise.reject(new Error('This browser gives no 2-D canvas to draw the image on.'));
  const small = `${11 * ratio}px ${theme.font}`;
  const margin = 12 * ratio;
  const line = 17 * ratio;
  ctx.font = small;
  const places = legendPlaces(
    legend.map(({ label }) => ctx.measureText(label).width),
    source.width - 2 * margin,
    ratio,
  );
  const rows = (places.at(-1)?.row ?? -1) + 1 + remarks.length;
  const top = 30 * ratio;
  canvas.width = source.width;
  canvas.height = source.height + top + (rows ? rows * line + 8 * ratio : 0);
  ctx.fillStyle = theme.background;
  ctx.fillRect(0, 0, canvas.width, canvas.height);
  ctx.drawImage(source, 0, top);
  ctx.textBaseline = 'middle';
  ctx.fillStyle = theme.text;
  ctx.font = `600 ${13 * ratio}px ${theme.font}`;
  ctx.fillText(heading, margin, top / 2, canvas.width - 2 * margin);
  ctx.font = small;
  const rowY = (row: number): number => top + source.height + (row + 0.5) * line;
  legend.forEach((entry, i) => {
    const { x, row } = places[i] ?? { x: 0, row: 0 };
    drawSwatch(ctx, entry, { x: margin + x, y: rowY(row), ratio }, theme, name);
    ctx.fillStyle = theme.text;
    ctx.fillText(entry.label, margin + x + (SWATCH.width + 5) * ratio, rowY(row));
  });
  ctx.fillStyle = theme.muted;
  remarks.forEach((remark, i) => {
    ctx.fillText(remark, margin, rowY(rows - remarks.length + i), canvas.width - 2 * margin);
  });
  return new Promise((resolve, reject) => {
    canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error('The browser could not encode the image.'))),
      'image/png',
    );
  });
}
