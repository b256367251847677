/** Files and options of the capture page. */

import type { Method } from 'boresight';
import { useRef } from 'preact/hooks';
import { api } from '../../data.ts';
import { choosing, fitting } from '../../networks/choose.ts';
import { COLOR_MAPS } from '../../plots/colormap.ts';
import { byteSize } from '../../plots/format.ts';
import { showHelp } from '../../state/settings.ts';
import { useFileDrop } from '../../ui/drop.ts';
import { CheckField, Group, SelectField } from '../../ui/field.tsx';
import { Licence } from '../../ui/licence.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NetworkNote } from '../../ui/network-note.tsx';
import { NumberField } from '../../ui/number-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { fileProblem, loaded, openBundled, openFiles, waiting } from './files.ts';
import { cellUnavailable, networkFor, usedArray } from './process.ts';
import { CFARS, captureCodec, captureState, FALSE_ALARMS, update, WINDOWS } from './state.ts';

const WINDOW_NAMES: Record<string, string> = {
  rectangular: 'rectangular',
  hann: 'Hann',
  hamming: 'Hamming',
  blackman: 'Blackman',
  'blackman-harris': 'Blackman–Harris',
  chebyshev: 'Chebyshev',
  taylor: 'Taylor',
};
const windows = WINDOWS.map((name) => [name, WINDOW_NAMES[name] ?? name] as const);
const CFAR_NAMES: Record<string, string> = {
  'cell-averaging': 'cell averaging',
  'greatest-of': 'greatest of',
  'smallest-of': 'smallest of',
  'ordered-statistic': 'ordered statistic',
};

