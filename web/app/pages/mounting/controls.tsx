/** Drive, radar, methods and options. */
import { useRef } from 'preact/hooks';
import { byteSize } from '../../plots/format.ts';
import { showHelp } from '../../state/settings.ts';
import { useFileDrop } from '../../ui/drop.ts';
import { CheckField, Group, SelectField } from '../../ui/field.tsx';
import { Licence } from '../../ui/licence.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NumberField } from '../../ui/number-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { chooseSource, loaded, openFiles, sensor } from './drive.ts';
import { droppedFiles, pickedFiles } from './entries.ts';
import { jointPossible, shownMethod, where } from './process.ts';
import { LIMITS, MOTIONS, minSpeed, mountingState, restoreDefaults, SCENARIOS, update } from './state.ts';
import { about, WAYS } from './ways.ts';

const MOTION_NAMES: Record<(typeof MOTIONS)[number], string> = {
  ransac: 'RANSAC',
  'weighted-least-squares': 'weighted LS',
  'orthogonal-distance': 'orthogonal',
  tracked: 'tracked',
};

export function Controls() {
  const state = mountingState.value;
  const format = loaded.value?.drive.format ?? '';
  return (
    <Sidebar label="Mounting angle settings" button="drive and settings">
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
          title="Back to the settings a fresh visit starts with; the drive stays"
          onClick={restoreDefaults}
        >
          Defaults
        </button>
      </div>
      <Group title="Drive">
        <Source />
      </Group>
      <Group title="Radar">
        <Radar />
      </Group>
      <Group title="Methods">
        <MethodList
          label="Methods"
          prefix="calibration"
          chosen={state.methods}
          onChange={(methods) => update({ methods })}
          items={WAYS.map((name) => {
            const { title, reference } = about(name);
            const off =
              name === 'joint' && !jointPossible.value ? 'needs several radars whose places are known' : undefined;
            return { name, title, about: reference, line: true, off };
          })}
        />
        <SelectField
          label="Frames by"
          name="shown"
          value={shownMethod.value ?? state.shown}
          wide
          options={(state.methods.length ? state.methods : WAYS).map((name) => [name, about(name).title] as const)}
          help="The method whose inliers, weights and trajectory are shown."
          onChange={(shown) => update({ shown })}
        />
        <SelectField
          label="Motion by"
          name="motion"
          value={state.motion}
          options={[['auto', 'each its own'], ...MOTIONS.map((name) => [name, MOTION_NAMES[name]] as const)]}
          help="How the radar's own motion is found in a frame. Each method has one that belongs to it: RANSAC for the mean and Kabsch, its weighted forms for the regressions, and tracking for the recursive one."
          onChange={(motion) => update({ motion })}
        />
      </Group>
      <Group title="Frames and noise">
        <NumberField
          label="Slowest"
          unit="m/s"
          name="minSpeed"
          value={minSpeed(state, format)}
          min={LIMITS.minSpeedMps[0]}
          max={LIMITS.minSpeedMps[1]}
          step={0.5}
          help="Frames in which the radar moves more slowly are left out. 3 m/s for the tracked objects of a Delphi log, else 1 m/s."
          onChange={(value) => update({ minSpeed: value })}
        />
        <NumberField
          label="Fastest turn"
          unit="°/s"
          name="maxYawRate"
          value={state.maxYawRate}
          min={LIMITS.maxYawRateDegps[0]}
          max={LIMITS.maxYawRateDegps[1]}
          step={5}
          help="Frames that turn faster are left out."
          onChange={(maxYawRate) => update({ maxYawRate })}
        />
        <NumberField
          label="Range-rate σ"
          unit="m/s"
          name="rangeRateSigma"
          value={state.rangeRateSigma}
          min={LIMITS.rangeRateSigmaMps[0]}
          max={LIMITS.rangeRateSigmaMps[1]}
          step={0.01}
          help="Standard deviation of a detection's range rate."
          onChange={(rangeRateSigma) => update({ rangeRateSigma })}
        />
        <NumberField
          label="Azimuth σ"
          unit="°"
          name="azimuthSigma"
          value={state.azimuthSigma}
          min={LIMITS.azimuthSigmaDeg[0]}
          max={LIMITS.azimuthSigmaDeg[1]}
          step={0.1}
          help="Standard deviation of a detection's azimuth."
          onChange={(azimuthSigma) => update({ azimuthSigma })}
        />
        <NumberField
          label="Inlier residual"
          unit="m/s"
          name="inlierResidual"
          value={state.inlierResidual}
          min={LIMITS.inlierResidualMps[0]}
          max={LIMITS.inlierResidualMps[1]}
          step={0.05}
          help="RANSAC takes a detection as static where its range rate is within this of the fitted curve."
          onChange={(inlierResidual) => update({ inlierResidual })}
        />
        <NumberField
          label="Least inlier share"
          name="inlierRatio"
          value={state.inlierRatio}
          min={0}
          max={1}
          step={0.05}
          help="Frames with a smaller share of static detections are left out."
          onChange={(inlierRatio) => update({ inlierRatio })}
        />
        <NumberField
          label="Fewest inliers"
          name="minInliers"
          integer
          value={state.minInliers}
          min={LIMITS.minInliers[0]}
          max={LIMITS.minInliers[1]}
          help="Frames with fewer static detections are left out."
          onChange={(minInliers) => update({ minInliers })}
        />
      </Group>
      <Group title="Judgement">
        <NumberField
          label="Misaligned from"
          unit="°"
          name="alarm"
          value={state.alarm}
          min={LIMITS.alarmDeg[0]}
          max={LIMITS.alarmDeg[1]}
          step={0.1}
          help="The alarm is raised where the angle differs from the nominal one by more than this, beyond chance."
          onChange={(alarm) => update({ alarm })}
        />
        <NumberField
          label="Settled below σ"
          unit="°"
          name="converged"
          value={state.converged}
          min={LIMITS.convergedDeg[0]}
          max={LIMITS.convergedDeg[1]}
          step={0.01}
          help="Standard deviation below which the angle may count as converged."
          onChange={(converged) => update({ converged })}
        />
      </Group>
      <Group title="Display">
        <SelectField
          label="Band"
          name="band"
          value={state.band}
          options={[
            ['1', '± 1 σ'],
            ['2', '± 2 σ'],
          ]}
          help="The standard deviation each method claims, drawn around its angle over time."
          onChange={(band) => update({ band })}
        />
        <CheckField
          label="Angles of single frames"
          name="singles"
          value={state.singles}
          help="Dots: what each frame alone gives by the method whose frames are shown."
          onChange={(singles) => update({ singles })}
        />
        <CheckField
          label="Residuals to the fit"
          name="residual"
          value={state.residual}
          help="Draws range rates less the fitted curve, which shows small deviations."
          onChange={(residual) => update({ residual })}
        />
        <SelectField
          label="Heading"
          name="heading"
          value={state.heading}
          options={[
            ['sensor', 'yaw-rate sensor'],
            ['radar', 'radar alone'],
          ]}
          help="What turns the car in its trajectory: the yaw rate as measured less its bias, or the radar's own motion, in which a wrong angle turns the car."
          onChange={(heading) => update({ heading })}
        />
      </Group>
    </Sidebar>
  );
}

