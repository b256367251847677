/** Everything the angle lab can be told. */
import { api } from '../../data.ts';
import { choosing, fitting } from '../../networks/choose.ts';
import { stopped } from '../../networks/load.ts';
import { milliseconds } from '../../plots/format.ts';
import { showHelp } from '../../state/settings.ts';
import { CheckField, Group, SelectField, TextField } from '../../ui/field.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NetworkNote } from '../../ui/network-note.tsx';
import { NumberCell, NumberField } from '../../ui/number-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { networkFor, results, scene, unavailable } from './compute.ts';
import {
  addTarget,
  angleCodec,
  angleState,
  freeAzimuth,
  LIMITS,
  positionsProblem,
  removeTarget,
  setTarget,
  update,
} from './state.ts';

export function Controls() {
  const state = angleState.value;
  return (
    <Sidebar label="Angle lab settings" button="array, targets and settings">
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
            angleState.value = angleCodec.defaults;
          }}
        >
          Defaults
        </button>
      </div>
      <Group title="Array">
        <ArrayFields />
      </Group>
      <Group title="Targets">
        <TargetTable />
      </Group>
      <Group title="Signal">
        <NumberField
          label="SNR"
          unit="dB"
          name="snr"
          value={state.snr}
          min={LIMITS.snrDb[0]}
          max={LIMITS.snrDb[1]}
          step={1}
          help="Power of a 0 dB target over the noise power, both at one element and for one snapshot."
          onChange={(snr) => update({ snr })}
        />
        <NumberField
          label="Snapshots"
          name="snapshots"
          integer
          value={state.snapshots}
          min={LIMITS.snapshots[0]}
          max={LIMITS.snapshots[1]}
          help="Independent looks at the scene. Subspace methods need several; automotive radars often have one."
          onChange={(snapshots) => update({ snapshots })}
        />
        <NumberField
          label="Seed"
          name="seed"
          integer
          value={state.seed}
          min={LIMITS.seed[0]}
          max={LIMITS.seed[1]}
          help="Noise, target phases and imperfections are drawn from it: the same seed gives the same numbers."
          onChange={(seed) => update({ seed })}
        />
        <button
          type="button"
          class="plain new-seed"
          title="Draw new noise"
          onClick={() => update({ seed: (state.seed + 1) % LIMITS.seed[1] })}
        >
          Next seed
        </button>
        <SelectField
          label="Targets"
          name="fluctuation"
          value={state.fluctuation}
          options={[
            ['complex-normal', 'fluctuate'],
            ['random-phase', 'random phase'],
            ['coherent', 'coherent'],
          ]}
          help="From snapshot to snapshot: amplitude and phase fluctuate (complex normal), the phase alone, or nothing, as with multipath; coherent targets call for averaging or smoothing. One snapshot keeps the powers given."
          onChange={(fluctuation) => update({ fluctuation })}
        />
      </Group>
      <Group title="Methods">
        <Methods />
      </Group>
      <Group title="Estimation">
        <SelectField
          label="Sources"
          name="sources"
          value={state.sources}
          options={[
            ['known', 'known'],
            ['mdl', 'counted, MDL'],
            ['aic', 'counted, AIC'],
          ]}
          help="Whether methods are told the number of targets, or count them from the covariance's eigenvalues."
          onChange={(sources) => update({ sources })}
        />
        <SelectField
          label="Grid"
          name="grid"
          value={String(state.grid)}
          options={['256', '512', '1024', '2048', '4096'].map((points) => [points, `${points} points`] as const)}
          help="Points of a spectrum, uniform in the sine of azimuth from -90 to 90 degrees. Peaks are interpolated."
          onChange={(grid) => update({ grid: Number(grid) })}
        />
        <CheckField
          label="Forward-backward averaging"
          name="average"
          value={state.average}
          help="Averages the covariance with its mirror image, which decorrelates coherent targets on symmetric arrays."
          onChange={(average) => update({ average })}
        />
        <CheckField
          label="Refine by Gauss-Newton"
          name="refine"
          value={state.refine}
          help="Fits all angles of a method together to the data: drops those that noise explains, adds what was missed."
          onChange={(refine) => update({ refine })}
        />
        <NumberField
          label="Smoothing subarray"
          name="smoothing"
          integer
          value={state.smoothing}
          min={0}
          max={LIMITS.elements[1]}
          help="Elements of the subarrays that spatial smoothing averages over; 0 for none. Uniform arrays only."
          onChange={(smoothing) => update({ smoothing })}
        />
      </Group>
      <Group
        title="Array imperfections"
        open={state.gain + state.phase + state.position > 0 || state.coupling !== 'off'}
      >
        <NumberField
          label="Gain error"
          unit="dB"
          name="gain"
          value={state.gain}
          min={0}
          max={6}
          step={0.1}
          help="Standard deviation of each element's gain. The estimators assume perfect elements."
          onChange={(gain) => update({ gain })}
        />
        <NumberField
          label="Phase error"
          unit={'°'}
          name="phase"
          value={state.phase}
          min={0}
          max={60}
          step={1}
          help="Standard deviation of each element's phase."
          onChange={(phase) => update({ phase })}
        />
        <NumberField
          label="Position error"
          unit={'λ/2'}
          name="position"
          value={state.position}
          min={0}
          max={0.5}
          step={0.01}
          help="Standard deviation of each element's place along the array, in half wavelengths."
          onChange={(position) => update({ position })}
        />
        <SelectField
          label="Coupling"
          name="coupling"
          value={state.coupling}
          options={[
            ['off', 'none'],
            ...['-30', '-25', '-20', '-15', '-10'].map((db) => [db, `${db.replace('-', '−')} dB`] as const),
          ]}
          help="Mutual coupling of elements half a wavelength apart; it falls with distance."
          onChange={(coupling) => update({ coupling })}
        />
      </Group>
    </Sidebar>
  );
}

