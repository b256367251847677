/** Files and options of the capture page. */

import type { Method } from 'boresight';
import { byteSize, power } from '../../../plots/format.ts';
import { download } from '../../../plots/save.ts';
import { api } from '../../data.ts';
import { COUNTED } from '../../methods.ts';
import { choosing, fitting } from '../../networks/choose.ts';
import { showHelp } from '../../state/settings.ts';
import { controlOf } from '../../ui/control.tsx';
import { ControlsHead } from '../../ui/controls-head.tsx';
import { useFileDrop } from '../../ui/drop.ts';
import { Group, SelectField } from '../../ui/field.tsx';
import { FileButton } from '../../ui/file-button.tsx';
import { Licence } from '../../ui/licence.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NetworkNote } from '../../ui/network-note.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { configured } from './array-calibration/in-effect.ts';
import { ownCalibrations } from './array-calibration/own-calibrations.ts';
import { cellUnavailable, networkFor, seesElevation, usedArray } from './detections/process.ts';
import { fileProblem, isStudio, loaded, openBundled, openSimulated, reopenFiles, waiting } from './files/files.ts';
import { openFiles } from './files/open.ts';
import { SIMULATED } from './files/simulated.ts';
import { captureCodec, captureState, update } from './state.ts';

const ARRAY_NAMES = {
  awr1642: 'AWR1642',
  awr1843: 'AWR1843',
  iwr6843isk: '6843 ISK',
  iwr6843aop: '6843 AOP',
  iwr6843ods: '6843 ODS',
  cascade86: 'cascade',
};

const Control = controlOf(captureCodec, captureState, update);

const WINDOW_NAMES = {
  hann: 'Hann',
  hamming: 'Hamming',
  blackman: 'Blackman',
  'blackman-harris': 'Blackman–Harris',
  chebyshev: 'Chebyshev',
  taylor: 'Taylor',
};
const padded = (times: string): string => (times === '1' ? 'none' : `${times} ×`);

