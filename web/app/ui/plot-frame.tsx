/** A plot with its heading, tools, readout, legend and remarks. */
import { useSignal, useSignalEffect } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useRef } from 'preact/hooks';
import { type LegendEntry, png, svg } from '../../plots/picture.ts';
import { type CursorPosition, Plot, type PlotContent, type PlotOptions, type View } from '../../plots/plot.ts';
import { download, fileName } from '../../plots/save.ts';
import { announce } from '../state/announce.ts';
import { theme } from '../state/theme.ts';
import { captionLines } from './caption.ts';
import { Swatch } from './swatch.tsx';

export interface LegendItem extends LegendEntry {
  id: string;
  /** Text for the cursor's position, and while there is none. */
  value?(position: CursorPosition): string;
  rest?: string;
}

export interface PlotFrameProps {
  title: string;
  /** What of it is shown, beside the title. */
  detail?: string;
  /** For file names and tests. */
  name: string;
  options: Omit<PlotOptions, 'label' | 'theme' | 'onCursor'>;
  content: PlotContent;
  /** The cursor's position as text. */
  readout(position: CursorPosition): string;
  legend?: readonly LegendItem[];
  /** On the exported image alone, where the page says it otherwise. */
  imageLegend?: readonly LegendEntry[];
  imageRemarks?: readonly string[];
  /** Said below the plot and on the exported image. */
  remarks?: readonly string[];
  /** Said below the plot only. */
  hint?: string;
  /** How to use it without a mouse. */
  keys?: string;
  csv(): string;
  fileParts?: readonly (string | number)[];
  tools?: ComponentChildren;
  height: 'tall' | 'medium' | 'short' | 'portrait' | 'fill';
  /** A zoom kept elsewhere, such as one shared with another plot. */
  view?: View | null;
  onPlot?(plot: Plot): (() => void) | undefined;
  overlay?: ComponentChildren;
}

export function PlotFrame(props: PlotFrameProps) {
  const host = useRef<HTMLDivElement>(null);
  const plot = useRef<Plot | null>(null);
  const current = useRef(props);
  current.current = props;
  const cursor = useSignal<CursorPosition | null>(null);
  const id = useId();

  useEffect(() => {
    if (!host.current) return undefined;
    const latest = () => current.current.options;
    const made = new Plot(host.current, {
      ...props.options,
      label: [
        `${props.title}.`,
        props.keys,
        'Plus and minus zoom, 0 resets.',
        !/arrows/i.test(props.keys ?? '') && 'Left and right move the cursor.',
      ]
        .filter(Boolean)
        .join(' '),
      theme: theme.peek(),
      onCursor: (position) => {
        cursor.value = position;
        if (position && document.activeElement === host.current) announce(current.current.readout(position), 250);
      },
      ...(props.options.onClick ? { onClick: (position) => latest().onClick?.(position) } : {}),
      ...(props.options.onDoubleClick ? { onDoubleClick: (position) => latest().onDoubleClick?.(position) } : {}),
      onView: (view, zoomed) => latest().onView?.(view, zoomed),
      onKey: (event) => latest().onKey?.(event) ?? false,
    });
    plot.current = made;
    made.setContent(current.current.content);
    const stop = props.onPlot?.(made);
    return () => {
      stop?.();
      made.destroy();
      plot.current = null;
    };
  }, []);

  useEffect(() => plot.current?.setContent(props.content), [props.content]);
  useEffect(() => {
    if (props.view !== undefined) plot.current?.setView(props.view);
  }, [props.view]);
  useSignalEffect(() => plot.current?.setTheme(theme.value));

  const parts = [props.name, ...(props.fileParts ?? [])];
  const save = async (draw: typeof png, extension: string): Promise<void> => {
    if (!plot.current) return;
    const image = await draw(plot.current, {
      heading: props.detail ? `${props.title}, ${props.detail}` : props.title,
      legend: props.imageLegend ?? props.legend ?? [],
      caption: captionLines(props.imageRemarks ?? props.remarks),
    });
    download(image, fileName(parts, extension));
  };
  const described = [
    props.detail && `${id}-part`,
    props.legend?.length && `${id}-shows`,
    (props.remarks || props.hint) && `${id}-says`,
  ]
    .filter(Boolean)
    .join(' ');
  return (
    <figure class="panel plot-frame" data-plot={props.name} aria-labelledby={`${id}-title`}>
      <div class="panel-head">
        <h3 id={`${id}-title`}>{props.title}</h3>
        {props.detail && (
          <span id={`${id}-part`} class="muted detail">
            {props.detail}
          </span>
        )}
        {props.tools}
        <div class="tools" role="group" aria-label={`${props.title}: tools`}>
          <button
            type="button"
            aria-label="Zoom in"
            title={`Zoom in (+). Drag across the plot${props.options.navigate ? ' with Shift' : ''} to zoom to a region.`}
            onClick={() => plot.current?.zoomBy(0.5)}
          >
            +
          </button>
          <button type="button" aria-label="Zoom out" title="Zoom out (−)" onClick={() => plot.current?.zoomBy(2)}>
            {'−'}
          </button>
          <button type="button" title="Show everything again (0)" onClick={() => plot.current?.resetZoom()}>
            Reset
          </button>
          <button
            type="button"
            title="Save the plot as an image, at twice the screen’s resolution"
            data-export="png"
            onClick={() => void save(png, 'png')}
          >
            PNG
          </button>
          <button
            type="button"
            title="Save the plot as a drawing, whose lines and text stay sharp"
            data-export="svg"
            onClick={() => void save(svg, 'svg')}
          >
            SVG
          </button>
          <button
            type="button"
            title="Save the numbers with a header row"
            data-export="csv"
            onClick={() => download(props.csv(), fileName(parts, 'csv'))}
          >
            CSV
          </button>
        </div>
      </div>
      <Readout cursor={cursor} text={props.readout} />
      <div ref={host} class={`plot-host ${props.height}`} aria-describedby={described || undefined} />
      {props.overlay}
      {props.legend && props.legend.length > 0 && (
        <ul id={`${id}-shows`} class="legend" aria-label="Legend">
          {props.legend.map((item) => (
            <li key={item.id} data-series={item.id}>
              <Swatch style={item.style} line={item.line} hollow={item.hollow ?? false} />
              <span>{item.label}</span>
              {item.value && <LegendValue cursor={cursor} value={item.value} rest={item.rest ?? '–'} />}
            </li>
          ))}
        </ul>
      )}
      {(props.remarks || props.hint) && (
        <figcaption id={`${id}-says`}>{[...(props.remarks ?? []), props.hint].filter(Boolean).join(' ')}</figcaption>
      )}
    </figure>
  );
}

type Cursor = ReturnType<typeof useSignal<CursorPosition | null>>;

function Readout({ cursor, text }: { cursor: Cursor; text(position: CursorPosition): string }) {
  const position = cursor.value;
  return (
    <p class="readout" data-readout>
      {position ? text(position) : <span class="muted">Cursor: point at the plot</span>}
    </p>
  );
}

function LegendValue({
  cursor,
  value,
  rest,
}: {
  cursor: Cursor;
  value(position: CursorPosition): string;
  rest: string;
}) {
  const position = cursor.value;
  return <span class="legend-value">{position ? value(position) : rest}</span>;
}
