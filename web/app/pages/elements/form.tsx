/** The form of an element: its settings by its manifest, and the options of its data by the schema. */
import type { Leaf } from '../../schema-fields.ts';
import { Control } from '../../ui/control.tsx';
import { ControlsHead } from '../../ui/controls-head.tsx';
import { Group, SelectField, TextField } from '../../ui/field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { attributesOf } from './attributes.ts';
import { SAMPLES } from './samples/index.ts';
import { elementsState, sample, set, told, update } from './state.ts';

function Option({ leaf: { path, label, field } }: { leaf: Leaf }) {
  const held = elementsState.value.set.get(path);
  const { settings = {}, usual: options = {} } = sample.value;
  const given = path.startsWith('@') ? field.read(settings[path.slice(1)] ?? '') : options[path];
  const usual = given ?? field.fallback;
  const value = held === undefined ? usual : held;
  const change = (next: unknown): void => set(path, next === usual || next === '' ? null : next);
  if (field.fallback === '') {
    const { help, name } = field.option;
    return (
      <TextField label={label} name={name} help={help} value={String(value)} check={() => null} onChange={change} />
    );
  }
  return <Control of={field} name={path} label={label} value={value} onChange={change} />;
}

/** The options of a group. */
function Options({ title, group, of, open }: { title: string; group: string; of: readonly Leaf[]; open: boolean }) {
  const leaves = of.filter((leaf) => leaf.group === group);
  const isChanged = leaves.some(({ path }) => elementsState.value.set.has(path));
  return (
    <Group title={title} open={open || isChanged}>
      {leaves.map((leaf) => (
        <Option key={leaf.path} leaf={leaf} />
      ))}
    </Group>
  );
}

export function Form() {
  const { tag, leaves } = sample.value;
  const groups = [...new Set(leaves.map(({ group }) => group))];
  const attributes = attributesOf(told.value);
  return (
    <Sidebar label="Element settings" button="element and options">
      <ControlsHead onDefaults={() => update({ set: new Map() })} />
      <Group title="Element">
        <SelectField
          label="Element"
          name="element"
          wide
          value={tag}
          options={SAMPLES.map((one) => [one.tag, `<${one.tag}>`] as const)}
          help="It is shown with data that are simulated, or with a bundled recording."
          onChange={(element) => update({ element, set: new Map() })}
        />
      </Group>
      {/* Each element has a form of its own. */}
      <div key={tag}>
        <Options title="Its attributes" group="" of={attributes} open />
        <Options title="Attributes of all elements" group="all elements" of={attributes} open={false} />
        {groups.map((group) => (
          <Options
            key={group}
            title={group ? `Options: ${group.toLowerCase()}` : 'Options of its data'}
            group={group}
            of={leaves}
            open={group === ''}
          />
        ))}
      </div>
    </Sidebar>
  );
}
