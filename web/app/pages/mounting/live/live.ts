/** A calibration from a live server: connected when it is asked for, until another drive is chosen. It goes on while other pages are shown. */
import { batch, computed, effect, signal } from '@preact/signals';
import type { CalibrationOutlook, CalibrationResult } from 'boresight';
import { defineElement } from '../../../../elements/base/define.ts';
import { MountingAngleElement } from '../../../../elements/kinds/mounting-angle.ts';
import { type FollowCounts, type Followed, Follower } from '../../../../messages/follow.ts';
import { hasMotion, MOTION_SCHEMAS, type MotionSample, motionOf } from '../../../../messages/motion.ts';
import { hasPlaces, Places } from '../../../../messages/places.ts';
import { isRos2, ros2Message } from '../../../../messages/ros2.ts';
import { hasScans, SCAN_SCHEMAS, scanOf } from '../../../../messages/scan.ts';
import { schemaOf } from '../../../../messages/schemas.ts';
import { isFields, numberOf } from '../../../../messages/values.ts';
import { api, describeError, type Problem } from '../../../data.ts';
import { announce } from '../../../state/announce.ts';
import { calibrationOptions, mountingState, type Place } from '../state.ts';
import { addressProblem } from './address.ts';
import { type Channel, Connection, type ConnectionState } from './connection.ts';

defineElement('boresight-mounting-angle', MountingAngleElement);

/** What is shown is brought up to date so often. */
const TURN_MS = 250;
/** Rates are those of so many turns. */
const RATE_TURNS = 16;

export const connection = signal<ConnectionState>({ kind: 'idle' });
export const channels = signal<readonly Channel[]>([]);
/** What keeps the calibration from being begun. */
export const liveProblem = signal<Problem | null>(null);

/** What came and what became of it, as far as it was counted at the last turn. */
export interface LiveView {
  counts: FollowCounts;
  /** Messages that are none of their kind, or of the protocol. */
  malformed: number;
  /** What the last of them lacked. */
  why: string;
  connections: number;
  scansPerS: number;
  /** Since the last scan came, s; null before the first. */
  silentS: number | null;
  motion: MotionSample | null;
  latest: Followed | null;
  result: CalibrationResult | null;
  outlook: CalibrationOutlook | null;
}

export const view = signal<LiveView | null>(null);

/** The angle over time, which is kept here while other pages are shown. */
export const angle: MountingAngleElement = document.createElement('boresight-mounting-angle');

/** Where the server says that frames are, and how often it said so anew. */
const places = new Places();
const placesTold = signal(0);
/** The frame that the last scan was in. */
const scanFrame = signal('');
const toldNominalDeg = signal<number | null>(null);

/** Where the server says that the radar is. */
const told = computed((): Place => {
  void placesTold.value;
  const { xM = null, yM = 0 } = places.at(scanFrame.value) ?? {};
  return { xM, yM, nominalDeg: toldNominalDeg.value };
});

/** Where the radar is taken to be. */
export const livePlace = computed((): Place => {
  const { xM, yM, nominal } = mountingState.value;
  return { xM: xM ?? told.value.xM, yM: yM ?? told.value.yM, nominalDeg: nominal ?? told.value.nominalDeg };
});

const readable = ({ encoding, schemaName }: Channel): boolean =>
  encoding === 'json' || (encoding === 'cdr' && isRos2(schemaName));

const byKind = (has: (schemaName: string) => boolean, schemas: readonly string[]) =>
  computed(() => {
    const place = ({ schemaName }: Channel): number => schemas.indexOf(schemaOf(schemaName));
    return channels.value
      .filter((channel) => has(channel.schemaName) && readable(channel))
      .sort((a, b) => place(a) - place(b));
  });

export const scanChannels = byKind(hasScans, SCAN_SCHEMAS);
export const motionChannels = byKind(hasMotion, MOTION_SCHEMAS);

const chosenOf = (of: readonly Channel[], topic: string): Channel | undefined =>
  topic === '' ? of[0] : of.find((channel) => channel.topic === topic);
