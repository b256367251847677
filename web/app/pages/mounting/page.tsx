import { effect, useSignalEffect } from '@preact/signals';
import type { MountingSource } from 'boresight';
import { count, fixed, signed } from '../../../plots/format.ts';
import { type Caption, useAddress } from '../../state/address.ts';
import { announce } from '../../state/announce.ts';
import { About } from '../../ui/about.tsx';
import { InTurn } from '../../ui/in-turn.tsx';
import { MainColumn } from '../../ui/main-column.tsx';
import type { GroupName } from './columns/fields.ts';
import { Controls } from './controls.tsx';
import {
  chooseSource,
  driveProblem,
  filesWanted,
  loaded,
  opening,
  scans,
  sensor,
  start as startDrive,
} from './drive/drive.ts';
import { columnsDialog } from './drive/own-files.ts';
import { frame, playing, start as startClock, telling, time } from './drive/playhead.ts';
import { Progress, TimeBar } from './drive/time-bar.tsx';
import { Live } from './live/panel.tsx';
import { AnglePlot } from './plots/angle-plot.tsx';
import { BirdPlot } from './plots/bird-plot.tsx';
import { DopplerPlot } from './plots/doppler-plot.tsx';
import { frameView } from './plots/frame.ts';
import { SharePlot } from './plots/share-plot.tsx';
import { frameKey } from './plots/time-plot.tsx';
import { start as startTrajectory } from './plots/trajectory.ts';
import { TrajectoryPlot } from './plots/trajectory-plot.tsx';
import { results, shownMethod, start as startProcess, where, working } from './results/process.ts';
import { ResultsTable } from './results/results-table.tsx';
import { Verdict } from './results/verdict.tsx';
import { minSpeed, mountingCodec, mountingState } from './state.ts';

/** The time a link asks for, until its drive is there. */
let wantedTime: number | null = null;

function restore(params: URLSearchParams): void {
  const { t, ...state } = mountingCodec.read(params);
  mountingState.value = state;
  wantedTime = t;
  if (t !== null && loaded.peek()) time.value = t;
}

/** Goes to the time wanted when a drive or radar is there to be shown. */
function followDrive(): () => void {
  let shownOf: unknown = null;
  return effect(() => {
    const { timeS } = scans.value;
    const open = loaded.value;
    if (!open || open === shownOf || !timeS.length) return;
    const first = shownOf === null;
    shownOf = open;
    playing.value = false;
    time.value = wantedTime !== null && first ? wantedTime : telling();
    wantedTime = null;
  });
}

/** What runs while the page is there; returns what ends it. */
function startPage(): () => void {
  const stops = [startDrive(), startProcess(), startTrajectory(), startClock(), followDrive()];
  const key = (event: KeyboardEvent): void => {
    const on = event.composedPath()[0] as HTMLElement;
    if (
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      on.closest('button, input, select, summary, a, [role="application"], [tabindex="0"]')
    )
      return;
    if (frameKey(event)) event.preventDefault();
  };
  addEventListener('keydown', key);
  return () => {
    removeEventListener('keydown', key);
    for (const stop of stops) stop();
  };
}

function caption(): Caption {
  const state = mountingState.peek();
  const open = loaded.peek();
  const files = open?.files.map(({ name }) => name).join(', ');
  return {
    data:
      files ||
      (state.source === 'live'
        ? `live, ${state.server}`
        : open?.source === 'simulated'
          ? `simulated, ${open.name}`
          : 'no drive'),
    settings: [
      `radar ${sensor.peek()?.id ?? 'none'}`,
      ...(open?.source === 'simulated' ? [`${state.duration} s, misaligned by ${state.misalignment}°`] : []),
      `frames from ${minSpeed(state, open?.drive.format ?? '')} m/s`,
    ].join(', '),
  };
}

