/** Controls of what a page's state holds: what a field is and may be comes from where the state is described. */
import type { ReadonlySignal } from '@preact/signals';
import type { VNode } from 'preact';
import type { OfOption } from '../options.ts';
import type { ChoiceField, Field, NumberField } from '../state/codec.ts';
import { remember } from '../state/labels.ts';
import { CheckField, SelectField } from './field.tsx';
import { NumberField as NumberControl } from './number-field.tsx';

type ValueOf<F> = F extends Field<infer T> ? T : never;

/** What options bring by themselves. */
type Explained<F> = F extends OfOption
  ? {
      /** In place of what the schema says. */
      help?: string;
      /** After what the schema says. */
      note?: string;
    }
  : { help: string; unit?: string };

type OfKind<F> = F extends { range: NumberField['range'] }
  ? {
      step?: number;
      /** Numbers to choose from, where any may come with the address. */
      among?: readonly number[];
      /** What those are called. */
      labels?: (value: string) => string;
    }
  : F extends { values(): readonly (infer T extends string)[] }
    ? {
        /** What values are called where that is not what they are. */
        labels?: Readonly<Partial<Record<T, string>>> | ((value: T) => string);
        /** Those of the values that can be chosen now. */
        only?: readonly T[];
        wide?: boolean;
      }
    : unknown;

interface Common<V> {
  label: string;
  disabled?: boolean;
  /** What is shown, where that is not what the state holds. */
  value?: V;
  onChange?: (value: V) => void;
}

type Props<F, K extends keyof F> = { name: K } & Common<ValueOf<F[K]>> & Explained<F[K]> & OfKind<F[K]>;

interface Loose extends Common<unknown> {
  name: string;
  help?: string;
  note?: string;
  unit?: string;
  step?: number;
  among?: readonly number[];
  labels?: Readonly<Record<string, string>> | ((value: string) => string);
  only?: readonly string[];
  wide?: boolean;
}

/** The control of a page: it takes the name of what it sets. */
export function controlOf<F, S>(
  { fields }: { fields: F },
  state: ReadonlySignal<S>,
  update: (patch: Partial<S>) => void,
): <K extends keyof F & keyof S & string>(props: Props<F, K>) => VNode {
  return (props) => {
    const given = props as unknown as Loose;
    const { name } = given;
    const held = state.value[name as keyof S];
    remember(fields as object, name, given.label, given.unit);
    return (
      <Control
        {...given}
        of={fields[name as keyof F] as unknown as Field<unknown> & Partial<OfOption>}
        value={given.value === undefined ? held : given.value}
        onChange={given.onChange ?? ((value) => update({ [name]: value } as Partial<S>))}
      />
    );
  };
}

/** The help of a control; of an option's chosen value, too. */
function explained(
  { of, help, note }: { of: Partial<OfOption>; help?: string; note?: string },
  value = '',
  title = '',
) {
  const about = of.option?.choices[value];
  const choice = about && `${title.charAt(0).toUpperCase()}${title.slice(1)}: ${about}`;
  return [help ?? of.option?.help, note, choice].filter(Boolean).join(' ');
}

/** The control of a field that stands alone. */
export function Control(props: Loose & { of: Field<unknown> & Partial<OfOption>; onChange: (value: unknown) => void }) {
  const { of, value, onChange, label, name, disabled } = props;
  const common = {
    label,
    name,
    disabled,
    unit: of.option ? of.option.unit : props.unit,
    option: of.option?.name,
  };
  if ('range' in of && !props.among) {
    return (
      <NumberControl
        {...common}
        {...(of as NumberField).range}
        help={explained(props)}
        step={props.step}
        value={typeof value === 'number' ? value : Number.NaN}
        onChange={onChange}
        onEmpty={of.fallback === null ? () => onChange(null) : undefined}
      />
    );
  }
  if (typeof of.fallback === 'boolean') {
    return <CheckField {...common} help={explained(props)} value={value as boolean} onChange={onChange} />;
  }
  const { labels } = props;
  const nameOf = (one: string): string =>
    (typeof labels === 'function' ? labels(one) : labels?.[one]) ?? one.replaceAll('-', ' ');
  const values = props.among?.map(String) ?? props.only ?? (of as unknown as ChoiceField<string>).values();
  const chosen = String(value);
  const options = values.includes(chosen) ? values : [...values, chosen];
  return (
    <SelectField
      {...common}
      wide={props.wide}
      help={explained(props, chosen, nameOf(chosen))}
      value={chosen}
      options={options.map((one) => [one, nameOf(one)] as const)}
      onChange={(next) => onChange(props.among ? Number(next) : next)}
    />
  );
}