export function Controls() {
  const state = captureState.value;
  const methods = api.methods();
  return (
    <Sidebar label="Capture settings" button="files and settings">
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
          title="Back to the settings a fresh visit starts with; the files stay"
          onClick={() => {
            captureState.value = captureCodec.defaults;
          }}
        >
          Defaults
        </button>
      </div>
      <Group title="Files">
        <Files />
      </Group>
      <Group title="Angle methods for the cell">
        <MethodList
          label="Methods for the chosen cell"
          prefix="cell"
          chosen={state.methods}
          onChange={(chosen) => update({ methods: chosen })}
          items={methods.map((info) => ({
            name: info.name,
            title: info.title,
            about: `${info.reference}. Cost: ${info.cost}.`,
            line: info.spectrum,
            off: cellUnavailable.value.get(info.name),
            detail: info.network && <Network method={info.name} />,
          }))}
        />
        <SelectField
          label="Sources in the cell"
          name="sources"
          value={state.sources}
          options={[
            ['mdl', 'counted, MDL'],
            ['aic', 'counted, AIC'],
            ['1', '1'],
            ['2', '2'],
            ['3', '3'],
            ['4', '4'],
          ]}
          help="How many directions the subspace methods look for in one cell."
          onChange={(sources) => update({ sources })}
        />
        <CheckField
          label="Refine by Gauss-Newton"
          name="refine"
          value={state.refine}
          help="Fits all angles of a method together to the data: drops those that noise explains, adds what was missed."
          onChange={(refine) => update({ refine })}
        />
      </Group>
      <Group title="Detection">
        <SelectField
          label="Virtual array"
          name="array"
          value={state.array}
          options={[
            ['auto', 'as configured'],
            ['awr1642', 'AWR1642'],
            ['awr1843', 'AWR1843'],
            ['cascade86', 'cascade'],
            ['lrr48', 'lrr48'],
          ]}
          help="Where the elements are. Must have as many transmitters and receivers as the configuration names."
          onChange={(array) => update({ array })}
        />
        <SelectField
          label="Threshold"
          name="cfar"
          value={state.cfar}
          options={CFARS.map((kind) => [kind, CFAR_NAMES[kind] ?? kind] as const)}
          help="Constant-false-alarm-rate detector: how the noise level around a cell is estimated."
          onChange={(cfar) => update({ cfar })}
        />
        <SelectField
          label="Along"
          name="axes"
          value={state.axes}
          options={[
            ['range', 'range'],
            ['doppler', 'Doppler'],
            ['both', 'both (2-D)'],
          ]}
          help="Where the training cells lie."
          onChange={(axes) => update({ axes })}
        />
        <SelectField
          label="False-alarm rate"
          name="falseAlarm"
          value={state.falseAlarm}
          options={FALSE_ALARMS.map(
            (rate) =>
              [
                rate,
                `10^${rate.slice(2)}`.replace(/\^-(\d)/, (_, digit: string) => `⁻${'⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)]}`),
              ] as const,
          )}
          help="Probability that noise alone passes the threshold in one cell."
          onChange={(falseAlarm) => update({ falseAlarm })}
        />
        <NumberField
          label="Guard cells, range"
          name="guardRange"
          integer
          value={state.guardRange}
          min={0}
          max={32}
          help="Cells beside the tested one that are left out of the noise estimate, on each side."
          onChange={(guardRange) => update({ guardRange })}
        />
        <NumberField
          label="Training cells, range"
          name="trainRange"
          integer
          value={state.trainRange}
          min={1}
          max={64}
          help="Cells the noise level is estimated from, on each side."
          onChange={(trainRange) => update({ trainRange })}
        />
        {state.axes !== 'range' && (
          <>
            <NumberField
              label="Guard cells, Doppler"
              name="guardDoppler"
              integer
              value={state.guardDoppler}
              min={0}
              max={32}
              help="As above, along Doppler."
              onChange={(guardDoppler) => update({ guardDoppler })}
            />
            <NumberField
              label="Training cells, Doppler"
              name="trainDoppler"
              integer
              value={state.trainDoppler}
              min={1}
              max={64}
              help="As above, along Doppler."
              onChange={(trainDoppler) => update({ trainDoppler })}
            />
          </>
        )}
        {state.cfar === 'ordered-statistic' && (
          <NumberField
            label="Rank"
            name="rank"
            value={state.rank}
            min={0.05}
            max={1}
            step={0.05}
            help="Which of the ordered training cells stands for the noise, as a share of them."
            onChange={(rank) => update({ rank })}
          />
        )}
        <CheckField
          label="Keep local peaks only"
          name="grouping"
          value={state.grouping}
          help="Of adjacent cells over the threshold, the strongest stays."
          onChange={(grouping) => update({ grouping })}
        />
        <CheckField
          label="Remove static clutter"
          name="clutter"
          value={state.clutter}
          help="Subtracts the mean over chirps, and with it all that does not move. Targets at rest vanish too."
          onChange={(clutter) => update({ clutter })}
        />
        <SelectField
          label="Angle by"
          name="angle"
          value={state.angle}
          options={methods
            .filter(({ name }) => !cellUnavailable.value.has(name))
            .map(({ name, title }) => [name, title] as const)}
          help="Method for the angle of each detection in the table."
          onChange={(angle: Method) => update({ angle })}
        />
        <NumberField
          label="From range"
          unit="m"
          name="nearest"
          value={state.nearest}
          min={0}
          max={10000}
          help="Detections nearer than this are dropped, and counted."
          onChange={(nearest) => update({ nearest })}
        />
        <NumberField
          label="To range"
          unit="m"
          name="farthest"
          value={state.farthest}
          min={0}
          max={10000}
          help="Detections farther than this are dropped, and counted; 0 for no limit."
          onChange={(farthest) => update({ farthest })}
        />
        <NumberField
          label="Sector ±"
          unit="°"
          name="sector"
          value={state.sector}
          min={1}
          max={90}
          help="Detections outside this azimuth are dropped, and counted."
          onChange={(sector) => update({ sector })}
        />
      </Group>
      <Group title="Transforms">
        <SelectField
          label="Range window"
          name="window"
          value={state.window}
          options={windows}
          help="Lowers side lobes along range at the price of a wider main lobe."
          onChange={(window) => update({ window })}
        />
        <SelectField
          label="Doppler window"
          name="dopplerWindow"
          value={state.dopplerWindow}
          options={windows}
          help="The same along Doppler."
          onChange={(dopplerWindow) => update({ dopplerWindow })}
        />
        <SelectField
          label="Range padding"
          name="rangePadding"
          value={state.rangePadding}
          options={[
            ['1', 'none'],
            ['2', '2 ×'],
            ['4', '4 ×'],
          ]}
          help="Zeros appended before the transform: finer bins, the same resolution."
          onChange={(rangePadding) => update({ rangePadding })}
        />
        <SelectField
          label="Doppler padding"
          name="dopplerPadding"
          value={state.dopplerPadding}
          options={[
            ['1', 'none'],
            ['2', '2 ×'],
            ['4', '4 ×'],
            ['8', '8 ×'],
          ]}
          help="The same along Doppler."
          onChange={(dopplerPadding) => update({ dopplerPadding })}
        />
      </Group>
      <Group title="Display">
        <SelectField
          label="Colour span"
          name="span"
          value={state.span}
          options={['30', '40', '50', '60', '80'].map((span) => [span as '30', `${span} dB`] as const)}
          help="From the strongest cell down."
          onChange={(span) => update({ span })}
        />
        <SelectField
          label="Colour map"
          name="colors"
          value={state.colors}
          options={COLOR_MAPS.map((name) => [name, name] as const)}
          help="All three are perceptually uniform; cividis is made for colour-blind readers."
          onChange={(colors) => update({ colors })}
        />
      </Group>
    </Sidebar>
  );
}