export function MountingPage() {
  useAddress('mounting', {
    codec: mountingCodec,
    restore,
    start: startPage,
    write: () => {
      // While playing the address keeps the time from before.
      const at = scans.value.timeS[playing.value ? frame.peek() : frame.value];
      const t = loaded.value && at !== undefined ? Number(at.toFixed(3)) : wantedTime;
      return mountingCodec.write({ ...mountingState.value, t });
    },
    caption,
  });
  useSignalEffect(() => {
    if (working.value || !loaded.value) return;
    const found = results.value.get(shownMethod.value ?? 'recursive')?.calibration?.result;
    if (found)
      announce(`Mounting angle ${signed(found.angleDeg, 2)} degrees, standard deviation ${fixed(found.sigmaDeg, 2)}.`);
  });

  const problem = driveProblem.value;
  const open = loaded.value;
  const ColumnsDialog = columnsDialog.value;
  const live = mountingState.value.source === 'live';
  return (
    <div class="page">
      <Controls />
      <MainColumn busy={working.value || opening.value !== null}>
        {problem && (
          <p class="alert" role="alert" data-error={problem.code}>
            <strong>{problem.file ? `${problem.file}: ` : ''}</strong>
            {problem.message} <code>{problem.code}</code>
            {open && ' The drive opened before is still shown.'}
          </p>
        )}
        {filesWanted.value && (
          <p class="notice" role="status" data-notice="files">
            This link is of files that are not here. Open or drop them to see them with its settings, or{' '}
            <button type="button" onClick={() => chooseSource('delphi')}>
              open the bundled drive
            </button>
          </p>
        )}
        {open && where.value?.xM === null && (
          <p class="notice" role="status" data-notice="place">
            This drive does not say where the radar is: give its place ahead of the rear axle, under Radar.
          </p>
        )}
        {live ? <Live part="View" /> : <Verdict />}
        {open && <Summary />}
        {open && <TimeBar />}
        {open ? (
          <Plots />
        ) : (
          !live &&
          !problem &&
          !filesWanted.value && (
            <div class="panel loading" role="status">
              <Progress />
            </div>
          )
        )}
        <About title="About this page">
          <p>
            The yaw a radar is mounted at shows in its Doppler: what stands has a range rate of −(v<sub>x</sub> cos a +
            v<sub>y</sub> sin a) at azimuth a, where (v<sub>x</sub>, v<sub>y</sub>) is the radar’s own motion in its own
            frame. That motion’s direction, and the one the car’s yaw rate and the radar’s place call for, differ by the
            mounting angle.
          </p>
          <p>
            <b>Frames and signs.</b> The car’s frame is centred on the rear axle, x forward, y left. Angles are positive
            to the left, range rates positive when receding. Scale and bias are those of the yaw-rate sensor: measured =
            scale × true + bias.
          </p>
          <p>
            <b>Deviations.</b> Each method’s own. Errors that last for seconds, which real drives and tracked objects as
            in the bundled drive have, are in all of them, and so is what no drive tells from the angle. “Not
            determined” is an infinite one: the drive does not tell.
          </p>
          <p>
            <b>Files.</b> A recording of ROS 2 (.mcap) with radar_msgs/RadarScan, point clouds with a velocity or
            tracks, read in pieces whatever its size; a RadarScenes sequence (radar_data.h5), radar clouds (.pcd) of
            nuScenes or TruckScenes with their tables, frames of View-of-Delft (.bin), Delphi ESR tables, or other
            tables of detections and of the car’s motion (.csv): where their columns have names of their own, it is
            asked what they hold.
            <Template group="detections" /> and <Template group="motion" /> are tables to fill.
          </p>
        </About>
      </MainColumn>
      {ColumnsDialog && <ColumnsDialog />}
    </div>
  );
}

function Template({ group }: { group: GroupName }) {
  return (
    <button
      type="button"
      class="link"
      data-template={group}
      onClick={() => void import('./columns/template.ts').then(({ saveTemplate }) => saveTemplate(group))}
    >
      template-{group}.csv
    </button>
  );
}

function Plots() {
  const view = frameView.value;
  const start = scans.value.timeS[0] ?? 0;
  const verdict = view?.verdict ? `, ${view.verdict.replace('-', ' ')}` : '';
  const label = view
    ? `${fixed(view.timeS - start, 2)} s, frame ${frame.value + 1}: ${view.azimuthDeg.length} detections${verdict}`
    : '';
  return (
    <>
      <AnglePlot />
      <ResultsTable />
      {view && (
        <div class="two">
          <InTurn>
            <DopplerPlot view={view} label={label} />
          </InTurn>
          <InTurn>
            <BirdPlot view={view} label={label} />
          </InTurn>
        </div>
      )}
      <InTurn>
        <SharePlot />
      </InTurn>
      <InTurn>
        <TrajectoryPlot />
      </InTurn>
      <Remarks />
    </>
  );
}

