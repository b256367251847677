/** What a live server sends, and the angle it comes to. */
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { defineElement } from '../../../../elements/base/define.ts';
import { DopplerAzimuthElement, type MotionCurve } from '../../../../elements/kinds/doppler-azimuth.ts';
import { PointCloudElement } from '../../../../elements/kinds/point-cloud.ts';
import { carriedMotion } from '../../../../plots/doppler.ts';
import { count, fixed, signed } from '../../../../plots/format.ts';
import { methodStyle, TRUTH_STYLE } from '../../../../plots/theme.ts';
import { theme } from '../../../state/theme.ts';
import { captionLines } from '../../../ui/caption.ts';
import { ElementFrame } from '../../../ui/plot-frame.tsx';
import { OutlookOf } from '../results/outlook.tsx';
import { type Said, VerdictPanel, verdictOf } from '../results/verdict.tsx';
import { mountingState } from '../state.ts';
import {
  angle,
  beginAnew,
  channels,
  connection,
  type LiveView,
  livePlace,
  liveProblem,
  motionChannel,
  scanChannel,
  view,
} from './live.ts';

defineElement('boresight-doppler-azimuth', DopplerAzimuthElement);
defineElement('boresight-point-cloud', PointCloudElement);

/** A server that sent scans and has sent none for so long, s. */
const SILENT_S = 3;

export function View() {
  const shown = view.value;
  const problem = liveProblem.value;
  return (
    <>
      {problem && (
        <p class="alert" role="alert" data-error={problem.code}>
          {problem.message} <code>{problem.code}</code>
        </p>
      )}
      <Hindrance />
      <VerdictPanel said={said(shown)} />
      {shown?.outlook && shown.result && <OutlookOf outlook={shown.outlook} result={shown.result} />}
      {shown && <Facts shown={shown} />}
      {shown && <Angle />}
      {shown?.latest && <Scan shown={shown} />}
    </>
  );
}

/** What keeps scans from coming, or from being taken. */
function Hindrance() {
  const state = connection.value;
  const { server } = mountingState.value;
  const text = ((): string | null => {
    if (state.kind === 'waiting')
      return `No server of the Foxglove WebSocket protocol answers at ${server}${state.why ? `: ${state.why}` : ''}. Start one, by “boresight serve DRIVE” for example; it is tried again until you cancel.`;
    if (state.kind !== 'connected') return null;
    if (channels.value.length === 0) return 'The server offers no topics yet.';
    if (!scanChannel.value)
      return 'The server has no such topic of scans: foxglove.PointCloud, sensor_msgs/PointCloud2 or radar_msgs/RadarScan is expected, as JSON or CDR.';
    if (!motionChannel.value)
      return 'The server has no such topic of the car’s motion: boresight.CarMotion, nav_msgs/Odometry, geometry_msgs/TwistStamped or others, as JSON or CDR.';
    if (livePlace.value.xM === null)
      return 'The server does not say where the radar is: give its place ahead of the rear axle, under Radar.';
    return null;
  })();
  const silent = state.kind === 'connected' && view.value?.silentS;
  if (!text && !(silent && silent > SILENT_S)) return null;
  return (
    <p class="notice" role="status" data-notice="live">
      {text ?? `No scan has come for ${Math.floor(silent || 0)} s.`}
    </p>
  );
}

function said(shown: LiveView | null): Said | null {
  const result = shown?.result;
  if (result && Number.isFinite(result.sigmaDeg))
    return verdictOf([{ way: 'recursive', result }], livePlace.value.nominalDeg);
  const { kind } = connection.value;
  if (result && result.frames.given > 100)
    return verdictOf(
      [{ way: 'recursive', result }],
      livePlace.value.nominalDeg,
      'no motion came at the time of the scans: look whether both have one clock',
    );
  const head = kind === 'connected' ? 'No angle yet.' : kind === 'idle' ? 'Not connected.' : 'Connecting …';
  const why =
    kind === 'idle'
      ? 'Connect to a server on this machine, under Drive; nothing leaves the machine.'
      : 'Here it is said how sure the angle is, and whether the radar is where it should be.';
  return { kind: 'awaited', head, why };
}