function Network({ method }: { method: Method }) {
  const geometry = usedArray.value;
  const model = networkFor(method);
  if (!geometry || !model) return null;
  const { methods, angle, networks } = captureState.value;
  return (
    <NetworkNote
      model={model}
      choices={fitting(method, [geometry], null)}
      chosen={methods.includes(method) || angle === method}
      onChange={(next) => update({ networks: choosing(networks, next) })}
    />
  );
}

function Files() {
  const over = useFileDrop((transfer) => void openFiles([...transfer.files]));
  const input = useRef<HTMLInputElement>(null);
  const { files, missing } = waiting.value ?? { files: loaded.value?.files ?? [], missing: [] };
  return (
    <div class={`drop${over.value ? ' over' : ''}`}>
      <ul class="files" aria-label="Open files">
        {files.map(({ kind, name, bytes }) => (
          <li key={kind}>
            <span class="kind">.{kind}</span>
            <span class="file">{name}</span>
            <span class="muted">{byteSize(bytes)}</span>
          </li>
        ))}
        {missing.map(({ kind }) => (
          <li key={kind} data-missing={kind}>
            <span class="kind">.{kind}</span>
            <span class="problem">missing</span>
          </li>
        ))}
      </ul>
      {loaded.value?.bundled && (
        <Licence
          address={loaded.value.bundled.licence}
          summary="Recorded at the University of Colorado Boulder, Apache-2.0"
          remark="From cstahoviak/radar-velocity-estimation. The scene is not described; the board’s log names its objects."
        />
      )}
      <div class="row">
        <button
          type="button"
          onClick={() => input.current?.click()}
          title="A raw capture (.bin) with its configuration (.cfg), and the board’s log (.dat) if there is one"
        >
          Open files
        </button>
        <button
          type="button"
          onClick={() => void openBundled()}
          disabled={Boolean(loaded.value?.bundled) && !fileProblem.value}
        >
          Bundled capture
        </button>
        <input
          ref={input}
          type="file"
          multiple
          hidden
          accept=".bin,.cfg,.dat,.txt"
          aria-label="Capture files"
          onChange={(event) => {
            const list = [...(event.currentTarget.files ?? [])];
            event.currentTarget.value = '';
            void openFiles(list);
          }}
        />
      </div>
      <p class={showHelp.value ? 'help' : 'muted small'}>
        Or drop a .bin with its .cfg, and a .dat, anywhere on the page. Nothing is uploaded.
      </p>
    </div>
  );
}
