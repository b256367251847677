/** A series' line and marker, drawn as on the plots. */
import { useEffect, useRef } from 'preact/hooks';
import { drawSwatch, SWATCH } from '../../plots/layers.ts';
import { type SeriesStyle, THEMES } from '../../plots/theme.ts';
import { theme } from '../state/theme.ts';

const { width, height } = SWATCH;

export function Swatch({ style, line, hollow = false }: { style: SeriesStyle; line: boolean; hollow?: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const name = theme.value;
  useEffect(() => {
    const ctx = canvas.current?.getContext('2d');
    if (!canvas.current || !ctx) return;
    const ratio = devicePixelRatio || 1;
    canvas.current.width = width * ratio;
    canvas.current.height = height * ratio;
    drawSwatch(ctx, { style, line, hollow }, { x: 0, y: (height / 2) * ratio, ratio }, THEMES[name], name);
  }, [name, style, line, hollow]);
  return (
    // biome-ignore lint/a11y/noAriaHiddenOnFocusable: a canvas without a tab index takes no focus.
    <canvas
      ref={canvas}
      class="swatch"
      width={width}
      height={height}
      style={{ width: `${width}px`, height: `${height}px` }}
      aria-hidden="true"
    />
  );
}