export function Controls() {
  const state = captureState.value;
  const methods = api.methods();
  return (
    <Sidebar label="Capture settings" button="files and settings">
      <ControlsHead
        code={async () => (await import('./code.ts')).captureCode}
        but="; the files stay"
        onDefaults={() => {
          captureState.value = { ...captureCodec.defaults, source: captureState.value.source };
        }}
      />
      <Group title="Files">
        <Files />
        <Control
          label="Order of I and Q"
          name="iqOrder"
          labels={{ configured: 'as configured', auto: 'as the samples tell', iq: 'I first', qi: 'Q first' }}
          note="The wrong one mirrors ranges, rates and angles."
        />
        <Control
          label="Lanes of the board"
          name="lanes"
          labels={{ configured: 'as configured', two: 'two', four: 'four' }}
          note="xWR12xx, xWR14xx and xWR22xx have four."
        />
        <SubFrame />
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
        <Control
          label="Sources in the cell"
          name="sources"
          labels={COUNTED}
          help="How many directions the subspace methods look for in one cell."
        />
        <Control label="Refine by Gauss-Newton" name="refine" />
        <Control label="Array error" name="mismatch" />
      </Group>
      <Group title="Detection">
        <Control
          label="Virtual array"
          name="array"
          labels={{ auto: 'as configured', ...ARRAY_NAMES }}
          help="Where the elements are. Must have as many transmitters and receivers as the configuration names."
        />
        <CalibrationChoice />
        <Control
          label="Threshold"
          name="cfar"
          help="Constant-false-alarm-rate detector: how the noise level around a cell is estimated."
        />
        <Control label="Along" name="axes" labels={{ doppler: 'Doppler', both: 'both (2-D)' }} />
        <Control label="False-alarm rate" name="falseAlarm" labels={power} />
        <Control label="Guard cells, range" name="guardRange" />
        <Control
          label="Training cells, range"
          name="trainRange"
          help="Cells the noise level is estimated from, on each side."
        />
        {state.axes !== 'range' && (
          <>
            <Control label="Guard cells, Doppler" name="guardDoppler" />
            <Control label="Training cells, Doppler" name="trainDoppler" help="As above, along Doppler." />
          </>
        )}
        {state.cfar === 'ordered-statistic' && (
          <Control
            label="Rank"
            name="rank"
            step={0.05}
            help="Which of the ordered training cells stands for the noise, as a share of them."
          />
        )}
        <Control label="Keep local peaks only" name="grouping" />
        <Control label="Folds of the rate to try" name="folds" />
        <Control label="Remove static clutter" name="clutter" note="Targets at rest vanish too." />
        <Control
          label="Angle by"
          name="angle"
          only={methods.map(({ name }) => name).filter((name) => !cellUnavailable.value.has(name))}
          labels={(name) => methods.find((info) => info.name === name)?.title ?? name}
          help="Method for the angle of each detection in the table."
        />
        <Control label="From range" name="nearest" help="Detections nearer than this are dropped, and counted." />
        <Control
          label="To range"
          name="farthest"
          help="Detections farther than this are dropped, and counted; 0 for no limit."
        />
        <Control label="Sector ±" name="sector" help="Detections outside this azimuth are dropped, and counted." />
        <Control
          label="Elevation ±"
          name="elevation"
          disabled={!seesElevation()}
          help="Detections steeper than this, upwards or downwards, are dropped, and counted; for arrays that see elevation."
        />
      </Group>
      <Group title="Transforms">
        <Control label="Range window" name="window" labels={WINDOW_NAMES} note="Low sidelobes cost a wide main lobe." />
        <Control label="Doppler window" name="dopplerWindow" labels={WINDOW_NAMES} />
        <Control label="Range padding" name="rangePadding" labels={padded} note="Finer bins, the same resolution." />
        <Control label="Doppler padding" name="dopplerPadding" labels={padded} />
      </Group>
      <Group title="Regions by networks">
        <Control
          label="Angles by"
          name="regionsBy"
          labels={{ cnn3d: '3D-CNN', dnn: 'DNN' }}
          help="Networks for one and for two targets; which is used a counting network says."
        />
        <Control label="Region’s window" name="regionWindow" labels={WINDOW_NAMES} />
        <Control
          label="Reach"
          name="regionReach"
          unit="bins"
          help="Range bins on each side of a peak that belong to its region; 32 is all that networks take, as in the paper."
        />
        <Control label="Loading for the count" name="countLoading" step={0.5} />
        <Control label="Turn to the coarse angle" name="rotation" labels={{ outside: 'beyond ±10.5°' }} />
        <Control label="Refine by Gauss-Newton" name="regionRefine" />
      </Group>
      <Group title="Over time">
        <Control
          label="Range gate ±"
          name="gate"
          unit="m"
          step={0.05}
          help="Ranges whose powers the micro-Doppler adds up, to both sides of the chosen cell, or of the strongest detection of all frames. Its time step is a frame."
        />
      </Group>
      <Group title="Display">
        <Control label="Colour span" name="span" labels={(span) => `${span} dB`} help="From the strongest cell down." />
        <Control
          label="Colour map"
          name="colors"
          help="All three are perceptually uniform; cividis is made for colour-blind readers."
        />
      </Group>
    </Sidebar>
  );
}

/** Where frames are made of several. */
function SubFrame() {
  const config = loaded.value?.info.config;
  if (!config || config.subFrames < 2) return null;
  const numbers = ['0', '1', '2', '3'] as const;
  return (
    <Control
      label="Sub-frame"
      name="subFrame"
      value={numbers[config.subFrame] ?? '0'}
      only={numbers.slice(0, config.subFrames)}
      labels={(number) => `${Number(number) + 1} of ${config.subFrames}`}
      onChange={(subFrame) => {
        update({ subFrame });
        void reopenFiles();
      }}
      help="Each sub-frame of an advanced frame has its own profile and chirps, and is processed by itself."
    />
  );
}

