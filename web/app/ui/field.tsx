/** Labelled controls but those of numbers. The help text is always there for a screen reader, and shown on request. */
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useRef, useState } from 'preact/hooks';
import { showHelp } from '../state/settings.ts';
import { useDraft } from './draft.ts';

export interface FieldProps {
  label: string;
  help: string;
  unit?: string | undefined;
  /** Which option of the package it sets. */
  option?: string | undefined;
}

export function Help({ id, children }: { id: string; children: string }) {
  return (
    <p id={id} class={showHelp.value ? 'help' : 'visually-hidden'}>
      {children}
    </p>
  );
}

export function SelectField<T extends string>(
  props: FieldProps & {
    value: T;
    options: readonly (readonly [value: T, label: string])[];
    disabled?: boolean | undefined;
    name?: string;
    wide?: boolean | undefined;
    onChange(value: T): void;
  },
) {
  const id = useId();
  return (
    <div class={`field${props.wide ? ' wide' : ''}`} title={props.help} data-option={props.option}>
      <label for={id}>{props.label}</label>
      <select
        id={id}
        name={props.name}
        value={props.value}
        disabled={props.disabled}
        aria-describedby={`${id}-help`}
        onChange={(event) => props.onChange(event.currentTarget.value as T)}
      >
        {props.options.map(([value, label]) => (
          <option key={value} value={value} selected={value === props.value}>
            {label}
          </option>
        ))}
      </select>
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

export function CheckField(
  props: FieldProps & { value: boolean; disabled?: boolean | undefined; name?: string; onChange(value: boolean): void },
) {
  const id = useId();
  return (
    <div class="field check" title={props.help} data-option={props.option}>
      <input
        id={id}
        name={props.name}
        type="checkbox"
        checked={props.value}
        disabled={props.disabled}
        aria-describedby={`${id}-help`}
        onChange={(event) => props.onChange(event.currentTarget.checked)}
      />
      <label for={id}>{props.label}</label>
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

export function SliderField(
  props: FieldProps & {
    value: number;
    min: number;
    max: number;
    step: number;
    /** The value in words. */
    text: string;
    disabled?: boolean;
    name?: string;
    onChange(value: number): void;
  },
) {
  const id = useId();
  return (
    <div class="field slider" title={props.help}>
      <label for={id}>{props.label}</label>
      <output for={id}>{props.text}</output>
      <input
        id={id}
        name={props.name}
        type="range"
        value={props.value}
        min={props.min}
        max={props.max}
        step={props.step}
        disabled={props.disabled}
        aria-describedby={`${id}-help`}
        aria-valuetext={props.text}
        onInput={(event) => props.onChange(Number(event.currentTarget.value))}
      />
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

/** Free text that must pass a check before it is used; what does not leaves the value as it was before typing began. */
export function TextField(
  props: FieldProps & {
    value: string;
    check(text: string): string | null;
    name?: string;
    onChange(text: string): void;
  },
) {
  const id = useId();
  const before = useRef(props.value);
  const settle = (): void => {
    before.current = props.value;
  };
  const draft = useDraft(props.value, settle);
  const text = draft.text ?? props.value;
  const problem = props.check(text);
  return (
    <div class="field wide" title={props.help}>
      <label for={id}>{props.label}</label>
      <input
        id={id}
        name={props.name}
        type="text"
        value={text}
        spellcheck={false}
        autocomplete="off"
        aria-describedby={`${id}-help ${id}-problem`}
        aria-invalid={problem ? 'true' : undefined}
        onInput={(event) => {
          const given = event.currentTarget.value;
          draft.type(given, () => {
            const next = props.check(given) ? before.current : given;
            if (next !== props.value) props.onChange(next);
          });
        }}
        onBlur={() => {
          if (problem) return;
          settle();
          draft.drop();
        }}
      />
      <p id={`${id}-problem`} class="problem" role="alert" hidden={!problem}>
        {problem}
      </p>
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

/** `open` opens a group that is shut, and shuts none: what one types in must not fold away. */
export function Group({
  title,
  open = true,
  children,
}: {
  title: string;
  open?: boolean;
  children: ComponentChildren;
}) {
  const [shown, setShown] = useState(open);
  useEffect(() => {
    if (open) setShown(true);
  }, [open]);
  return (
    <details class="group" open={shown} onToggle={(event) => setShown(event.currentTarget.open)}>
      <summary>{title}</summary>
      <div class="group-body">{children}</div>
    </details>
  );
}
