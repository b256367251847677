/** A plot of a page: an element, with what all plots of the demo have. */
import type { ComponentChildren, ComponentType } from 'preact';
import { useEffect, useRef } from 'preact/hooks';
import { defineElement } from '../../elements/base/define.ts';
import type { PlotElement } from '../../elements/base/plot-element.ts';
import type { OwnDrawing } from '../../elements/kinds/plot.ts';
import { OwnPlotElement } from '../../elements/kinds/plot.ts';
import type { CursorPosition, View } from '../../plots/types.ts';
import { theme } from '../state/theme.ts';
import { captionLines } from './caption.ts';

defineElement('boresight-plot', OwnPlotElement);

/** What a page says of a plot and hears from it, whatever element it is. */
export interface ElementProps {
  title: string;
  /** What of it is shown, beside the title. */
  detail?: string;
  /** For file names and tests. */
  name: string;
  /** Where the page has the legend elsewhere it is on saved pictures alone, or nowhere. */
  listed?: 'image' | 'none';
  imageRemarks?: readonly string[];
  /** Said below the plot and on the exported image. */
  remarks?: readonly string[];
  /** Said below the plot only. */
  hint?: string;
  /** How to use it without a mouse. */
  keys?: string;
  fileParts?: readonly (string | number)[];
  /** Buttons beside its heading, of the slot `actions`. */
  tools?: ComponentChildren;
  height: 'tall' | 'medium' | 'short' | 'portrait' | 'fill';
  /** A zoom kept elsewhere, such as one shared with another plot. */
  view?: View | null;
  /** Plots with the same one share their cursor. */
  cursorKey?: string;
  overlay?: ComponentChildren;
  onClick?(position: CursorPosition): void;
  /** In place of showing everything again. */
  onDoubleClick?(position: CursorPosition): void;
  onView?(view: View, zoomed: boolean): void;
  /** Returns true where the key was used. */
  onKey?(event: KeyboardEvent): boolean;
  onDrag?(index: number, x: number, y: number): void;
  onRemove?(index: number): void;
  /** Once the element is there; what it returns is called when it goes. */
  attach?(element: PlotElement): () => void;
}

/** An element by the name it is defined under, with properties and attributes of its own. */
export function ElementFrame({ tag, own, ...props }: ElementProps & { tag: string; own: Record<string, unknown> }) {
  const element = useRef<PlotElement>(null);
  useEffect(() => (element.current && props.attach?.(element.current)) || undefined, []);
  // Types of JSX know no elements by a name in a variable.
  const Tag = tag as unknown as ComponentType<Record<string, unknown>>;
  return (
    <Tag
      {...own}
      ref={element}
      class={`panel plot-frame ${props.height}`}
      data-plot={props.name}
      heading={props.title}
      detail={props.detail}
      hint={props.hint}
      keys={props.keys}
      legend={props.listed}
      cursor-group={props.cursorKey}
      file-name={[props.name, ...(props.fileParts ?? [])].filter((part) => part !== '').join('-')}
      theme={theme.value}
      tools
      remarks={props.remarks}
      caption={() => captionLines(props.imageRemarks ?? props.remarks)}
      {...(props.view === undefined ? {} : { zoom: props.view })}
      onboresight-select={(event: CustomEvent<CursorPosition>) => props.onClick?.(event.detail)}
      onboresight-double-click={(event: CustomEvent<CursorPosition>) => {
        if (!props.onDoubleClick) return;
        event.preventDefault();
        props.onDoubleClick(event.detail);
      }}
      onboresight-view={({ detail: { x, y, zoomed } }: CustomEvent<View & { zoomed: boolean }>) =>
        props.onView?.({ x, y }, zoomed)
      }
      onboresight-key={(event: CustomEvent<KeyboardEvent>) => {
        if (props.onKey?.(event.detail)) event.preventDefault();
      }}
      onboresight-drag={({ detail }: CustomEvent<{ index: number; x: number; y: number }>) =>
        props.onDrag?.(detail.index, detail.x, detail.y)
      }
      onboresight-remove={({ detail }: CustomEvent<{ index: number }>) => props.onRemove?.(detail.index)}
    >
      {props.tools}
      {props.overlay}
    </Tag>
  );
}

/** A plot of no kind of its own. */
export function PlotFrame({
  axes,
  content,
  legend,
  alternative,
  readout,
  csv,
  movable,
  ...props
}: ElementProps & OwnDrawing) {
  const drawing = { axes, content, legend, alternative, readout, csv, movable };
  return <ElementFrame tag="boresight-plot" own={{ drawing }} {...props} />;
}
