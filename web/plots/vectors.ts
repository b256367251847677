/** A canvas that writes SVG: lines as paths, text as text, images embedded. */
import { Context } from 'svgcanvas';

export interface Vectors {
  ctx: CanvasRenderingContext2D;
  /** The drawing, shown at a width and height of its own. */
  finish(about: { title: string; description: string }, size: { width: number; height: number }): Blob;
}

const element = (name: string, text: string): SVGElement => {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  made.textContent = text;
  return made;
};

export function vectors(width: number, height: number): Vectors {
  const made = new Context(width, height);
  const ctx = made as unknown as CanvasRenderingContext2D;
  // Of images it keeps neither how far one sees through them nor that the cells of a map have edges.
  const drawImage = ctx.drawImage.bind(ctx) as (...given: unknown[]) => void;
  ctx.drawImage = (...given: unknown[]) => {
    drawImage(...given);
    const image = [...made.getSvg().querySelectorAll('image')].at(-1);
    image?.setAttribute('opacity', String(ctx.globalAlpha));
    image?.setAttribute('image-rendering', 'pixelated');
  };
  return {
    ctx,
    finish: ({ title, description }, size) => {
      const root = made.getSvg();
      root.setAttribute('viewBox', `0 0 ${width} ${height}`);
      root.setAttribute('width', String(size.width));
      root.setAttribute('height', String(size.height));
      root.setAttribute('role', 'img');
      root.prepend(element('title', title), element('desc', description));
      for (const path of root.querySelectorAll('path:not([d])')) path.remove();
      return new Blob([new XMLSerializer().serializeToString(root)], { type: 'image/svg+xml' });
    },
  };
}