const ARRAY_CHOICES = [
  ['ula', 'Uniform line of half wavelengths'],
  ['awr1642', 'AWR1642, 2 × 4, azimuth'],
  ['awr1843', 'AWR1843, 3 × 4, with elevation'],
  ['cascade86', 'Four-chip cascade, 86 in azimuth'],
  ['lrr48', 'Sparse long range, 6 × 8'],
  ['at', 'Own positions'],
] as const;

function ArrayFields() {
  const { array } = angleState.value;
  const kind = array.startsWith('ula') ? 'ula' : array.startsWith('at:') ? 'at' : (array as 'awr1642');
  const choose = (value: (typeof ARRAY_CHOICES)[number][0]): void => {
    update({ array: value === 'ula' ? 'ula10' : value === 'at' ? 'at:0,1,4,6' : value });
  };
  return (
    <>
      <SelectField
        label="Virtual array"
        name="array"
        wide
        value={kind}
        options={ARRAY_CHOICES}
        help="Virtual elements in half wavelengths. Presets are known boards and a sparse long-range radar."
        onChange={choose}
      />
      {kind === 'ula' && (
        <NumberField
          label="Elements"
          name="elements"
          integer
          value={Number(array.slice(3))}
          min={LIMITS.elements[0]}
          max={LIMITS.elements[1]}
          help="Elements half a wavelength apart."
          onChange={(elements) => update({ array: `ula${elements}` })}
        />
      )}
      {kind === 'at' && (
        <TextField
          label="Positions, half wavelengths"
          name="positions"
          value={array.slice(3)}
          check={positionsProblem}
          help="y of each element, separated by commas; y:z for an elevated one. Example: 0, 1, 4, 6."
          onChange={(text) =>
            update({
              array: `at:${text
                .split(/[\s,;]+/)
                .filter(Boolean)
                .join(',')}`,
            })
          }
        />
      )}
    </>
  );
}

/** What is typed counts to this. */
const TYPED = { azimuthDeg: 0.001, powerDb: 0.001 };

function TargetTable() {
  const { targets } = angleState.value;
  return (
    <div class="targets">
      <table>
        <thead>
          <tr>
            <th scope="col">No.</th>
            <th scope="col">Azimuth, {'°'}</th>
            <th scope="col">Power, dB</th>
            <th>
              <span class="visually-hidden">Remove</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {targets.map((target, i) => (
            <tr key={i}>
              <th scope="row">{i + 1}</th>
              <td>
                <NumberCell
                  label={`Azimuth of target ${i + 1}, degrees`}
                  name={`azimuth-${i}`}
                  value={target.azimuthDeg}
                  step={0.1}
                  min={LIMITS.azimuthDeg[0]}
                  max={LIMITS.azimuthDeg[1]}
                  onChange={(azimuthDeg) => setTarget(i, { azimuthDeg }, TYPED)}
                />
              </td>
              <td>
                <NumberCell
                  label={`Power of target ${i + 1}, dB`}
                  name={`power-${i}`}
                  value={target.powerDb}
                  step={0.5}
                  min={LIMITS.powerDb[0]}
                  max={LIMITS.powerDb[1]}
                  onChange={(powerDb) => setTarget(i, { powerDb }, TYPED)}
                />
              </td>
              <td>
                <button
                  type="button"
                  class="plain"
                  aria-label={`Remove target ${i + 1}`}
                  title="Remove"
                  onClick={() => removeTarget(i)}
                >
                  {'×'}
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <button
        type="button"
        class="plain"
        data-action="add-target"
        disabled={targets.length >= LIMITS.targets}
        onClick={() => addTarget({ azimuthDeg: freeAzimuth(targets), powerDb: 0 })}
      >
        Add target
      </button>
      <p class={showHelp.value ? 'help' : 'visually-hidden'}>
        Drag a target on the plot: sideways its azimuth, up and down its power. Double-click the plot to add one, a
        target to remove it. With the keyboard: arrows move a focused target by 0.1{'°'}, with Shift by 1{'°'}; plus and
        minus change its power; Delete removes it.
      </p>
    </div>
  );
}

function Methods() {
  return (
    <MethodList
      label="Methods"
      prefix="method"
      chosen={angleState.value.methods}
      onChange={(methods) => update({ methods })}
      items={api.methods().map((info) => {
        const off = unavailable.value.get(info.name);
        const result = results.value.get(info.name);
        const shown = !off && angleState.value.methods.includes(info.name);
        const geometry = scene.value?.geometry;
        const model = info.network && geometry ? networkFor(info.name, geometry, angleState.value) : undefined;
        return {
          name: info.name,
          title: info.title,
          about: `${info.reference}. Cost: ${info.cost}.`,
          line: info.spectrum,
          off,
          note: stopped(model?.name) ? undefined : result?.problem?.message,
          detail: model && geometry && (
            <NetworkNote
              model={model}
              choices={fitting(info.name, [geometry], null)}
              chosen={shown}
              onChange={(next) => update({ networks: choosing(angleState.value.networks, next) })}
            />
          ),
          extra: (
            <span class="time" data-time={info.name}>
              {shown && result?.milliseconds !== undefined ? (
                <span
                  class={result.stale ? 'muted' : ''}
                  title={result.where === 'worker' ? 'On a worker, with the way there and back' : 'On this page'}
                >
                  {milliseconds(result.milliseconds)}
                </span>
              ) : shown && result?.stale ? (
                <span class="muted">running</span>
              ) : null}
            </span>
          ),
        };
      })}
    />
  );
}
