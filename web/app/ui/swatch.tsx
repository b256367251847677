/** A series' line and marker, drawn as on the plots. */
import { useEffect, useRef } from 'preact/hooks';
import { paintSwatch, SWATCH } from '../../plots/layers.ts';
import { type SeriesStyle, THEMES } from '../../plots/theme.ts';
import { theme } from '../state/theme.ts';

const { width, height } = SWATCH;

export function Swatch({ style, line, hollow = false }: { style: SeriesStyle; line: boolean; hollow?: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const name = theme.value;
  useEffect(() => {
    if (canvas.current) paintSwatch(canvas.current, { style, line, hollow }, THEMES[name], name);
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
