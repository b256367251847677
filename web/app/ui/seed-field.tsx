/** The seed of what a page simulates, and a button for the next one. */
import { seed } from '../state/seed.ts';
import { NumberField } from './number-field.tsx';

export function SeedField(props: {
  value: number;
  /** What comes from it. */
  what: string;
  /** Of the button. */
  title: string;
  onChange(value: number): void;
}) {
  return (
    <>
      <NumberField
        label="Seed"
        name="seed"
        {...seed.range}
        value={props.value}
        help={`Everything random comes from it: the same seed gives the same ${props.what}.`}
        onChange={props.onChange}
      />
      <button
        type="button"
        class="plain new-seed"
        title={props.title}
        onClick={() => props.onChange((props.value + 1) % seed.range.max)}
      >
        Next seed
      </button>
    </>
  );
}
