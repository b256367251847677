/** Signs on range-Doppler maps that show on every colour. */
import { clipToPlot, type Layer, strokeTwice } from './layers.ts';

/** Boxes around detections. */
export function detectionBoxes(places: readonly { x: number; y: number }[]): Layer {
  return ({ ctx, plot, ratio, x, y }) => {
    clipToPlot(ctx, plot);
    const r = 5 * ratio;
    const boxes = (path: CanvasPath): void => {
      for (const place of places) path.rect(x(place.x) - r, y(place.y) - r, 2 * r, 2 * r);
    };
    const under = { color: 'rgba(0, 0, 0, 0.75)', width: 3.5 * ratio };
    strokeTwice(ctx, boxes, under, { color: '#ffffff', width: 1.5 * ratio });
  };
}

/** A crosshair on the cell that was chosen. */
export function chosenCell(atX: number, atY: number): Layer {
  return ({ ctx, plot, ratio, x, y }) => {
    clipToPlot(ctx, plot);
    const { left, top, width, height } = plot.bbox;
    const [px, py] = [x(atX), y(atY)];
    const gap = 9 * ratio;
    ctx.beginPath();
    for (const [ax, ay, bx, by] of [
      [left, py, px - gap, py],
      [px + gap, py, left + width, py],
      [px, top, px, py - gap],
      [px, py + gap, px, top + height],
    ] as const) {
      ctx.moveTo(ax, ay);
      ctx.lineTo(bx, by);
    }
    ctx.globalAlpha = 0.75;
    ctx.setLineDash([5 * ratio, 4 * ratio]);
    ctx.strokeStyle = '#ffffff';
    ctx.lineWidth = ratio;
    ctx.stroke();
  };
}
