/** Conversions of messages, which make the applications' own panels show them. */
import type { ExtensionContext, Immutable, MessageEvent, VariableValue } from '@foxglove/extension';
import type { Time } from '@foxglove/schemas';
import { MessageProblem } from '../../messages/problem.ts';
import { type Scan, scanOf } from '../../messages/scan.ts';
import { formsOf } from '../../messages/schemas.ts';
import { isFields, secondsOf } from '../../messages/values.ts';
import { signs } from '../signs.ts';
import { mountingLog } from './mounting.ts';
import { pointCloud, rangeRates } from './points.ts';
import { tracksCloud, tracksScene } from './tracks.ts';

type Variables = Readonly<Record<string, VariableValue>>;
type Make = (message: unknown, timestamp: Time, variables: Variables | undefined) => unknown;

const ofScan =
  (make: (scan: Scan, timestamp: Time) => unknown): Make =>
  (message, timestamp, variables) =>
    make(scanOf('radar_msgs/RadarScan', message, signs(variables)), timestamp);

const CONVERSIONS: readonly [from: string, to: string, make: Make][] = [
  ['radar_msgs/RadarScan', 'foxglove.PointCloud', ofScan(pointCloud)],
  ['radar_msgs/RadarScan', 'foxglove.SceneUpdate', ofScan(rangeRates)],
  ['radar_msgs/RadarTracks', 'foxglove.PointCloud', tracksCloud],
  ['radar_msgs/RadarTracks', 'foxglove.SceneUpdate', tracksScene],
  ['boresight.MountingAngle', 'foxglove.Log', mountingLog],
];

/**
 * Registers all of them in the form that both applications take, which has no `type`. A message that is no such one gives
 * nothing, and the console says why.
 */
export function registerConverters(context: ExtensionContext): void {
  for (const [from, toSchemaName, make] of CONVERSIONS) {
    for (const fromSchemaName of formsOf(from)) {
      const converter = (message: unknown, event: Immutable<MessageEvent>, variables?: Variables): unknown => {
        try {
          return make(message, stamp(message, event), variables);
        } catch (error) {
          if (!(error instanceof MessageProblem)) throw error;
          console.warn(`Boresight: a message of ${fromSchemaName} was left out: ${error.message}`);
          return undefined;
        }
      };
      context.registerMessageConverter({ fromSchemaName, toSchemaName, converter });
    }
  }
}

/** The time of a message: its own, as it stands there, or when it was received. */
function stamp(message: unknown, event: Immutable<MessageEvent> | undefined): Time {
  const { header, timestamp } = isFields(message) ? (message as { header?: unknown; timestamp?: unknown }) : {};
  const own = isFields(header) ? header.stamp : timestamp;
  if (!Number.isFinite(secondsOf(own))) return event?.receiveTime ?? { sec: 0, nsec: 0 };
  const { sec, nsec, nanosec } = own as { sec: number; nsec?: number; nanosec?: number };
  return { sec, nsec: nsec ?? nanosec ?? 0 };
}
