/** A series' line and marker, drawn as on the plots. */
import { useEffect, useRef } from 'preact/hooks';
import { drawMarker } from '../plots/layers.ts';
import { type SeriesStyle, THEMES } from '../plots/theme.ts';
import { theme } from '../state/theme.ts';

const WIDTH = 26;
const HEIGHT = 14;

export function Swatch({ style, line, hollow = false }: { style: SeriesStyle; line: boolean; hollow?: boolean }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const name = theme.value;
  useEffect(() => {
    const ctx = canvas.current?.getContext('2d');
    if (!canvas.current || !ctx) return;
    const ratio = devicePixelRatio || 1;
    canvas.current.width = WIDTH * ratio;
    canvas.current.height = HEIGHT * ratio;
    ctx.scale(ratio, ratio);
    const color = style.color[name];
    if (line) {
      ctx.strokeStyle = color;
      ctx.lineWidth = 2;
      ctx.setLineDash(style.dash ?? []);
      ctx.beginPath();
      ctx.moveTo(1, HEIGHT / 2);
      ctx.lineTo(WIDTH - 1, HEIGHT / 2);
      ctx.stroke();
      ctx.setLineDash([]);
    }
    if (style.marker) {
      drawMarker(ctx, style.marker, WIDTH / 2, HEIGHT / 2, hollow ? 5 : 3.6, { stroke: color, fill: hollow ? null : color, halo: THEMES[name].background, ratio: 1 });
    }
  }, [name, style, line, hollow]);
  return <canvas ref={canvas} class="swatch" width={WIDTH} height={HEIGHT} style={{ width: `${WIDTH}px`, height: `${HEIGHT}px` }} aria-hidden="true" />;
}