function Source() {
  const files = useRef<HTMLInputElement>(null);
  const folder = useRef<HTMLInputElement>(null);
  const over = useFileDrop((transfer) => void openFiles(droppedFiles(transfer)));
  const state = mountingState.value;
  const open = loaded.value;
  const pick = (event: { currentTarget: HTMLInputElement }): void => {
    const list = pickedFiles(event.currentTarget.files);
    event.currentTarget.value = '';
    if (list.length) void openFiles(list);
  };
  return (
    <>
      <SelectField
        label="Drive"
        name="source"
        value={state.source}
        options={[
          ['delphi', 'bundled'],
          ['simulated', 'simulated'],
          ...(state.source === 'files' ? [['files', 'own files'] as const] : []),
        ]}
        help="The bundled drive is a car's front radar in traffic; a simulated one has a truth to compare with."
        onChange={(source) => {
          if (source !== 'files') chooseSource(source);
        }}
      />
      {state.source === 'simulated' && <Simulation />}
      <div class={`drop${over.value ? ' over' : ''}`}>
        {open && open.files.length > 0 && (
          <ul class="files own" aria-label="Open files">
            {open.files.slice(0, 6).map(({ name, bytes }) => (
              <li key={name}>
                <span class="file">{name}</span>
                <span class="muted">{byteSize(bytes)}</span>
              </li>
            ))}
            {open.files.length > 6 && <li class="muted">and {open.files.length - 6} more</li>}
          </ul>
        )}
        {open?.licence && (
          <Licence
            address={open.licence}
            summary="From PJLab-ADG/SensorsCalibration, Apache-2.0"
            remark="The first 600 s of its drive with a Delphi (Aptiv) ESR. These are tracked objects at 20 Hz, not raw detections; the yaw rate is differentiated from the pose."
          />
        )}
        <div class="row">
          <button
            type="button"
            onClick={() => files.current?.click()}
            title="Tables (.csv, .csv.gz) of detections and motion, or radar_data.h5"
          >
            Open files
          </button>
          <button
            type="button"
            onClick={() => folder.current?.click()}
            title="The folder of a RadarScenes sequence, or of tables"
          >
            Open a folder
          </button>
          <input
            ref={files}
            type="file"
            multiple
            hidden
            accept=".csv,.gz,.h5,.hdf5"
            aria-label="Drive files"
            data-input="files"
            onChange={pick}
          />
          <input
            ref={folder}
            type="file"
            hidden
            {...{ webkitdirectory: true }}
            aria-label="Drive folder"
            data-input="folder"
            onChange={pick}
          />
        </div>
        <p class={showHelp.value ? 'help' : 'muted small'}>
          Or drop the folder of a RadarScenes sequence, Delphi tables or general CSV tables anywhere on the page.
          Nothing is uploaded.
        </p>
      </div>
    </>
  );
}