export const scanChannel = computed(() => chosenOf(scanChannels.value, mountingState.value.scanTopic));
export const motionChannel = computed(() => chosenOf(motionChannels.value, mountingState.value.motionTopic));

/** What the calibration depends on, as text, so that it begins anew when that changes and not before. */
const asked = computed(() => {
  // Frames are taken as they come, by the motion that belongs to the method.
  const { motion: _, ...options } = calibrationOptions(mountingState.value, livePlace.value, '') ?? {};
  const { azimuthSign, rangeRateSign } = mountingState.value;
  const topics = [scanChannel.value?.topic, motionChannel.value?.topic];
  // Channels go where a server does, and come back with it.
  return 'xM' in options && topics.every(Boolean)
    ? JSON.stringify({ options, azimuthSign, rangeRateSign, topics })
    : null;
});

let open: Connection | null = null;
let follower: Follower | null = null;
let followed = '';
let stops: (() => void)[] = [];
let frames: Promise<void> | null = null;

interface Tally {
  malformed: number;
  why: string;
  connections: number;
  /** Scans that came, and when the last did. */
  arrived: number;
  lastMs: number | null;
  /** How many had come at the turns of late. */
  turns: { atMs: number; arrived: number }[];
  motion: MotionSample | null;
  latest: Followed | null;
  result: CalibrationResult | null;
}
const fresh = (): Tally => ({
  malformed: 0,
  why: '',
  connections: 0,
  arrived: 0,
  lastMs: null,
  turns: [],
  motion: null,
  latest: null,
  result: null,
});
let tally = fresh();

/** Connects to the server of the state, and begins anew. */
export async function connect(): Promise<void> {
  disconnect();
  const address = mountingState.peek().server;
  if (addressProblem(address)) return;
  batch(() => {
    liveProblem.value = null;
    places.clear();
    placesTold.value += 1;
    [scanFrame.value, toldNominalDeg.value] = ['', null];
    connection.value = { kind: 'connecting' };
  });
  const mine = new Connection(address, {
    state: (state) => {
      if (state.kind === 'connected') tally.connections += 1;
      if (state.kind !== connection.peek().kind) say(state);
      connection.value = state;
    },
    channels: (all) => {
      channels.value = all;
    },
    message: take,
    malformed: note,
  });
  open = mine;
  frames ??= api.initDrives();
  try {
    await frames;
  } catch (error) {
    frames = null;
    if (open === mine) {
      disconnect();
      liveProblem.value = describeError(error);
    }
    return;
  }
  // It may have been ended or begun anew meanwhile.
  if (open !== mine) return;
  tally = fresh();
  const turns = setInterval(turn, TURN_MS);
  stops = [
    () => clearInterval(turns),
    effect(() => {
      const [scans, motion, place] = [scanChannel.value, motionChannel.value, placesWanted.value];
      mine.want((channel) => channel === scans || channel === motion || (place && tellsPlace(channel)));
    }),
    effect(() => begin(asked.value)),
  ];
  mine.open();
}

/** Ends the connection; what was found stays. */
export function disconnect(): void {
  for (const stop of stops) stop();
  stops = [];
  const had = open;
  open = null;
  had?.close();
  if (had) turn();
  connection.value = { kind: 'idle' };
}

/** Forgets what was found: a new drive, or a radar that was moved. */
export function beginAnew(): void {
  follower?.restart();
  turn();
}

/** Another drive than a live one ends it, and frees what it holds. */
export function leave(): void {
  disconnect();
  follower?.free();
  follower = null;
  followed = '';
  angle.history = null;
  tally = fresh();
  view.value = null;
}

effect(() => {
  if (mountingState.value.source !== 'live') leave();
});

function say(state: ConnectionState): void {
  if (state.kind === 'connected') announce(`Connected to ${state.server || 'the server'}.`);
  if (state.kind === 'waiting') announce('The server does not answer.');
}

