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

export function Form() {
  const { tag, leaves } = sample.value;
  const groups = [...new Set(leaves.map(({ group }) => group))];
  const changed = [...elementsState.value.set.keys()];
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
        {['', 'all elements'].map((group) => (
          <Group
            key={group}
            title={group ? 'Attributes of all elements' : 'Its attributes'}
            open={
              group === '' || changed.some((path) => attributes.some((one) => one.path === path && one.group === group))
            }
          >
            {attributes
              .filter((leaf) => leaf.group === group)
              .map((leaf) => (
                <Option key={leaf.path} leaf={leaf} />
              ))}
          </Group>
        ))}
        {groups.map((group) => (
          <Group
            key={group}
            title={group ? `Options: ${group.toLowerCase()}` : 'Options of its data'}
            open={
              group === '' || changed.some((path) => leaves.some((leaf) => leaf.path === path && leaf.group === group))
            }
          >
            {leaves
              .filter((leaf) => leaf.group === group)
              .map((leaf) => (
                <Option key={leaf.path} leaf={leaf} />
              ))}
          </Group>
        ))}
      </div>
    </Sidebar>
  );
}
