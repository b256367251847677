/** OpenMetrics 1.0 of a tenant's vehicles. */

export const METRICS_TYPE = 'application/openmetrics-text; version=1.0.0; charset=utf-8';

/** @typedef {ReturnType<import('./fleet.js').Fleet['vehicles']>} Vehicles */
/** @typedef {Vehicles[number]['radars'][number]} RadarSummary */
/** Writes a sample, with further labels. @typedef {(value: number | null | undefined, labels?: string) => void} Write */

const ESCAPES = /** @type {Record<string, string>} */ ({ '\\': '\\\\', '"': '\\"', '\n': '\\n' });
const escaped = (/** @type {string} */ value) => value.replace(/[\\"\n]/g, (character) => ESCAPES[character] ?? '');
/** @param {string} name @param {string} value */
const label = (name, value) => `${name}="${escaped(value)}"`;

const ALIGNMENTS = ['aligned', 'misaligned', 'undecided'].map((state) => [state, label('boresight_alignment', state)]);

/**
 * What is measured of each radar: metric, type, what it is, and its samples.
 *
 * @type {[name: string, type: string, help: string, samples: (radar: RadarSummary, write: Write) => void][]}
 */
const OF_RADARS = [
  ['boresight_mounting_angle_degrees', 'gauge', 'Mounting angle of the radar.', (r, write) => write(r.angleDeg)],
  [
    'boresight_mounting_angle_sigma_degrees',
    'gauge',
    'Standard deviation of the mounting angle.',
    (r, write) => write(r.sigmaDeg ?? Number.POSITIVE_INFINITY),
  ],
  ['boresight_nominal_angle_degrees', 'gauge', 'Angle the radar should have.', (r, write) => write(r.nominalDeg)],
  [
    'boresight_alarm_limit_degrees',
    'gauge',
    'Limit of the alarm.',
    (r, write) => write(r.nominalDeg === null ? null : r.alarmDeg),
  ],
  [
    'boresight_misaligned',
    'gauge',
    'Whether the angle differs from the nominal one beyond limit and chance.',
    (r, write) => write(r.misaligned === null ? null : Number(r.misaligned)),
  ],
  [
    'boresight_alignment',
    'stateset',
    'Whether the radar is where it should be.',
    (r, write) => {
      if (r.alignment === null) return;
      for (const [state, labels] of ALIGNMENTS) write(Number(r.alignment === state), labels);
    },
  ],
  ['boresight_frame_time_seconds', 'gauge', 'Time of the last frame on its own clock.', (r, write) => write(r.timeS)],
  ['boresight_frames', 'counter', 'Frames taken.', (r, write) => write(r.frames)],
  ['boresight_detections', 'counter', 'Detections in frames taken.', (r, write) => write(r.detections)],
  ['boresight_stale', 'gauge', 'Whether the latest frames were all rejected.', (r, write) => write(Number(r.stale))],
  ['boresight_clock_resets', 'counter', 'Sessions started after a clock reset.', (r, write) => write(r.clockResets)],
  [
    'boresight_detections_rejected',
    'counter',
    'Invalid detections left out.',
    (r, write) => write(r.rejectedDetections),
  ],
  ['boresight_frames_repeated', 'counter', 'Frames that were sent again.', (r, write) => write(r.repeated)],
  [
    'boresight_frames_judged',
    'counter',
    'Frames taken, by what became of them.',
    ({ verdicts }, write) => {
      for (const verdict in verdicts) {
        if (verdict !== 'given')
          write(verdicts[/** @type {keyof typeof verdicts} */ (verdict)], label('verdict', verdict));
      }
    },
  ],
  ['boresight_frames_refused', 'counter', 'Frames refused, by reason.', (r, write) => reasons(r.refused, write)],
];

/** @type {[name: string, type: string, help: string, samples: (vehicle: Vehicles[number], write: Write) => void][]} */
const OF_VEHICLES = [
  ['boresight_received_timestamp_seconds', 'gauge', 'When frames last came.', (v, write) => write(v.receivedMs / 1000)],
  [
    'boresight_quarantined',
    'gauge',
    'Whether the stored data of the vehicle cannot be read.',
    (v, write) => write(Number(v.quarantined !== undefined)),
  ],
  [
    'boresight_lines_refused',
    'counter',
    'Lines refused that name no radar, by reason.',
    (v, write) => reasons(v.refused, write),
  ],
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

/** @param {Record<string, number>} refused @param {Write} write */
const reasons = (refused, write) => {
  for (const reason in refused) write(refused[reason], label('reason', reason));
};

/** @param {number} value */
const written = (value) =>
  Number.isFinite(value) ? String(value) : Number.isNaN(value) ? 'NaN' : value > 0 ? '+Inf' : '-Inf';

/**
 * A scrape of thousands of radars blocks the service while it is written, so that samples are written without objects of
 * their own, and labels of a radar once.
 *
 * @param {Vehicles} vehicles
 * @param {Connections} [connections] where the runtime counts them
 */
export function openMetrics(vehicles, connections) {
  const ofVehicles = vehicles.map((vehicle) => ({ labels: label('vehicle', vehicle.vehicle), of: vehicle }));
  const ofRadars = ofVehicles.flatMap(({ labels, of: { radars } }) =>
    radars.map((radar) => ({ labels: `${labels},${label('radar', radar.radar)}`, of: radar })),
  );
  const ofService = connections ? [{ labels: '', of: connections }] : [];
  const lines = [
    ...OF_RADARS.map(([name, type, help, samples]) => family(name, type, help, ofRadars, samples)),
    ...OF_VEHICLES.map(([name, type, help, samples]) => family(name, type, help, ofVehicles, samples)),
    ...OF_CONNECTIONS.map(([name, type, help, value]) =>
      family(name, type, help, ofService, (counts, write) => write(value(counts))),
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
 * @param {(subject: T, write: Write) => void} samples
 */
function family(name, type, help, subjects, samples) {
  const unit = /_(degrees|seconds)$/.exec(name)?.[1];
  const metric = type === 'counter' ? `${name}_total` : name;
  const parts = [`# TYPE ${name} ${type}\n${unit ? `# UNIT ${name} ${unit}\n` : ''}# HELP ${name} ${help}\n`];
  let labels = '';
  /** @type {Write} */
  const write = (value, more) => {
    if (value === null || value === undefined) return;
    const all = labels && more ? `${labels},${more}` : labels || more;
    if (all) parts.push(metric, '{', all, '} ', written(value), '\n');
    else parts.push(metric, ' ', written(value), '\n');
  };
  for (const subject of subjects) {
    labels = subject.labels;
    samples(subject.of, write);
  }
  return parts.join('');
}
