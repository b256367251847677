/** OpenMetrics 1.0 of a tenant's vehicles. */

export const METRICS_TYPE = 'application/openmetrics-text; version=1.0.0; charset=utf-8';

const ALIGNMENTS = ['aligned', 'misaligned', 'undecided'];

/** @typedef {ReturnType<import('./fleet.js').Fleet['vehicles']>} Vehicles */
/** @typedef {Vehicles[number]['radars'][number]} RadarSummary */
/** Labels as they are written, and a value. @typedef {[labels: string, value: number | null | undefined]} Sample */

const ESCAPES = /** @type {Record<string, string>} */ ({ '\\': '\\\\', '"': '\\"', '\n': '\\n' });
const escaped = (/** @type {string} */ value) => value.replace(/[\\"\n]/g, (character) => ESCAPES[character] ?? '');
/** @param {string} name @param {string} value */
const label = (name, value) => `${name}="${escaped(value)}"`;

/**
 * What is measured of each radar: metric, type, what it is, and its samples.
 *
 * @type {[name: string, type: string, help: string, samples: (radar: RadarSummary) => Sample[]][]}
 */
const OF_RADARS = [
  ['boresight_mounting_angle_degrees', 'gauge', 'Mounting angle of the radar.', (r) => [['', r.angleDeg]]],
  [
    'boresight_mounting_angle_sigma_degrees',
    'gauge',
    'Standard deviation of the mounting angle.',
    (r) => [['', r.sigmaDeg ?? Number.POSITIVE_INFINITY]],
  ],
  ['boresight_nominal_angle_degrees', 'gauge', 'Angle the radar should have.', (r) => [['', r.nominalDeg]]],
  [
    'boresight_alarm_limit_degrees',
    'gauge',
    'Limit of the alarm.',
    (r) => [['', r.nominalDeg === null ? null : r.alarmDeg]],
  ],
  [
    'boresight_misaligned',
    'gauge',
    'Whether the angle differs from the nominal one beyond limit and chance.',
    (r) => [['', r.misaligned === null ? null : Number(r.misaligned)]],
  ],
  [
    'boresight_alignment',
    'stateset',
    'Whether the radar is where it should be.',
    (r) =>
      r.alignment === null
        ? []
        : ALIGNMENTS.map((state) => [label('boresight_alignment', state), Number(r.alignment === state)]),
  ],
  ['boresight_frame_time_seconds', 'gauge', 'Time of the last frame on its own clock.', (r) => [['', r.timeS]]],
  ['boresight_frames', 'counter', 'Frames taken.', (r) => [['', r.frames]]],
  ['boresight_detections', 'counter', 'Detections in frames taken.', (r) => [['', r.detections]]],
  ['boresight_stale', 'gauge', 'Whether the latest frames were all rejected.', (r) => [['', Number(r.stale)]]],
  ['boresight_clock_resets', 'counter', 'Sessions started after a clock reset.', (r) => [['', r.clockResets]]],
  ['boresight_detections_rejected', 'counter', 'Invalid detections left out.', (r) => [['', r.rejectedDetections]]],
  ['boresight_frames_repeated', 'counter', 'Frames that were sent again.', (r) => [['', r.repeated]]],
  [
    'boresight_frames_judged',
    'counter',
    'Frames taken, by what became of them.',
    ({ verdicts: { given: _, ...verdicts } }) =>
      Object.entries(verdicts).map(([verdict, count]) => [label('verdict', verdict), count]),
  ],
  ['boresight_frames_refused', 'counter', 'Frames refused, by reason.', (r) => reasons(r.refused)],
];

/** @type {[name: string, type: string, help: string, samples: (vehicle: Vehicles[number]) => Sample[]][]} */
const OF_VEHICLES = [
  ['boresight_received_timestamp_seconds', 'gauge', 'When frames last came.', (v) => [['', v.receivedMs / 1000]]],
  [
    'boresight_quarantined',
    'gauge',
    'Whether the stored data of the vehicle cannot be read.',
    (v) => [['', Number(v.quarantined !== undefined)]],
  ],
  ['boresight_lines_refused', 'counter', 'Lines refused that name no radar, by reason.', (v) => reasons(v.refused)],
];

/** @typedef {{ halfOpen: number, withoutRequest: number }} Connections */

/** @type {[name: string, type: string, help: string, value: (connections: Connections) => number][]} */
const OF_CONNECTIONS = [
  ['boresight_connections_half_open', 'gauge', 'Connections that have sent no request yet.', (c) => c.halfOpen],
  [
    'boresight_connections_without_request',
    'counter',
    'Connections that were closed before they sent a request.',
    (c) => c.withoutRequest,
  ],
];

/** @param {Record<string, number>} refused @returns {Sample[]} */
const reasons = (refused) => Object.entries(refused).map(([reason, count]) => [label('reason', reason), count]);

/** @param {number} value */
const written = (value) =>
  Number.isFinite(value) ? String(value) : Number.isNaN(value) ? 'NaN' : value > 0 ? '+Inf' : '-Inf';

/** @param {Vehicles} vehicles @param {Connections} [connections] where the runtime counts them */
export function openMetrics(vehicles, connections) {
  // Labels of a radar are on many lines, and are written once.
  const ofVehicles = vehicles.map((vehicle) => ({ labels: label('vehicle', vehicle.vehicle), of: vehicle }));
  const ofRadars = ofVehicles.flatMap(({ labels, of: { radars } }) =>
    radars.map((radar) => ({ labels: `${labels},${label('radar', radar.radar)}`, of: radar })),
  );
  const lines = [
    ...OF_RADARS.map(([name, type, help, samples]) => family(name, type, help, ofRadars, samples)),
    ...OF_VEHICLES.map(([name, type, help, samples]) => family(name, type, help, ofVehicles, samples)),
    ...OF_CONNECTIONS.map(([name, type, help, value]) =>
      family(name, type, help, connections ? [{ labels: '', of: connections }] : [], (c) => [['', value(c)]]),
    ),
  ];
  return `${lines.join('')}# EOF\n`;
}

/**
 * @template T
 * @param {string} name
 * @param {string} type
 * @param {string} help
 * @param {{ labels: string, of: T }[]} subjects
 * @param {(subject: T) => Sample[]} samples
 */
function family(name, type, help, subjects, samples) {
  const unit = /_(degrees|seconds)$/.exec(name)?.[1];
  const metric = type === 'counter' ? `${name}_total` : name;
  let text = `# TYPE ${name} ${type}\n${unit ? `# UNIT ${name} ${unit}\n` : ''}# HELP ${name} ${help}\n`;
  for (const { labels, of } of subjects) {
    for (const [more, value] of samples(of)) {
      if (value === null || value === undefined) continue;
      const all = labels && more ? `${labels},${more}` : labels || more;
      text += `${metric}${all && `{${all}}`} ${written(value)}\n`;
    }
  }
  return text;
}