/** What came, and what of it was left out. */
function Facts({ shown }: { shown: LiveView }) {
  const { counts, malformed, why, connections, scansPerS, silentS, motion, result } = shown;
  const frames = result?.frames;
  const left = frames
    ? frames.standing + frames.slow + frames.turning + frames.sparse + frames.offSpeed + frames.withoutMotion
    : 0;
  const facts: [string, string, string, string, number][] = [
    [
      'Scans',
      `${count(counts.scans)} at ${fixed(scansPerS, 1)}\u00a0Hz`,
      'Of the topic that is followed',
      'scans',
      counts.scans,
    ],
    ['Used', count(frames?.used ?? 0), 'Scans in the angle, at its last second', 'used', frames?.used ?? 0],
    [
      'Not used',
      count(left),
      'Scans that say nothing of the angle: at a standstill, slow, turning fast, with few detections, without motion',
      'unused',
      left,
    ],
    ['Motion samples', count(counts.motion), 'Of the topic that is followed', 'motion', counts.motion],
    [
      'Dropped',
      count(counts.late + counts.refused),
      'Out of order, or refused by the calibration',
      'dropped',
      counts.late + counts.refused,
    ],
    ['Not understood', count(malformed), why || 'Messages that are not what their topic says', 'malformed', malformed],
    [
      'Speed now',
      `${fixed(motion?.speedMps ?? Number.NaN, 1)}\u00a0m/s`,
      'Of the rear axle, as measured',
      'speed',
      motion?.speedMps ?? 0,
    ],
    [
      'Yaw rate now',
      `${signed(motion?.yawRateDegps ?? Number.NaN, 1)}\u00a0°/s`,
      'As measured',
      'yawRate',
      motion?.yawRateDegps ?? 0,
    ],
    ['Last scan', silentS === null ? '–' : `${fixed(silentS, 0)}\u00a0s ago`, 'When it came', 'silent', silentS ?? 0],
    [
      'Connections',
      `${count(connections)}${counts.restarts ? `, ${count(counts.restarts)} times anew` : ''}`,
      'How often the server answered, and how often its times began anew',
      'connections',
      connections,
    ],
  ];
  return (
    <>
      <dl class="facts" data-facts="live">
        {facts.map(([term, value, help, key, number]) => (
          <div key={term} title={help} data-fact={key} data-value={number}>
            <dt>{term}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
      {malformed > 0 && (
        <p class="notice" role="status" data-notice="malformed">
          {count(malformed)} messages were left out. The last: {why}
        </p>
      )}
    </>
  );
}

/** The angle over time, an element that stays the same while other pages are shown. */
function Angle() {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    place.current?.append(angle);
    return () => angle.remove();
  }, []);
  const { nominalDeg } = livePlace.value;
  const { alarm } = mountingState.value;
  useEffect(() => {
    angle.className = 'panel plot-frame medium';
    angle.dataset.plot = 'live-angle';
    angle.setAttribute('heading', 'Angle over driving time');
    angle.setAttribute('tools', '');
    angle.setAttribute('file-name', 'angle-live');
    angle.setAttribute('sigmas', '3');
    angle.setAttribute('tolerance-deg', String(alarm));
    angle.setAttribute('theme', theme.value);
    if (nominalDeg === null) angle.removeAttribute('nominal-deg');
    else angle.setAttribute('nominal-deg', String(nominalDeg));
    angle.remarks = ['Shaded: the angle ± three of its standard deviations, about once a second of the drive.'];
    angle.caption = () => captionLines(angle.remarks);
  }, [nominalDeg, alarm, theme.value]);
  return (
    <>
      <div ref={place} />
      <div class="row">
        <button
          type="button"
          data-action="begin-anew"
          onClick={beginAnew}
          title="Forgets what was found, as for a radar that was moved"
        >
          Begin anew
        </button>
      </div>
    </>
  );
}

/** The last scan: range rates over azimuth, and from above. */
function Scan({ shown }: { shown: LiveView }) {
  const { latest, result, motion: car } = shown;
  const { xM, yM, nominalDeg } = livePlace.value;
  const yawDeg = result && Number.isFinite(result.sigmaDeg) ? result.angleDeg : (nominalDeg ?? 0);
  const { scan, frame, outcome } = latest as NonNullable<LiveView['latest']>;
  const found = outcome.motion?.velocityMps;
  const data = useMemo(() => {
    const { azimuthDeg, rangeRateMps, rangeM, rcsDbsm } = scan;
    const weights = outcome.weights.some((weight) => weight > 0) ? outcome.weights : null;
    const motion = found ? { vxMps: found[0], vyMps: found[1] } : null;
    return { azimuthDeg, rangeRateMps, rangeM, rcsDbsm, weights, motion };
  }, [latest]);
  const curves: MotionCurve[] = [];
  if (car && frame.speedMps != null && frame.yawRateDegps !== null && xM !== null) {
    const motion = carriedMotion({ xM, yM, yawDeg }, frame.speedMps, frame.yawRateDegps);
    const style = { color: TRUTH_STYLE.color, width: 1.2, dash: [2, 3] };
    curves.push({ id: 'expected', label: 'From the car’s speed and yaw rate, with the angle found', motion, style });
  }
  if (data.motion) {
    const style = { ...methodStyle('recursive'), width: 2.4 };
    curves.push({ id: 'recursive', label: 'What stands, by the scan', motion: data.motion, style, leading: true });
  }
  const label = `${count(scan.azimuthDeg.length)} detections, ${outcome.verdict.replace('-', ' ')}`;
  const residual = mountingState.value.residual;
  return (
    <div class="two">
      <ElementFrame
        tag="boresight-doppler-azimuth"
        own={{ frame: data, motions: curves, residual, sector: '-90 90', 'weight-bar': true }}
        title="Range rate against azimuth"
        name="live-doppler"
        height="tall"
        remarks={[`The last scan: ${label}. Lines: what stands, −(vx cos a + vy sin a).`]}
      />
      <ElementFrame
        tag="boresight-point-cloud"
        own={{
          points: data,
          mounting: { xM: xM ?? 0, yM, yawDeg },
          boresight: true,
          'nominal-deg': nominalDeg ?? undefined,
        }}
        title="From above, in the car’s frame"
        name="live-above"
        height="tall"
        remarks={[
          `The last scan: ${label}. The radar is turned by the angle found. The car’s outline is a typical one.`,
        ]}
      />
    </div>
  );
}
