/** What the drive says of the mounting angle, in a sentence: which method to go by, and why. */
import type { CalibrationResult } from 'boresight';
import { count, fixed, signed } from '../../../../plots/format.ts';
import { driveProblem, filesWanted, loaded, opening } from '../drive/drive.ts';
import { about, WAYS, type Way } from '../motion/ways.ts';
import { mountingState } from '../state.ts';
import { results, where, working } from './process.ts';

/** Methods differ where their angles lie farther apart than this many of their deviations. */
const APART = 3;

/** Whether a drive tells the angle at all. */
export const determined = ({ sigmaDeg }: CalibrationResult): boolean => Number.isFinite(sigmaDeg);

export interface Told {
  way: Way;
  result: CalibrationResult;
}

/** What is wrong where frames of files have no motion. */
const NO_MOTION =
  'the files have no motion at the time of the frames: add a table with time_s, yaw_rate_degps and speed_mps';

/** In words why no method has an angle. */
function whyNone(result: CalibrationResult, noMotion: string): string {
  const { frames } = result;
  const reasons: [keyof typeof frames, string][] = [
    ['withoutMotion', noMotion],
    ['standing', 'the car stood'],
    ['slow', 'the car was slower than the slowest speed under “Frames and noise”'],
    ['turning', 'the car turned faster than the limit under “Frames and noise”'],
    ['offSpeed', 'what the radar sees does not move at the speed that the log states'],
    ['sparse', 'frames have too few detections, or too few of them stand still'],
  ];
  const most = reasons.reduce((best, one) => (frames[one[0]] > frames[best[0]] ? one : best));
  return `in ${count(frames[most[0]])} of ${count(frames.given)} frames ${most[1]}`;
}

type Kind = 'none' | 'open' | 'good' | 'off' | 'awaited';

/** What there is to say in a line, why, and whether it is to be acted on. */
export interface Said {
  kind: Kind;
  head: string;
  why: string;
}

export function verdictOf(told: readonly Told[], nominal: number | null | undefined, noMotion = NO_MOTION): Said {
  const first = told[0] as Told;
  const best =
    told.find(({ result }) => determined(result) && result.converged) ?? told.find((one) => determined(one.result));
  if (!best) {
    return {
      kind: 'none',
      head: 'No angle: the drive does not tell it.',
      why: `${sentence(whyNone(first.result, noMotion))}.`,
    };
  }
  const { way, result } = best;
  const angle = `${signed(result.angleDeg, 2)}° ± ${fixed(result.sigmaDeg, 2)}°`;
  if (!result.converged) {
    return {
      kind: 'open',
      head: `Not settled yet: ${angle} so far.`,
      why: `By ${about(way).title}. A longer drive helps, above all one with curves and at more speed.`,
    };
  }
  const allowed = `${fixed(mountingState.value.alarm, 2)}°`;
  const words = (nominal: number) => ({
    misaligned: `: misaligned, ${fixed(Math.abs(result.angleDeg - nominal), 2)}° from its nominal ${signed(nominal, 2)}°, where ${allowed} are allowed.`,
    aligned: `: as it should be, within ${allowed} of its nominal ${signed(nominal, 2)}°.`,
    undecided: `: not decided whether within ${allowed} of its nominal ${signed(nominal, 2)}°, where chance is granted three deviations.`,
  });
  const turned = result.alignment === null || nominal == null ? '.' : words(nominal)[result.alignment];
  const why =
    way === 'recursive' || way === 'joint'
      ? 'it leaves out what moves, and estimates the yaw-rate sensor’s errors with the angle'
      : 'of those chosen it is the first that has settled';
  const others = told.filter(
    (one) =>
      one !== best &&
      determined(one.result) &&
      Math.abs(one.result.angleDeg - result.angleDeg) > APART * Math.hypot(one.result.sigmaDeg, result.sigmaDeg),
  );
  const apart = others.length
    ? ` ${others.map((one) => about(one.way).title).join(' and ')} ${others.length > 1 ? 'differ' : 'differs'} by more than the stated deviations allow.`
    : '';
  return {
    kind: result.alignment === 'misaligned' ? 'off' : result.alignment === 'undecided' ? 'open' : 'good',
    head: `Mounting angle ${angle}${turned}`,
    why: `By ${about(way).title}: ${why}.${apart}`,
  };
}

const sentence = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** Said in its place, so that nothing moves when it comes; nothing where something else is asked for first. */
function awaited(): Said | null {
  const what =
    opening.value?.what ??
    (working.value
      ? 'The methods are at work'
      : loaded.value || driveProblem.value || filesWanted.value
        ? ''
        : 'Opening');
  if (!what) return null;
  const why = 'Here it is said how sure the angle is, which method to go by, and whether the radar was knocked.';
  return { kind: 'awaited', head: `${what} …`, why };
}

export function Verdict() {
  const told = WAYS.flatMap((way): Told[] => {
    const result = results.value.get(way)?.calibration?.result;
    return result ? [{ way, result }] : [];
  });
  return <VerdictPanel said={told.length ? verdictOf(told, where.value?.nominalDeg) : awaited()} />;
}

export function VerdictPanel({ said }: { said: Said | null }) {
  if (!said) return null;
  return (
    <section class={`panel verdict ${said.kind}`} aria-label="Verdict" data-verdict={said.kind}>
      <p class="head" role="status">
        {said.head}
      </p>
      <p class="small">{said.why}</p>
    </section>
  );
}
