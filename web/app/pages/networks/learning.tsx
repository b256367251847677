/** How a network learned: its score against the samples it had seen, beside other runs. */
import { useMemo } from 'preact/hooks';
import { count, fixed } from '../../../plots/format.ts';
import { markers, polyline } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { methodStyle, type SeriesStyle } from '../../../plots/theme.ts';
import type { Model } from '../../networks/models.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';

/** The first is the run that gave the network; a dash tells the others. */
const LOOKS: readonly Pick<SeriesStyle, 'dash' | 'marker'>[] = [
  { marker: 'diamond' },
  { dash: [7, 3], marker: 'circle' },
  { dash: [3, 3], marker: 'square' },
  { dash: [1.5, 3], marker: 'up' },
];

export function LearningPanel({ model: { card, name } }: { model: Model }) {
  const curves = card.learning ?? [];
  const plot = useMemo(() => {
    const lines = curves.map(({ title, points }, i) => ({
      title,
      style: { color: methodStyle(card.network).color, width: 1.8, ...LOOKS[i % LOOKS.length] } as SeriesStyle,
      x: points.map(({ samples }) => samples / 1000),
      y: points.map(({ f1 }) => f1),
    }));
    const most = Math.max(0, ...lines.flatMap(({ x }) => x));
    const least = Math.min(1, ...lines.flatMap(({ y }) => y));
    const margin = 0.08 * (1 - least);
    return {
      lines,
      content: {
        x: [...new Set(lines.flatMap(({ x }) => x))].sort((a, b) => a - b),
        series: [],
        extent: { x: [0, 1.05 * most] as const, y: [least - margin, 1 + margin] as const },
        above: [
          ...lines.map(({ x, y, style }) => polyline(x, y, style)),
          markers(lines.flatMap(({ x, y, style }) => x.map((at, k) => ({ x: at, y: y[k] as number, style, size: 4 })))),
        ],
      },
    };
  }, [card]);
  if (!curves.length) return null;
  const csv = (): string =>
    toCsv(
      ['run', 'samples', 'hours', 'f1'],
      curves.flatMap(({ points }, i) => points.map(({ samples, hours, f1 }) => [i + 1, samples, hours, f1])),
    );
  return (
    <PlotFrame
      key={name}
      title="How it learned"
      detail="mean F1 over the conditions of the card, on the way of training"
      name="learning"
      height="short"
      content={plot.content}
      axes={{ x: { label: 'Samples seen (thousands)' }, y: { label: 'Largest F1, mean' } }}
      legend={plot.lines.map(({ title, style, x, y }) => ({
        id: title,
        label: `${title}: ${fixed(y.at(-1) ?? Number.NaN, 3)} after ${count(1000 * (x.at(-1) ?? 0))}`,
        style,
        line: true,
      }))}
      readout={({ x, y }) => `${count(Math.round(1000 * x))} samples, F1 ${fixed(y, 3)}`}
      csv={csv}
      fileParts={[name]}
    />
  );
}
