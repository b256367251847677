/** The car from above, at the origin of its frame. */
import type { Layer } from './layers.ts';

/** A car's outline about its rear axle, m: typical, as logs do not say. */
const CAR = { behind: 1, ahead: 3.9, half: 0.93 } as const;

export function carOutline(): Layer {
  return ({ ctx, theme, ratio, x, y }) => {
    const [back, front] = [x(-CAR.behind), x(CAR.ahead)];
    const [left, right] = [y(CAR.half), y(-CAR.half)];
    ctx.fillStyle = theme.shade;
    ctx.strokeStyle = theme.muted;
    ctx.lineWidth = 1.5 * ratio;
    ctx.beginPath();
    ctx.roundRect(back, left, front - back, right - left, Math.min(4 * ratio, (right - left) / 3));
    ctx.fill();
    ctx.stroke();
    // The windscreen tells front from back, the line is the rear axle.
    ctx.beginPath();
    ctx.moveTo(x(2.4), y(CAR.half * 0.8));
    ctx.lineTo(x(2.4), y(-CAR.half * 0.8));
    ctx.moveTo(x(0), left);
    ctx.lineTo(x(0), right);
    ctx.lineWidth = ratio;
    ctx.stroke();
  };
}
