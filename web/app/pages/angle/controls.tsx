/** Everything the angle lab can be told. */

import { milliseconds } from '../../../plots/format.ts';
import { api } from '../../data.ts';
import { COUNTED } from '../../methods.ts';
import { choosing, fitting } from '../../networks/choose.ts';
import { stopped } from '../../networks/load.ts';
import { controlOf } from '../../ui/control.tsx';
import { ControlsHead } from '../../ui/controls-head.tsx';
import { Group, SelectField, TextField } from '../../ui/field.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NetworkNote } from '../../ui/network-note.tsx';
import { NumberField } from '../../ui/number-field.tsx';
import { SeedField } from '../../ui/seed-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { isPending, networkFor, results, scene, unavailable } from './compute.ts';
import { angleCodec, angleState, LIMITS, positionsProblem, update } from './state.ts';
import { TargetTable } from './target-table.tsx';

export const Control = controlOf(angleCodec, angleState, update);

export function Controls() {
  const state = angleState.value;
  return (
    <Sidebar label="Angle lab settings" button="array, targets and settings">
      <ControlsHead
        code={async () => (await import('./code.ts')).angleCode}
        onDefaults={() => {
          angleState.value = angleCodec.defaults;
        }}
      />
      <Group title="Array">
        <ArrayFields />
      </Group>
      <Group title="Targets">
        <TargetTable />
      </Group>
      <Group title="Signal">
        <Control
          label="SNR"
          name="snr"
          unit="dB"
          help="Power of a 0 dB target over the noise power, both at one element and for one snapshot."
        />
        <Control
          label="Snapshots"
          name="snapshots"
          help="Independent looks at the scene. Subspace methods need several; automotive radars often have one."
        />
        <SeedField value={state.seed} what="numbers" title="Draw new noise" onChange={(seed) => update({ seed })} />
        <Control
          label="Targets"
          name="fluctuation"
          labels={{ 'complex-normal': 'fluctuate' }}
          help="From snapshot to snapshot: amplitude and phase fluctuate (complex normal), the phase alone, or nothing, as with multipath; coherent targets call for averaging or smoothing. One snapshot keeps the powers given."
        />
      </Group>
      <Group title="Methods">
        <Methods />
      </Group>
      <Group title="Estimation">
        <Control
          label="Sources"
          name="sources"
          labels={COUNTED}
          help="Whether methods are told the number of targets, or count them from the covariance's eigenvalues."
        />
        <Control
          label="Grid"
          name="grid"
          among={[256, 512, 1024, 2048, 4096]}
          labels={(points) => `${points} points`}
          note="Peaks are interpolated."
        />
        <Control label="Forward-backward averaging" name="average" />
        <Control label="Refine by Gauss-Newton" name="refine" />
        <Control label="Smoothing subarray" name="smoothing" />
      </Group>
      <Group
        title="Array imperfections"
        open={state.gain + state.phase + state.position > 0 || state.coupling !== 'off'}
      >
        <Control
          label="Gain error"
          name="gain"
          unit="dB"
          step={0.1}
          help="Standard deviation of each element's gain. The estimators assume perfect elements."
        />
        <Control label="Phase error" name="phase" unit="°" help="Standard deviation of each element's phase." />
        <Control
          label="Position error"
          name="position"
          unit="λ/2"
          step={0.01}
          help="Standard deviation of each element's place along the array, in half wavelengths."
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
  ['iwr6843isk', 'IWR6843ISK, 3 × 4, with elevation'],
  ['iwr6843aop', 'IWR6843AOP, 3 × 4 on the package'],
  ['iwr6843ods', 'IWR6843ISK-ODS, 3 × 4 in a square'],
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
                <span title={result.where === 'worker' ? 'On a worker, with the way there and back' : 'On this page'}>
                  {milliseconds(result.milliseconds)}
                </span>
              ) : shown && result && isPending(result) ? (
                <span class="muted">running</span>
              ) : null}
            </span>
          ),
        };
      })}
    />
  );
}