/** What the drive is, at a glance; the car's motion in the frame that is shown. */
function Summary() {
  const open = loaded.value;
  const radar = sensor.value;
  const view = frameView.value;
  if (!open || !radar) return null;
  const { drive } = open;
  const { timeS, scan } = scans.value;
  const lasts = (timeS.at(-1) ?? 0) - (timeS[0] ?? 0);
  const mine = scan.reduce(
    (sum, i) => sum + (drive.scans.offsets[i + 1] as number) - (drive.scans.offsets[i] as number),
    0,
  );
  const facts: [string, string, string, string][] = [
    ['Drive', `${open.name}, ${drive.format}`, 'Its name and format', 'name'],
    ['Lasts', `${fixed(lasts, 1)}\u00a0s`, 'From the radar’s first frame to its last', 'duration'],
    ['Radars', `${drive.sensors.length}`, 'Radars of the drive', 'radars'],
    [
      'Frames',
      `${count(scan.length)} at ${fixed(lasts > 0 ? (scan.length - 1) / lasts : Number.NaN, 1)}\u00a0Hz`,
      'Of the radar that is shown',
      'frames',
    ],
    [
      'Detections',
      `${count(mine)}, ${fixed(mine / Math.max(scan.length, 1), 0)} a frame`,
      'Of the radar that is shown',
      'detections',
    ],
    ['Speed now', `${fixed(view?.speedMps ?? Number.NaN, 1)}\u00a0m/s`, 'Of the rear axle, as measured', 'speed'],
    ['Yaw rate now', `${signed(view?.yawRateDegps ?? Number.NaN, 1)}\u00a0°/s`, 'As measured', 'yawRate'],
    [
      'This frame alone',
      view?.angleDeg == null
        ? '–'
        : `${signed(view.angleDeg, 2)}°\u00a0± ${fixed(view.angleSigmaDeg ?? Number.NaN, 2)}`,
      'The mounting angle this frame gives by itself',
      'alone',
    ],
  ];
  return (
    <dl class="facts" data-facts="drive">
      {facts.map(([term, value, help, key]) => (
        <div key={term} title={help} data-fact={key}>
          <dt>{term}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

const REASONS: Record<string, string> = {
  'not-finite': 'Without finite numbers',
  'invalid-marker': 'Without range rate',
  status: 'Not valid by status',
  duplicate: 'Duplicates',
  'motion-not-finite': 'Motion without finite numbers',
  'motion-duplicate': 'Motion duplicates',
};

const MOUNTINGS: Readonly<Record<MountingSource, string>> = {
  'sensors-json': 'sensors.json',
  format: 'what is known of the format',
  'calibrated-sensor': 'calibrated_sensor.json',
  'tf-static': 'the fixed transforms of the recording',
};

/** What was left out of the files, and what they had to say. */
function Remarks() {
  const drive = loaded.value?.drive;
  if (!drive) return null;
  const { incompleteDetections, incompleteMotion } = drive.counts;
  const facts: [string, number][] = [
    ['Detections in the files', drive.counts.detections],
    ['Motion samples', drive.counts.motion],
    ...(incompleteDetections > 0
      ? [['Kept without range, place or cross-section', incompleteDetections] as [string, number]]
      : []),
    ...(incompleteMotion > 0 ? [['Motion kept without speed or pose', incompleteMotion] as [string, number]] : []),
    ...Object.entries(drive.counts.dropped).map(([reason, number]): [string, number] => [
      REASONS[reason] ?? reason,
      number,
    ]),
  ];
  return (
    <section class="panel" aria-labelledby="dropped-title">
      <div class="panel-head">
        <h3 id="dropped-title">What was left out of the files, and remarks</h3>
      </div>
      <dl class="facts flat" data-facts="counts">
        {facts.map(([term, value]) => (
          <div key={term}>
            <dt>{term}</dt>
            <dd>{count(value)}</dd>
          </div>
        ))}
      </dl>
      {drive.mountings && <p class="remark">Nominal mountings are from {MOUNTINGS[drive.mountings]}.</p>}
      {drive.warnings.length > 0 && (
        <ul class="warnings">
          {drive.warnings.map(({ code, message }, i) => (
            <li key={i}>
              {message} <code>{code}</code>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
