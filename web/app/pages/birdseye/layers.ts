/** What is drawn over an image: the street as it truly is, and where the radars sit and look. */
import type { StreetScene } from 'boresight';
import { ground } from '../../../plots/car.ts';
import { clipToPlot, type Layer, strokeTwice } from '../../../plots/layers.ts';
import type { Point, Radar } from './input.ts';

/** A ray's end in the car's frame. */
function along({ mounting: { xM, yM, yawDeg } }: Radar, angleDeg: number, rangeM: number): [x: number, y: number] {
  const radians = ((yawDeg + angleDeg) * Math.PI) / 180;
  return [xM + rangeM * Math.cos(radians), yM + rangeM * Math.sin(radians)];
}

/** Edges of what each radar sees, out to its last range. */
export function fieldsOfView(radars: readonly { radar: Radar; rangeM: number }[]): Layer {
  return (context) => {
    const { ctx, plot, ratio } = context;
    const at = ground(context);
    clipToPlot(ctx, plot);
    for (const { radar, rangeM } of radars) {
      const half = radar.fieldOfViewDeg;
      ctx.setLineDash([5 * ratio, 5 * ratio]);
      const edges = (path: CanvasPath): void => {
        path.moveTo(...at(radar.mounting.xM, radar.mounting.yM));
        for (let angle = -half; angle <= half; angle += half / 24) path.lineTo(...at(...along(radar, angle, rangeM)));
        path.closePath();
      };
      stroke(ctx, edges, 'rgba(255, 255, 255, 0.75)', ratio);
      ctx.setLineDash([]);
      const dot = (path: CanvasPath): void =>
        path.arc(...at(radar.mounting.xM, radar.mounting.yM), 2.5 * ratio, 0, 2 * Math.PI);
      stroke(ctx, dot, '#ffffff', ratio);
    }
  };
}

/** A thin line with a dark one beneath. */
function stroke(ctx: CanvasRenderingContext2D, trace: (path: CanvasPath) => void, color: string, ratio: number): void {
  strokeTwice(ctx, trace, { color: 'rgba(0, 0, 0, 0.5)', width: 2.2 * ratio }, { color, width: ratio });
}

/** Shapes of the things beside the road, and the points of them that scatter into a radar. */
export function truth(street: StreetScene | null, points: readonly Point[]): Layer {
  return (context) => {
    const { ctx, plot, ratio } = context;
    const at = ground(context);
    clipToPlot(ctx, plot);
    const shapes = (path: CanvasPath): void => {
      for (const { xM, yM } of street?.outlines ?? []) {
        for (let i = 0; i < xM.length; i++) path[i ? 'lineTo' : 'moveTo'](...at(xM[i] as number, yM[i] as number));
        if (xM.length > 2) path.closePath();
      }
    };
    stroke(ctx, shapes, 'rgba(255, 255, 255, 0.8)', ratio);
    // From afar they are many to a pixel; near, rings that leave the image beneath to be seen.
    const size = Math.abs(at(0, 0.2)[0] - at(0, 0)[0]);
    const places = points.map(({ xM, yM }) => at(xM, yM));
    if (size < 4 * ratio) {
      ctx.fillStyle = TRUTH_COLOR;
      ctx.beginPath();
      for (const [px, py] of places) ctx.rect(px - 0.75 * ratio, py - 0.75 * ratio, 1.5 * ratio, 1.5 * ratio);
      ctx.fill();
      return;
    }
    const radius = Math.min(size, 6 * ratio);
    const rings = (path: CanvasPath): void => {
      for (const [px, py] of places) {
        path.moveTo(px + radius, py);
        path.arc(px, py, radius, 0, 2 * Math.PI);
      }
    };
    stroke(ctx, rings, TRUTH_COLOR, ratio);
  };
}

/** Stands apart from all colours of the maps. */
export const TRUTH_COLOR = '#ff5a4d';
