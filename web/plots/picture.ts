/** Plots as pictures to save: a heading above, legend and caption below. */
import { drawSwatch, SWATCH } from './layers.ts';
import type { Plot } from './plot.ts';
import type { LegendEntry } from './types.ts';

/** Of what is on the screen: pictures are printed and projected. */
const SCALE = 2;

/** What of a plot a picture takes; the 3-D view has it too. */
export type Pictured = Pick<Plot, 'ratio' | 'theme' | 'palette' | 'sizeAt'> & {
  drawAgain(scale: number): HTMLCanvasElement;
};

export interface Picture {
  heading: string;
  legend: readonly LegendEntry[];
  /** What is shown and where it is from: a paragraph each. */
  caption: readonly string[];
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

/** Lines no wider than there is room for, broken between words, and within those that are wider themselves. */
export function wrap(text: string, fits: (line: string) => boolean): string[] {
  const lines: string[] = [];
  let line = '';
  for (let word of text.split(' ')) {
    const longer = line ? `${line} ${word}` : word;
    if (fits(longer)) {
      line = longer;
      continue;
    }
    if (line) lines.push(line);
    while (!fits(word)) {
      let [low, high] = [1, word.length - 1];
      while (low < high) {
        const middle = Math.ceil((low + high) / 2);
        if (fits(word.slice(0, middle))) low = middle;
        else high = middle - 1;
      }
      if (low >= word.length) break;
      lines.push(word.slice(0, low));
      word = word.slice(low);
    }
    line = word;
  }
  return line ? [...lines, line] : lines;
}

function context(width: number, height: number): CanvasRenderingContext2D {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [width, height];
  const ctx = canvas.getContext('2d');
  if (!ctx) throw new Error('This browser gives no 2-D canvas to draw the image on.');
  return ctx;
}

interface Layout {
  width: number;
  height: number;
  /** Draws all but the plot; gives the space above that. */
  draw(ctx: CanvasRenderingContext2D): void;
  top: number;
}

function layout(plot: Pictured, { heading, legend, caption }: Picture): Layout {
  const ratio = plot.ratio * SCALE;
  const { width, height: plotHeight } = plot.sizeAt(SCALE);
  const { theme: themeName, palette: theme } = plot;
  const small = `${11 * ratio}px ${theme.font}`;
  const margin = 12 * ratio;
  const line = 17 * ratio;
  const room = width - 2 * margin;
  const measure = context(1, 1);
  const fits = (text: string): boolean => measure.measureText(text).width <= room;
  measure.font = `600 ${13 * ratio}px ${theme.font}`;
  const headings = wrap(heading, fits);
  measure.font = small;
  const lines = caption.flatMap((text) => wrap(text, fits));
  const places = legendPlaces(
    legend.map(({ label }) => measure.measureText(label).width),
    room,
    ratio,
  );
  const legendRows = (places.at(-1)?.row ?? -1) + 1;
  const top = (12 + 18 * headings.length) * ratio;
  const rows = legendRows + lines.length;
  return {
    width,
    height: plotHeight + top + (rows ? rows * line + 8 * ratio : 0),
    top,
    draw: (ctx) => {
      ctx.textAlign = 'left';
      ctx.textBaseline = 'middle';
      ctx.fillStyle = theme.text;
      ctx.font = `600 ${13 * ratio}px ${theme.font}`;
      headings.forEach((text, i) => {
        ctx.fillText(text, margin, (15 + 18 * i) * ratio);
      });
      ctx.font = small;
      const rowY = (row: number): number => top + plotHeight + (row + 0.5) * line;
      legend.forEach((entry, i) => {
        const { x, row } = places[i] ?? { x: 0, row: 0 };
        drawSwatch(ctx, entry, { x: margin + x, y: rowY(row), ratio }, theme, themeName);
        ctx.fillStyle = theme.text;
        ctx.fillText(entry.label, margin + x + (SWATCH.width + 5) * ratio, rowY(row));
      });
      ctx.fillStyle = theme.muted;
      lines.forEach((text, i) => {
        ctx.fillText(text, margin, rowY(legendRows + i));
      });
    },
  };
}

function background(ctx: CanvasRenderingContext2D, plot: Pictured, { width, height }: Layout): void {
  ctx.fillStyle = plot.palette.background;
  ctx.fillRect(0, 0, width, height);
}

/** At twice the screen's resolution. */
export function png(plot: Pictured, what: Picture): Promise<Blob> {
  const placed = layout(plot, what);
  const ctx = context(placed.width, placed.height);
  background(ctx, plot, placed);
  ctx.drawImage(plot.drawAgain(SCALE), 0, placed.top);
  placed.draw(ctx);
  return new Promise((resolve, reject) => {
    ctx.canvas.toBlob(
      (blob) => (blob ? resolve(blob) : reject(new Error('The browser could not encode the image.'))),
      'image/png',
    );
  });
}

/** Lines as paths and text as text; as large as on the screen wherever it is shown at its own size. */
export async function svg(plot: Plot, what: Picture): Promise<Blob> {
  const { vectors } = await import('./vectors.ts');
  const placed = layout(plot, what);
  const { ctx, finish } = vectors(placed.width, placed.height);
  ctx.save();
  background(ctx, plot, placed);
  ctx.restore();
  ctx.save();
  ctx.translate(0, placed.top);
  plot.drawAgain(SCALE, ctx);
  ctx.restore();
  placed.draw(ctx);
  const shown = plot.ratio * SCALE;
  return finish(
    { title: what.heading, description: what.caption.join('\n') },
    { width: placed.width / shown, height: placed.height / shown },
  );
}
