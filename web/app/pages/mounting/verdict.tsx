/** What the drive says of the mounting angle, in a sentence: which method to go by, and why. */
import type { CalibrationResult } from 'boresight';
import { count, fixed, signed } from '../../plots/format.ts';
import { results, where } from './process.ts';
import { mountingState } from './state.ts';
import { about, WAYS, type Way } from './ways.ts';

/** Methods differ where their angles lie farther apart than this many of their deviations. */
const APART = 3;

/** Whether a drive tells the angle at all. */
export const determined = ({ sigmaDeg }: CalibrationResult): boolean => Number.isFinite(sigmaDeg);

interface Told {
  way: Way;
  result: CalibrationResult;
}

/** In words why no method has an angle. */
function whyNone(result: CalibrationResult): string {
  const { frames } = result;
  const reasons: [keyof typeof frames, string][] = [
    [
      'withoutMotion',
      'the files have no motion at the time of the frames: add a table with time_s, yaw_rate_degps and speed_mps',
    ],
    ['standing', 'the car stood'],
    ['slow', 'the car was slower than the slowest speed under “Frames and noise”'],
    ['turning', 'the car turned faster than the limit under “Frames and noise”'],
    ['offSpeed', 'what the radar sees does not move at the speed that the log states'],
    ['sparse', 'frames have too few detections, or too few of them stand still'],
  ];
  const most = reasons.reduce((best, one) => (frames[one[0]] > frames[best[0]] ? one : best));
  return `in ${count(frames[most[0]])} of ${count(frames.given)} frames ${most[1]}`;
}

/** The verdict, and whether it is one to act on. */
function verdictOf(told: readonly Told[]): { kind: 'none' | 'open' | 'good' | 'off'; text: string } {
  const [first] = told;
  if (!first) return { kind: 'open', text: '' };
  const best =
    told.find(({ result }) => determined(result) && result.converged) ?? told.find((one) => determined(one.result));
  if (!best) return { kind: 'none', text: `The drive does not tell the angle: ${whyNone(first.result)}.` };
  const { way, result } = best;
  const angle = `${signed(result.angleDeg, 2)}° ± ${fixed(result.sigmaDeg, 2)}°`;
  if (!result.converged) {
    return {
      kind: 'open',
      text: `Not settled yet: ${about(way).title} is at ${angle}. A longer drive helps, above all one with curves and at more speed.`,
    };
  }
  const nominal = where.value?.nominalDeg;
  const allowed = `${fixed(mountingState.value.alarm, 2)}°`;
  const words = (nominal: number) => ({
    misaligned: ` The radar is misaligned: ${fixed(Math.abs(result.angleDeg - nominal), 2)}° from its nominal ${signed(nominal, 2)}°, where ${allowed} are allowed.`,
    aligned: ` It is where it should be, within ${allowed} of its nominal ${signed(nominal, 2)}°.`,
    undecided: ` Whether it is within ${allowed} of its nominal ${signed(nominal, 2)}° is not decided: chance is granted three deviations.`,
  });
  const turned = result.alignment === null || nominal == null ? '' : words(nominal)[result.alignment];
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
    text: `${angle} by ${about(way).title}: ${why}.${turned}${apart}`,
  };
}

export function Verdict() {
  const told = WAYS.flatMap((way): Told[] => {
    const one = results.value.get(way);
    const result = one?.stale ? undefined : one?.calibration?.result;
    return result ? [{ way, result }] : [];
  });
  const { kind, text } = verdictOf(told);
  if (!text) return null;
  return (
    <p class={`verdict ${kind}`} role="status" data-verdict={kind}>
      <strong>{kind === 'none' ? 'No angle.' : kind === 'open' ? 'Open.' : 'Mounting angle:'}</strong> {text}
    </p>
  );
}
