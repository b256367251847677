/** Fields of numbers, typed as text: nothing is written into a field while somebody types in it. */
import { useId, useRef, useState } from 'preact/hooks';
import { useDraft } from './draft.ts';
import { type FieldProps, Help } from './field.tsx';

interface NumberProps {
  /** NaN for a number that is not known. */
  value: number;
  min: number;
  max: number;
  step?: number;
  integer?: boolean;
  disabled?: boolean;
  name?: string;
  onChange(value: number): void;
  /** Where a field may be empty. */
  onEmpty?(): void;
}

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
/** What may become a number by further keys. */
const BEGINNING = /^[+-]?(\d+\.?\d*|\.\d*)?(e[+-]?)?$/i;

const textOf = (value: number): string => (Number.isFinite(value) ? String(value) : '');
const withMinus = (text: string): string => text.replaceAll('-', '−');

type Reading = { value: number } | 'empty' | 'unfinished' | 'invalid';

function read(text: string, { min, max, integer, onEmpty }: NumberProps): Reading {
  const plain = text.trim().replace('−', '-');
  if (plain === '' && onEmpty) return 'empty';
  if (!NUMBER.test(plain)) return BEGINNING.test(plain) ? 'unfinished' : 'invalid';
  const value = Number(plain);
  return value >= min && value <= max && (!integer || Number.isInteger(value)) ? { value } : 'invalid';
}

/**
 * What is valid counts at each key. What is not stays as it was typed, marked and with the reason, and the value is again
 * what it was before typing began: never that of the keys before.
 */
function useNumber(props: NumberProps) {
  const { value, min, max, integer } = props;
  const before = useRef(value);
  const [focused, setFocused] = useState(false);
  const settle = (): void => {
    before.current = value;
  };
  const draft = useDraft(textOf(value), settle);
  const reading = draft.text === null ? null : read(draft.text, props);
  const wrong = reading === 'invalid' || (reading === 'unfinished' && !focused);

  const send = (next: number): void => {
    if (Object.is(next, value)) return;
    if (Number.isFinite(next)) props.onChange(next);
    else props.onEmpty?.();
  };
  const input = (text: string): void =>
    draft.type(text, () => {
      const now = read(text, props);
      if (typeof now === 'object') send(now.value);
      else if (now === 'empty') send(Number.NaN);
      else if (now === 'invalid') send(before.current);
    });
  const leave = (): void => {
    setFocused(false);
    if (reading === 'unfinished') draft.type(draft.text ?? '', () => send(before.current));
    else if (reading !== 'invalid') {
      settle();
      draft.drop();
    }
  };
  const key = (event: KeyboardEvent): void => {
    const direction = event.key === 'ArrowUp' ? 1 : event.key === 'ArrowDown' ? -1 : 0;
    if (event.key === 'Escape' && draft.text !== null) {
      send(before.current);
      draft.drop();
    } else if (direction && !event.altKey && !event.ctrlKey && !event.metaKey) {
      event.preventDefault();
      const from = Number.isFinite(value) ? value : Math.max(min, Math.min(0, max));
      const next = Number((from + direction * (props.step ?? 1)).toPrecision(12));
      draft.drop();
      send(Math.min(Math.max(next, min), max));
    }
  };
  const range = `${integer ? 'A whole number' : 'A number'} from ${min} to ${max}`;
  const used = Number.isFinite(value) ? `; ${value} is used` : '';
  const comma = draft.text?.includes(',') ? ', decimals after a point' : '';
  return {
    problem: wrong ? withMinus(`${range}${comma}${used}`) : null,
    attributes: {
      type: 'text' as const,
      role: 'spinbutton' as const,
      'data-integer': integer ? true : undefined,
      class: 'number',
      // The number pads of some phones have no minus.
      inputMode: min < 0 ? ('text' as const) : integer ? ('numeric' as const) : ('decimal' as const),
      autocomplete: 'off',
      spellcheck: false,
      name: props.name,
      disabled: props.disabled,
      value: draft.text ?? textOf(value),
      'aria-valuenow': Number.isFinite(value) ? value : undefined,
      'aria-valuemin': min,
      'aria-valuemax': max,
      'aria-invalid': wrong ? ('true' as const) : undefined,
      onInput: (event: { currentTarget: HTMLInputElement }) => input(event.currentTarget.value),
      onFocus: () => setFocused(true),
      onBlur: leave,
      onKeyDown: key,
    },
  };
}

export function NumberField(props: FieldProps & NumberProps) {
  const id = useId();
  const { problem, attributes } = useNumber(props);
  return (
    <div class="field" title={props.help}>
      <label for={id}>{props.label}</label>
      <span class="with-unit">
        <input id={id} aria-describedby={`${id}-help ${id}-problem`} {...attributes} />
        {props.unit && <span class="unit">{props.unit}</span>}
      </span>
      <p id={`${id}-problem`} class="problem" hidden={!problem}>
        {problem}
      </p>
      <Help id={`${id}-help`}>{props.help}</Help>
    </div>
  );
}

/** A number in the cell of a table, whose headings are its label. */
export function NumberCell(props: NumberProps & { label: string }) {
  const id = useId();
  const { problem, attributes } = useNumber(props);
  return (
    <>
      <input aria-label={props.label} aria-describedby={`${id}-problem`} {...attributes} />
      <p id={`${id}-problem`} class="problem" hidden={!problem}>
        {problem}
      </p>
    </>
  );
}
