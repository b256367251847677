/** Which network is looked at, the scene it is tried on, and a user's own. */
import { models } from '../../networks/load.ts';
import { showHelp } from '../../state/settings.ts';
import { CheckField, Group, SelectField } from '../../ui/field.tsx';
import { NumberField } from '../../ui/number-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { selected, targetRange, targetsIn } from './attempt.ts';
import { OwnNetwork } from './own.tsx';
import { LIMITS, networksCodec, networksState, update } from './state.ts';

export function Controls() {
  const state = networksState.value;
  const card = selected.value?.card;
  const [fewest, most] = card ? targetRange(card) : [0, 0];
  return (
    <Sidebar label="Networks settings" button="network and scene">
      <div class="controls-head">
        <CheckField
          label="Explain the controls"
          value={showHelp.value}
          help="Shows a sentence below each control."
          onChange={(on) => {
            showHelp.value = on;
          }}
        />
        <button
          type="button"
          class="plain"
          title="Back to the settings a fresh visit starts with"
          onClick={() => {
            networksState.value = networksCodec.defaults;
          }}
        >
          Defaults
        </button>
      </div>
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
        <NumberField
          label="SNR"
          unit="dB"
          name="snr"
          value={state.snr}
          min={LIMITS.snrDb[0]}
          max={LIMITS.snrDb[1]}
          step={1}
          help="Of a snapshot: power of a 0 dB target at one element over the noise there. Of a region: of one sample of one chirp at one element, before any transform."
          onChange={(snr) => update({ snr })}
        />
        {card && card.network !== 'aaetr' && targetsIn(state, card) === 2 && (
          <SelectField
            label="Two targets"
            name="range"
            value={state.range}
            options={[
              ['apart', 'own ranges'],
              ['together', 'one range'],
            ]}
            help="At one range their echoes are coherent. Also for the experiments’ plots."
            onChange={(range) => update({ range })}
          />
        )}
        <NumberField
          label="Seed"
          name="seed"
          integer
          value={state.seed}
          min={LIMITS.seed[0]}
          max={LIMITS.seed[1]}
          help="Targets and noise are drawn from it: the same seed gives the same scene."
          onChange={(seed) => update({ seed })}
        />
        <button
          type="button"
          class="plain new-seed"
          title="Another scene"
          onClick={() => update({ seed: (state.seed + 1) % LIMITS.seed[1] })}
        >
          Next seed
        </button>
        {card?.network === 'aaetr' && (
          <CheckField
            label="Refine by Gauss-Newton"
            name="refine"
            value={state.refine}
            help="Fits all angles of a method together to the snapshot: drops those that noise explains, adds what was missed."
            onChange={(refine) => update({ refine })}
          />
        )}
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
