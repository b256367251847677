/** True targets of an angle, with their powers. */
import type { Layer } from './layers.ts';

/** Targets as crosshairs: a stem up to their power, a ring, and their number. */
export function truthLayer(targets: readonly { azimuthDeg: number; powerDb: number }[]): Layer {
  return ({ ctx, plot, theme, ratio, x, y }) => {
    const { left, top, width, height } = plot.bbox;
    ctx.strokeStyle = theme.truth;
    ctx.fillStyle = theme.truth;
    ctx.font = `600 ${11 * ratio}px ${theme.font}`;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'bottom';
    targets.forEach((target, i) => {
      const px = x(target.azimuthDeg);
      if (px < left || px > left + width) return;
      const py = Math.min(Math.max(y(target.powerDb), top), top + height);
      const r = 8 * ratio;
      ctx.lineWidth = ratio;
      ctx.setLineDash([4 * ratio, 3 * ratio]);
      ctx.beginPath();
      ctx.moveTo(px, top + height);
      ctx.lineTo(px, py + r);
      ctx.stroke();
      ctx.setLineDash([]);
      ctx.lineWidth = 1.5 * ratio;
      ctx.beginPath();
      ctx.arc(px, py, r, 0, 2 * Math.PI);
      ctx.stroke();
      const label = Math.max(py - r - 3 * ratio, top + 12 * ratio);
      ctx.strokeStyle = theme.background;
      ctx.lineWidth = 3 * ratio;
      ctx.strokeText(String(i + 1), px, label);
      ctx.strokeStyle = theme.truth;
      ctx.fillText(String(i + 1), px, label);
    });
  };
}
