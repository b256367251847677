/** Check boxes for methods, each with its sign on the plots and the reason why it may not be chosen. */
import type { ComponentChildren } from 'preact';
import { methodStyle } from '../../plots/theme.ts';
import { Swatch } from './swatch.tsx';

export interface MethodItem<T extends string> {
  name: T;
  title: string;
  /** Shown on pointing at it. */
  about: string;
  /** Whether its sign has a line. */
  line: boolean;
  /** Why it cannot run. */
  off?: string | undefined;
  /** What went wrong with it. */
  note?: string | undefined;
  extra?: ComponentChildren;
  /** Below it, where it can run. */
  detail?: ComponentChildren;
}

export function MethodList<T extends string>(props: {
  label: string;
  /** Of the boxes' names. */
  prefix: string;
  items: readonly MethodItem<T>[];
  chosen: readonly T[];
  onChange(chosen: readonly T[]): void;
}) {
  const { items, chosen } = props;
  const change = (name: T, on: boolean): void =>
    props.onChange(items.map((item) => item.name).filter((other) => (other === name ? on : chosen.includes(other))));
  return (
    <fieldset class="methods" aria-label={props.label}>
      {items.map(({ name, title, about, line, off, note, extra, detail }) => {
        const id = `${props.prefix}-${name}`;
        const checked = chosen.includes(name);
        return (
          <div key={name} class={`method${off ? ' off' : ''}`} title={about}>
            <input
              type="checkbox"
              id={id}
              name={id}
              checked={checked}
              disabled={Boolean(off) && !checked}
              aria-describedby={`${id}-note`}
              onChange={(event) => change(name, event.currentTarget.checked)}
            />
            <Swatch style={methodStyle(name)} line={line} />
            <label for={id}>{title}</label>
            {extra}
            {!off && detail}
            <p id={`${id}-note`} class="note" hidden={!off && !note}>
              {off ?? note}
            </p>
          </div>
        );
      })}
    </fieldset>
  );
}
