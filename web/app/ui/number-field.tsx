/** Fields of numbers, typed as text: nothing is written into a field while somebody types in it. */
import { useId, useRef, useState } from 'preact/hooks';
import { power } from '../../plots/format.ts';
import { type Range, rangeText, within } from '../state/range.ts';
import { useDraft } from './draft.ts';
import { type FieldProps, Help } from './field.tsx';

interface NumberProps extends Range {
  /** NaN for a number that is not known. */
  value: number;
  step?: number | undefined;
  disabled?: boolean | undefined;
  name?: string | undefined;
  onChange(value: number): void;
  /** Where a field may be empty. */
  onEmpty?: (() => void) | undefined;
}

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
/** What may become a number by further keys. */
const BEGINNING = /^[+-]?(\d+\.?\d*|\.\d*)?(e[+-]?)?$/i;

/** As attributes of accessibility have numbers, without an exponent; Preact's types know them as numbers. */
const decimal = (value: number): number | undefined =>
  Number.isFinite(value)
    ? (value.toLocaleString('en', { useGrouping: false, maximumFractionDigits: 20 }) as unknown as number)
    : undefined;
const textOf = (value: number): string => (Number.isFinite(value) ? String(value) : '');

type Reading = { value: number } | 'empty' | 'unfinished' | 'invalid';

function read(text: string, props: NumberProps): Reading {
  const plain = text.trim().replace('−', '-');
  if (plain === '' && props.onEmpty) return 'empty';
  if (!NUMBER.test(plain)) return BEGINNING.test(plain) ? 'unfinished' : 'invalid';
  const value = Number(plain);
  return within(value, props) ? { value } : 'invalid';
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
      const from = Number.isFinite(value) ? value : 0;
      const next = Number((from + direction * (props.step ?? 1)).toPrecision(12));
      const limited = Math.min(Math.max(next, min), max);
      draft.drop();
      if (within(limited, props)) send(limited);
    }
  };
  const used = Number.isFinite(value) ? `; ${power(value)} is used` : '';
  const comma = draft.text?.includes(',') ? ', decimals after a point' : '';
  return {
    problem: wrong ? `${rangeText(props)}${comma}${used}` : null,
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
      'aria-valuenow': decimal(value),
      'aria-valuemin': decimal(min),
      'aria-valuemax': decimal(max),
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
    <div class="field" title={props.help} data-option={props.option}>
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
