/** What a calibration says, boresight.MountingAngle, as a line of a log. */
import type { Log, Time } from '@foxglove/schemas';
import { MessageProblem } from '../../messages/problem.ts';
import { type Fields, isFields, numberOf } from '../../messages/values.ts';
import { fixed, signed } from '../../plots/format.ts';

const INFO = 2;
const WARNING = 3;

const WORDS: Readonly<Record<string, string>> = {
  aligned: 'as it should be',
  misaligned: 'misaligned',
  undecided: 'not decided whether as it should be',
};

/** The angle in words; a warning where the radar is misaligned. */
export function mountingLog(message: unknown, timestamp: Time): Log {
  if (!isFields(message)) throw new MessageProblem('malformed', 'no mounting angle');
  const sensor = numberOf(message, 'sensor');
  return {
    timestamp,
    level: message.alignment === 'misaligned' ? WARNING : INFO,
    message: [`Radar ${Number.isFinite(sensor) ? sensor : '?'}`, angleOf(message), ...alignmentOf(message)].join(', '),
    name: 'boresight',
    file: '',
    line: 0,
  };
}

function angleOf(message: Fields): string {
  const [angle, sigma] = [numberOf(message, 'angleDeg'), numberOf(message, 'sigmaDeg')];
  if (!Number.isFinite(sigma)) return 'no angle yet';
  const settled = message.converged === true ? '' : ', not settled';
  return `mounting angle ${signed(angle, 2)}° ± ${fixed(sigma, 2)}°${settled}`;
}

function alignmentOf(message: Fields): string[] {
  const words = typeof message.alignment === 'string' ? WORDS[message.alignment] : undefined;
  const nominal = numberOf(message, 'nominalDeg');
  return words ? [Number.isFinite(nominal) ? `${words} (nominal ${signed(nominal, 2)}°)` : words] : [];
}