function CalibrationChoice() {
  const { calibration } = captureState.value;
  const own = ownCalibrations.value.map(({ id, name }) => [`own:${id}`, name] as const);
  const known = ['configured', 'none', ...own.map(([value]) => value)].includes(calibration);
  return (
    <SelectField
      label="Array calibration"
      name="calibration"
      wide={own.length > 0 || !known}
      value={calibration}
      options={[
        ['configured', configured.value ? 'as configured' : 'as configured: none'],
        ['none', 'none'],
        ...own,
        ...(known ? [] : [[calibration, 'not here'] as const]),
      ]}
      help="What is taken off gain and phase of each channel: the coefficients of the configuration (compRangeBiasAndRxChanPhase), or a calibration that was opened, dropped, or made under Array calibration."
      onChange={(next) => update({ calibration: next })}
    />
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

function saveSimulated(kind: 'bin' | 'cfg'): void {
  const capture = loaded.peek();
  if (capture)
    download(kind === 'bin' ? new Blob([capture.bin as BlobPart]) : new Blob([capture.cfg]), SIMULATED[kind]);
}

function Files() {
  const over = useFileDrop('capture', (files) => void openFiles(files.map(({ file }) => file)));
  const { files, missing } = waiting.value ?? { files: loaded.value?.files ?? [], missing: [] };
  const parts = files.filter(({ kind }) => kind === 'bin').length;
  return (
    <div class={`drop${over.value ? ' over' : ''}`}>
      <ul class="files" aria-label="Open files">
        {files.map(({ kind, name, bytes }) => (
          <li key={name}>
            <span class="kind">.{isStudio(name) ? 'json' : kind}</span>
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
      {parts > 1 && (
        <p class="small" role="status" data-parts={parts}>
          {loaded.value?.cascade
            ? `The ${parts} .bin files are one recording of a cascade’s four chips.`
            : `The ${parts} .bin files are one recording, in the order of their numbers, as listed.`}
        </p>
      )}
      {loaded.value?.bundled && (
        <Licence
          address={loaded.value.bundled.licence}
          summary="Recorded at the University of Colorado Boulder, Apache-2.0"
          remark="From cstahoviak/radar-velocity-estimation. The scene is not described; the board’s log names its objects."
        />
      )}
      {loaded.value?.simulated && (
        <>
          <p class="small">
            Simulated in this page, recorded by no board: a street before an AWR1843, whose second transmitter stands
            higher.
          </p>
          <div class="row">
            {(['bin', 'cfg'] as const).map((kind) => (
              <button
                key={kind}
                type="button"
                data-export={kind}
                title={`Save what was simulated as ${SIMULATED[kind]}`}
                onClick={() => saveSimulated(kind)}
              >
                Save .{kind}
              </button>
            ))}
          </div>
        </>
      )}
      <div class="row">
        <FileButton
          label="Capture files"
          accept=".bin,.cfg,.dat,.json"
          multiple
          title="A raw capture (.bin, or all the .bin of one recording, numbered or of a cascade’s chips) with its configuration (.cfg, or mmWave Studio’s .mmwave.json with .setup.json), and the board’s log (.dat) if there is one"
          onFiles={(files) => void openFiles(files.map(({ file }) => file))}
        >
          Open files
        </FileButton>
        <button
          type="button"
          onClick={() => void openBundled()}
          disabled={Boolean(loaded.value?.bundled) && !fileProblem.value}
        >
          Bundled capture
        </button>
        <button
          type="button"
          data-action="simulate"
          title="A street before a board that sees elevation, simulated in this page"
          onClick={() => void openSimulated()}
          disabled={Boolean(loaded.value?.simulated) && !fileProblem.value}
        >
          Simulated, 3-D
        </button>
      </div>
      <p class={showHelp.value ? 'help' : 'muted small'}>
        Or drop a .bin with its .cfg (or .mmwave.json and .setup.json), and a .dat, anywhere on the page; all .bin of
        one recording together, those of a cascade’s four chips too; calibrations of the array (.json), too. Nothing is
        uploaded.
      </p>
    </div>
  );
}
