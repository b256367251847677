/** Which network is looked at, the scene it is tried on, and a user's own. */
import { models } from '../../networks/load.ts';
import { elementsOf, sightOf } from '../../networks/models.ts';
import { controlOf } from '../../ui/control.tsx';
import { ControlsHead } from '../../ui/controls-head.tsx';
import { Group, SelectField } from '../../ui/field.tsx';
import { NumberField } from '../../ui/number-field.tsx';
import { SeedField } from '../../ui/seed-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { selected, targetRange, targetsIn } from './attempt.ts';
import { OwnNetwork } from './own.tsx';
import { networksCodec, networksState, update } from './state.ts';

const Control = controlOf(networksCodec, networksState, update);

export function Controls() {
  const state = networksState.value;
  const card = selected.value?.card;
  const [fewest, most] = card ? targetRange(card) : [0, 0];
  return (
    <Sidebar label="Networks settings" button="network and scene">
      <ControlsHead
        code={async () => (await import('./code.ts')).networksCode}
        onDefaults={() => {
          networksState.value = networksCodec.defaults;
        }}
      />
      <Group title="Network">
        <SelectField
          label="Network"
          name="model"
          wide
          value={state.model}
          options={models.value.map(({ name, title }) => [name, title] as const)}
          help="Its card is shown, and it is what is tried and timed. Its file is fetched when it is first run."
          onChange={(model) => update({ model })}
        />
      </Group>
      <Group title="Scene">
        {card && fewest < most && (
          <NumberField
            label="Targets"
            name="targets"
            integer
            value={targetsIn(state, card)}
            min={fewest}
            max={most}
            help="In the simulated snapshot or region."
            onChange={(targets) => update({ targets })}
          />
        )}
        <Control
          label="SNR"
          name="snr"
          unit="dB"
          help="Of a snapshot: power of a 0 dB target at one element over the noise there. Of a region: of one sample of one chirp at one element, before any transform."
        />
        {card && sightOf(card) === 'region' && targetsIn(state, card) === 2 && (
          <Control
            label="Two targets"
            name="range"
            labels={{ apart: 'own ranges', together: 'one range' }}
            help="At one range their echoes are coherent. Also for the experiments’ plots."
          />
        )}
        {card && sightOf(card) === 'snapshot' && elementsOf(card) === null && (
          <Control label="Array" name="array" help="Any array goes; the angle lab takes positions of your own." />
        )}
        <SeedField value={state.seed} what="scene" title="Another scene" onChange={(seed) => update({ seed })} />
        {card && sightOf(card) !== 'region' && <Control label="Refine by Gauss-Newton" name="refine" />}
        <button
          type="button"
          class={state.run ? '' : 'primary'}
          data-action="toggle"
          onClick={() => update({ run: !state.run })}
        >
          {state.run ? 'Stop' : 'Run on this scene'}
        </button>
      </Group>
      <Group title="Your own network">
        <OwnNetwork />
      </Group>
    </Sidebar>
  );
}
