/** Drive, radar, methods and options. */
import { ControlsHead } from '../../ui/controls-head.tsx';
import { Group, SelectField } from '../../ui/field.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { Control } from './control.ts';
import { loaded, sensor } from './drive/drive.ts';
import { Source } from './drive/source.tsx';
import { Live } from './live/panel.tsx';
import { NetworkChoice } from './motion/network-choice.tsx';
import { about, WAYS } from './motion/ways.ts';
import { jointPossible, shownMethod, where } from './results/process.ts';
import { minSpeed, mountingState, restoreDefaults, TRACKED_SPEED, USUAL_SPEED, update } from './state.ts';

export function Controls() {
  const state = mountingState.value;
  const format = loaded.value?.drive.format ?? '';
  const live = state.source === 'live';
  return (
    <Sidebar label="Mounting angle settings" button="drive and settings">
      <ControlsHead
        code={async () => (await import('./code.ts')).mountingCode}
        but="; the drive stays"
        onDefaults={restoreDefaults}
      />
      <Group title="Drive">
        <Source />
      </Group>
      <Group title="Radar">{live ? <Live part="Place" /> : <Radar />}</Group>
      {!live && <Methods />}
      <Group title="Frames and noise">
        <Control
          label="Slowest"
          name="minSpeed"
          value={minSpeed(state, format)}
          step={0.5}
          note={`Empty for ${TRACKED_SPEED} m/s with the tracked objects of a Delphi log, else ${USUAL_SPEED} m/s.`}
        />
        <Control label="Fastest turn" name="maxYawRate" step={5} />
        <Control label="Range-rate σ" name="rangeRateSigma" step={0.01} />
        <Control label="Azimuth σ" name="azimuthSigma" step={0.1} />
        <Control label="Inlier residual" name="inlierResidual" step={0.05} />
        <Control label="Least inlier share" name="inlierRatio" step={0.05} />
        <Control label="Fewest inliers" name="minInliers" />
      </Group>
      <Group title="Judgement">
        <Control label="Misaligned from" name="alarm" step={0.1} />
        <Control label="Settled below σ" name="converged" step={0.01} />
      </Group>
      {!live && <Display />}
    </Sidebar>
  );
}

function Methods() {
  const state = mountingState.value;
  return (
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
      <Control
        label="Frames by"
        name="shown"
        value={shownMethod.value ?? state.shown}
        wide
        only={state.methods.length ? state.methods : WAYS}
        labels={(way) => about(way).title}
        help="The method whose inliers, weights and trajectory are shown."
      />
      <Control
        label="Motion by"
        name="motion"
        labels={{
          auto: 'each its own',
          ransac: 'RANSAC',
          'weighted-least-squares': 'weighted LS',
          'orthogonal-distance': 'orthogonal',
          deepego: 'DeepEgo',
          'deepego-plus': 'DeepEgo+',
        }}
        help="How the radar’s own motion is found in a frame, or over eight of them (DeepEgo+)."
      />
      <NetworkChoice />
    </Group>
  );
}

function Display() {
  return (
    <Group title="Display">
      <Control
        label="Band"
        name="band"
        labels={(band) => `± ${band} σ`}
        help="The standard deviation each method claims, drawn around its angle over time."
      />
      <Control
        label="Angles of single frames"
        name="singles"
        help="Dots: what each frame alone gives by the method whose frames are shown; where motions are smoothed, before and after."
      />
      <Control
        label="Residuals to the fit"
        name="residual"
        help="Draws range rates less the fitted curve, which shows small deviations."
      />
      <Control
        label="Heading"
        name="heading"
        labels={{ sensor: 'yaw-rate sensor', radar: 'radar alone' }}
        help="What turns the car in its trajectory: the yaw rate as measured less its bias, or the radar's own motion, in which a wrong angle turns the car."
      />
    </Group>
  );
}

/** Enough digits to read. */
export const short = (value: number | null): number | null => (value === null ? null : Number(value.toFixed(4)));

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
      <Control label="Ahead of rear axle" name="xM" value={short(at.xM)} step={0.01} note="Empty for the log's." />
      <Control
        label="Left of centre line"
        name="yM"
        value={short(at.yM)}
        step={0.01}
        note="Negative to the right. Empty for the log's."
      />
      <Control
        label="Nominal angle"
        name="nominal"
        value={short(at.nominalDeg)}
        step={0.1}
        note="Positive to the left. Empty for the log's, if it has one."
      />
    </>
  );
}
