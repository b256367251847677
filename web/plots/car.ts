/** The car's frame on a plot, and the car in it. */
import type { Layer, LayerContext } from './layers.ts';

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