function Simulation() {
  const state = mountingState.value;
  return (
    <>
      <SelectField
        label="Scenario"
        name="scenario"
        value={state.scenario}
        options={SCENARIOS.map((name) => [name, name.replaceAll('-', ' ')] as const)}
        help="Roads and traffic: curves, stops, what stands beside the road and who else drives."
        onChange={(scenario) => update({ scenario })}
      />
      <NumberField
        label="Duration"
        unit="s"
        name="duration"
        value={state.duration}
        min={LIMITS.durationS[0]}
        max={LIMITS.durationS[1]}
        help="Length of the drive, with four radars at 13.5 Hz."
        onChange={(duration) => update({ duration })}
      />
      <NumberField
        label="Moving share"
        unit="%"
        name="moving"
        value={state.moving ?? Number.NaN}
        min={LIMITS.movingPercent[0]}
        max={LIMITS.movingPercent[1]}
        help="Share of detections from moving road users; empty for what the scenario's traffic gives."
        onChange={(moving) => update({ moving })}
        onEmpty={() => update({ moving: null })}
      />
      <NumberField
        label="Misalignment"
        unit="°"
        name="misalignment"
        value={state.misalignment}
        min={LIMITS.misalignmentDeg[0]}
        max={LIMITS.misalignmentDeg[1]}
        step={0.1}
        help="By how much the true mounting angle of each radar exceeds its nominal one."
        onChange={(misalignment) => update({ misalignment })}
      />
      <NumberField
        label="Seed"
        name="seed"
        integer
        value={state.seed}
        min={LIMITS.seed[0]}
        max={LIMITS.seed[1]}
        help="Everything random comes from it: the same seed gives the same drive."
        onChange={(seed) => update({ seed })}
      />
      <button
        type="button"
        class="plain new-seed"
        title="Another drive of the kind"
        onClick={() => update({ seed: (state.seed + 1) % LIMITS.seed[1] })}
      >
        Next seed
      </button>
    </>
  );
}

/** Enough digits to read; nothing for what is not known. */
const short = (value: number | null): number => (value === null ? Number.NaN : Number(value.toFixed(4)));

function Radar() {
  const sensors = loaded.value?.drive.sensors ?? [];
  const radar = sensor.value;
  const at = where.value;
  if (!radar || !at) return <p class="muted small">No drive is open.</p>;
  return (
    <>
      {sensors.length > 1 && (
        <SelectField
          label="Radar"
          name="sensor"
          value={String(radar.id)}
          options={sensors.map(({ id }) => [String(id), `radar ${id}`] as const)}
          help="Each radar is calibrated by itself."
          onChange={(id) => update({ sensor: Number(id), xM: null, yM: null, nominal: null })}
        />
      )}
      <NumberField
        label="Ahead of rear axle"
        unit="m"
        name="xM"
        value={short(at.xM)}
        min={LIMITS.placeM[0]}
        max={LIMITS.placeM[1]}
        step={0.01}
        help="The radar's place ahead of the axle that does not steer. Empty for the log's."
        onChange={(xM) => update({ xM })}
        onEmpty={() => update({ xM: null })}
      />
      <NumberField
        label="Left of centre line"
        unit="m"
        name="yM"
        value={short(at.yM)}
        min={LIMITS.placeM[0]}
        max={LIMITS.placeM[1]}
        step={0.01}
        help="Negative to the right. Empty for the log's."
        onChange={(yM) => update({ yM })}
        onEmpty={() => update({ yM: null })}
      />
      <NumberField
        label="Nominal angle"
        unit="°"
        name="nominal"
        value={short(at.nominalDeg)}
        min={LIMITS.angleDeg[0]}
        max={LIMITS.angleDeg[1]}
        step={0.1}
        help="The angle it should be mounted at, positive to the left: where the search begins, and what the alarm compares with. Empty for the log's, if it has one."
        onChange={(nominal) => update({ nominal })}
        onEmpty={() => update({ nominal: null })}
      />
    </>
  );
}
