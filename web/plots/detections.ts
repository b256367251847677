/** Detections on a plot, by the weight with which they were taken as static. */

import { drawMarker, type Layer } from './layers.ts';
import { methodStyle, type SeriesStyle, THEMES, weightColor } from './theme.ts';
import type { CursorPosition, LegendEntry, View } from './types.ts';

/** What is known of detections beside where they are: how they were weighed, and which the drive knows to move. */
export interface Weighed {
  weights: ArrayLike<number> | null;
  moving: ArrayLike<number> | null;
}

/** Weight from which a detection counts as static. */
const INLIER = 0.5;

const style = (weight: number, marker: 'circle' | 'diamond'): SeriesStyle => ({
  color: { light: weightColor(weight, 'light'), dark: weightColor(weight, 'dark') },
  marker,
});
const INLIER_STYLE = style(1, 'circle');
const UNWEIGHED_STYLE: SeriesStyle = {
  color: { light: THEMES.light.muted, dark: THEMES.dark.muted },
  marker: 'circle',
};
const OUTLIER_STYLE = style(0, 'diamond');
/** A ring around what the drive itself knows to move. */
const MOVING_STYLE: SeriesStyle = { color: methodStyle('kabsch').color, marker: 'circle' };

/** What the marks mean. */
export function detectionLegend({ weights, moving }: Weighed): (LegendEntry & { id: string })[] {
  return [
    ...(weights
      ? [
          { id: 'inlier', label: `Static, weight ≥ ${INLIER}`, style: INLIER_STYLE, line: false },
          { id: 'outlier', label: 'Outlier', style: OUTLIER_STYLE, line: false, hollow: true },
        ]
      : [{ id: 'unweighed', label: 'Detection, not weighed in this frame', style: UNWEIGHED_STYLE, line: false }]),
    ...(moving
      ? [
          {
            id: 'moving',
            label: 'Ring: moving by the drive’s own labels',
            style: MOVING_STYLE,
            line: false,
            hollow: true,
          },
        ]
      : []),
  ];
}

/**
 * Filled circles for what is static, hollow diamonds for the rest; on request, what is beyond top or bottom stands at
 * the edge.
 */
export function detectionLayer(
  px: ArrayLike<number>,
  py: ArrayLike<number>,
  { weights, moving }: Weighed,
  { edge = false } = {},
): Layer {
  return ({ ctx, plot, theme, themeName, ratio, x, y }) => {
    const { left, top, width, height } = plot.bbox;
    const size = 3.6 * ratio;
    for (let i = 0; i < px.length; i++) {
      const at = x(px[i] as number);
      const level = y(py[i] as number);
      if (!Number.isFinite(at) || !Number.isFinite(level) || at < left - 1 || at > left + width + 1) continue;
      const weight = weights?.[i];
      const color = weight === undefined ? theme.muted : weightColor(weight, themeName);
      if (!edge && (level < top || level > top + height)) continue;
      const isStatic = weight === undefined || weight >= INLIER;
      const place = Math.min(Math.max(level, top + size), top + height - size);
      if (moving?.[i]) {
        ctx.strokeStyle = MOVING_STYLE.color[themeName];
        ctx.lineWidth = 1.3 * ratio;
        ctx.beginPath();
        ctx.arc(at, place, 2 * size, 0, 2 * Math.PI);
        ctx.stroke();
      }
      drawMarker(ctx, isStatic ? 'circle' : 'diamond', at, place, size, {
        stroke: color,
        fill: isStatic ? color : theme.background,
        halo: theme.background,
        ratio,
      });
    }
  };
}

/** The detection next to the cursor, if one is near: distances as shares of the plot. */
export function nearest(
  px: ArrayLike<number>,
  py: ArrayLike<number>,
  { x, y }: CursorPosition,
  { x: [left, right], y: [bottom, top] }: View,
): number | null {
  let best: number | null = null;
  let least = 0.05;
  for (let i = 0; i < px.length; i++) {
    const apart = Math.hypot(((px[i] as number) - x) / (right - left), ((py[i] as number) - y) / (top - bottom));
    if (apart < least) [best, least] = [i, apart];
  }
  return best;
}