function begin(text: string | null): void {
  if (text === null || text === followed) return;
  followed = text;
  follower?.free();
  follower = null;
  angle.history = null;
  [tally.latest, tally.result] = [null, null];
  try {
    follower = new Follower(JSON.parse(text).options, {
      scan: (one) => {
        tally.latest = one;
      },
      angle: (timeS, result) => {
        tally.result = result;
        if (Number.isFinite(result.sigmaDeg)) angle.add(timeS, result);
      },
      restarted: () => {
        angle.history = null;
        [tally.latest, tally.result] = [null, null];
      },
    });
    liveProblem.value = null;
  } catch (error) {
    liveProblem.value = describeError(error);
  }
}

function note(why: string): void {
  tally.malformed += 1;
  tally.why = why;
}

const decoder = new TextDecoder('utf-8', { fatal: true });

function take(channel: Channel, data: ArrayBufferView, timeS: number): void {
  try {
    const { schemaName } = channel;
    const message: unknown =
      channel.encoding === 'json' ? JSON.parse(decoder.decode(data)) : ros2Message(schemaName, data);
    if (channel === scanChannel.peek()) takeScan(schemaName, message, timeS);
    else if (channel === motionChannel.peek()) {
      const motion = timed(motionOf(schemaName, message), timeS);
      tally.motion = motion;
      follower?.addMotion(motion);
    } else takePlace(schemaName, message);
  } catch (error) {
    // Whatever a server sends is no fault of the page.
    note(`${channel.topic}: ${error instanceof Error ? error.message : String(error)}`);
  }
}

const timed = <T extends { timeS: number }>(one: T, timeS: number): T =>
  Number.isFinite(one.timeS) ? one : { ...one, timeS };

function takeScan(schemaName: string, message: unknown, timeS: number): void {
  const { azimuthSign, rangeRateSign } = mountingState.peek();
  const signs = { azimuth: azimuthSign === 'right' ? -1 : 1, rangeRate: rangeRateSign === 'closing' ? -1 : 1 } as const;
  const scan = timed(scanOf(schemaName, message, signs), timeS);
  scanFrame.value = scan.frameId;
  tally.arrived += 1;
  tally.lastMs = performance.now();
  follower?.addScan(scan);
}

/** Transforms and angles may tell where the radar is, as long as the user does not. */
const tellsPlace = ({ schemaName, topic, encoding }: Channel): boolean =>
  (encoding === 'json' || isRos2(schemaName)) &&
  (hasPlaces(schemaName) || (schemaName === 'boresight.MountingAngle' && sameRadar(topic)));
const placesWanted = computed(() => {
  const { xM, nominal } = mountingState.value;
  return xM === null || nominal === null;
});

/** Topics of one radar differ in their last part alone. */
const sameRadar = (topic: string): boolean => folder(topic) === folder(scanChannel.value?.topic ?? '');
const folder = (topic: string): string => topic.slice(0, topic.lastIndexOf('/'));

function takePlace(schemaName: string, message: unknown): void {
  if (schemaName === 'boresight.MountingAngle') {
    const nominalDeg = isFields(message) ? numberOf(message, 'nominalDeg') : Number.NaN;
    if (Number.isFinite(nominalDeg)) toldNominalDeg.value = nominalDeg;
    return;
  }
  if (places.take(schemaName, message)) placesTold.value += 1;
}

const NO_COUNTS: FollowCounts = { scans: 0, motion: 0, late: 0, refused: 0, incomplete: 0, restarts: 0 };

/** Shows what came since. */
function turn(): void {
  const { malformed, connections, arrived, lastMs, motion, latest, result } = tally;
  const nowMs = performance.now();
  tally.turns = [...tally.turns, { atMs: nowMs, arrived }].slice(-RATE_TURNS);
  const from = tally.turns[0] as { atMs: number; arrived: number };
  view.value = {
    counts: { ...(follower?.counts ?? NO_COUNTS) },
    malformed,
    why: tally.why || (follower?.problem ?? ''),
    connections,
    scansPerS: nowMs > from.atMs ? (1000 * (arrived - from.arrived)) / (nowMs - from.atMs) : 0,
    silentS: lastMs === null ? null : (nowMs - lastMs) / 1000,
    motion,
    latest,
    result,
    outlook: result && !result.converged ? (follower?.outlook() ?? null) : null,
  };
}
