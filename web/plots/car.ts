/** The car's frame on a plot, and the car in it. */
import type { Layer, LayerContext } from './layers.ts';
import { ACCENT_STYLE, type SeriesStyle } from './theme.ts';

/** Where a place in the car's frame (x ahead, y left) is on the canvas. The car looks up: the vertical axis is x. */
export const ground =
  ({ x, y }: LayerContext) =>
  (xM: number, yM: number): [x: number, y: number] => [x(yM), y(xM)];

/** A car's outline about its rear axle, m: typical, as logs do not say. */
const CAR = { behind: 1, ahead: 3.9, half: 0.93 } as const;

export function carOutline(): Layer {
  return (context) => {
    const { ctx, theme, ratio } = context;
    const at = ground(context);
    const [left, rear] = at(-CAR.behind, CAR.half);
    const [right, front] = at(CAR.ahead, -CAR.half);
    const [width, length] = [right - left, rear - front];
    ctx.fillStyle = theme.shade;
    ctx.strokeStyle = theme.muted;
    ctx.lineWidth = 1.5 * ratio;
    ctx.beginPath();
    ctx.roundRect(left, front, width, length, Math.min(4 * ratio, width / 3, length / 3));
    ctx.fill();
    ctx.stroke();
    // The windscreen tells front from back, the line is the rear axle.
    ctx.beginPath();
    for (const [xM, half] of [
      [2.4, CAR.half * 0.8],
      [0, CAR.half],
    ] as const) {
      ctx.moveTo(...at(xM, half));
      ctx.lineTo(...at(xM, -half));
    }
    ctx.lineWidth = ratio;
    ctx.stroke();
  };
}

/** Where a radar is on the car, and where it looks. */
export interface Place {
  xM: number;
  yM: number;
  yawDeg: number;
}

/** Where in the car's frame a radar sees something. */
export function inCar({ xM, yM, yawDeg }: Place, rangeM: number, azimuthDeg: number): [x: number, y: number] {
  const direction = ((azimuthDeg + yawDeg) * Math.PI) / 180;
  return [xM + rangeM * Math.cos(direction), yM + rangeM * Math.sin(direction)];
}

/** How a radar's boresight is drawn. */
export const BORESIGHT: SeriesStyle = { color: ACCENT_STYLE.color };
export const NOMINAL: SeriesStyle = { ...BORESIGHT, dash: [3, 4] };

/** The radar and where it looks: as found, and as it should. */
export function boresight({ xM, yM, yawDeg }: Place, nominalDeg: number | null): Layer {
  return (context) => {
    const { ctx, plot, themeName, ratio } = context;
    const reach = Math.hypot(plot.bbox.width, plot.bbox.height);
    const [px, py] = ground(context)(xM, yM);
    const ray = (direction: number, dash: number[]): void => {
      const radians = (direction * Math.PI) / 180;
      ctx.setLineDash(dash.map((d) => d * ratio));
      ctx.beginPath();
      ctx.moveTo(px, py);
      ctx.lineTo(px - reach * Math.sin(radians), py - reach * Math.cos(radians));
      ctx.stroke();
    };
    ctx.strokeStyle = BORESIGHT.color[themeName];
    ctx.fillStyle = BORESIGHT.color[themeName];
    ctx.lineWidth = 1.3 * ratio;
    if (nominalDeg !== null) ray(nominalDeg, NOMINAL.dash ?? []);
    ray(yawDeg, []);
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.arc(px, py, 3.5 * ratio, 0, 2 * Math.PI);
    ctx.fill();
  };
}
