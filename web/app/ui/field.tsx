/** Labelled controls. The help text is always there for a screen reader, and shown on request. */
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useState } from 'preact/hooks';
import { showHelp } from '../state/settings.ts';

interface FieldProps {
  label: string;
  help: string;
  unit?: string;
}

function Help({ id, children }: { id: string; children: string }) {
  return (
    <p id={id} class={showHelp.value ? 'help' : 'visually-hidden'}>
      {children}
    </p>
  );
}

/** Nothing for a number that is not known. */
const numberText = (value: number): string => (Number.isFinite(value) ? String(value) : '');

export function NumberField(
  props: FieldProps & {
    value: number;
    min: number;
    max: number;
    step?: number | 'any';
    integer?: boolean;
    disabled?: boolean;
    name?: string;
    onChange(value: number): void;
    /** Where a field may be empty. */
    onEmpty?(): void;
  },
) {
  const id = useId();
  const [text, setText] = useState(numberText(props.value));
  const [problem, setProblem] = useState<string | null>(null);
  useEffect(() => {
    if (text.trim() === '' ? Number.isFinite(props.value) : Number(text) !== props.value) {
      setText(numberText(props.value));
      setProblem(null);
    }
  }, [props.value]);
  const input = (given: string): void => {
    setText(given);
    const value = Number(given);
    const range = `${props.integer ? 'A whole number' : 'A number'} from ${props.min} to ${props.max}`.replaceAll(
      '-',
      '−',
    );
    if (given.trim() === '' && props.onEmpty) {
      setProblem(null);
      props.onEmpty();
    } else if (
      given.trim() === '' ||
      !Number.isFinite(value) ||
      value < props.min ||
      value > props.max ||
      (props.integer && !Number.isInteger(value))
    ) {
      setProblem(range);
    } else {
      setProblem(null);
      props.onChange(value);
    }
  };
  return (
    <div class="field" title={props.help}>
      <label for={id}>{props.label}</label>
      <span class="with-unit">
        <input
          id={id}
          name={props.name}
          type="number"
          inputMode="decimal"
          value={text}
          min={props.min}
          max={props.max}
          step={props.step ?? (props.integer ? 1 : 'any')}
          disabled={props.disabled}
          aria-describedby={`${id}-help ${id}-problem`}
          aria-invalid={problem ? 'true' : undefined}
          onInput={(event) => input(event.currentTarget.value)}
          onBlur={() => {
            if (problem) {
              setText(numberText(props.value));
              setProblem(null);
            }
          }}
        />
        {props.unit && <span class="unit">{props.unit}</span>}
      </span>
      <p id={`${id}-problem`} class="problem" hidden={!problem}>
        {problem}
      </p>
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

export function SelectField<T extends string>(
  props: FieldProps & {
    value: T;
    options: readonly (readonly [value: T, label: string])[];
    disabled?: boolean;
    name?: string;
    wide?: boolean;
    onChange(value: T): void;
  },
) {
  const id = useId();
  return (
    <div class={`field${props.wide ? ' wide' : ''}`} title={props.help}>
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
  props: FieldProps & { value: boolean; disabled?: boolean; name?: string; onChange(value: boolean): void },
) {
  const id = useId();
  return (
    <div class="field check" title={props.help}>
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

/** Free text that must pass a check before it is used. */
export function TextField(
  props: FieldProps & {
    value: string;
    check(text: string): string | null;
    name?: string;
    onChange(text: string): void;
  },
) {
  const id = useId();
  const [text, setText] = useState(props.value);
  useEffect(() => setText(props.value), [props.value]);
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
          setText(given);
          if (!props.check(given)) props.onChange(given);
        }}
      />
      <p id={`${id}-problem`} class="problem" role="alert" hidden={!problem}>
        {problem}
      </p>
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

export function Group({
  title,
  open = true,
  children,
}: {
  title: string;
  open?: boolean;
  children: ComponentChildren;
}) {
  return (
    <details class="group" open={open}>
      <summary>{title}</summary>
      <div class="group-body">{children}</div>
    </details>
  );
}
