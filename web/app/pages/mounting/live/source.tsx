/** The server, and which of its topics are followed. */
import { signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { SelectField, TextField } from '../../../ui/field.tsx';
import { Control } from '../control.ts';
import { mountingState, update } from '../state.ts';
import { addressProblem } from './address.ts';
import type { Channel } from './connection.ts';
import { connect, connection, disconnect, motionChannels, scanChannels } from './live.ts';

export function Source() {
  const { server, scanTopic, motionTopic } = mountingState.value;
  const { kind } = connection.value;
  const idle = kind === 'idle';
  return (
    <>
      <TextField
        label="Server"
        name="server"
        value={server}
        help="A server of the Foxglove WebSocket protocol on this machine, such as “boresight serve DRIVE” or foxglove_bridge. The page can reach no other machine."
        check={addressProblem}
        onChange={(address) => {
          if (!idle) disconnect();
          update({ server: address });
        }}
      />
      <div class="row">
        {idle ? (
          <button type="button" class="primary" data-action="connect" onClick={() => void connect()}>
            Connect
          </button>
        ) : (
          <button type="button" data-action="disconnect" onClick={disconnect}>
            {kind === 'connected' ? 'Disconnect' : 'Cancel'}
          </button>
        )}
        <State />
      </div>
      <Topic label="Scans" name="scanTopic" value={scanTopic} among={scanChannels.value} />
      <Topic label="Motion" name="motionTopic" value={motionTopic} among={motionChannels.value} />
      <Control
        label="Azimuth positive"
        name="azimuthSign"
        labels={{ left: 'to the left', right: 'to the right' }}
        help="Drivers disagree. With the wrong one the angle does not settle, or settles at a wrong value."
      />
      <Control
        label="Range rate positive"
        name="rangeRateSign"
        labels={{ receding: 'receding', closing: 'closing' }}
        help="Drivers disagree here as well."
      />
    </>
  );
}

function Topic({
  label,
  name,
  value,
  among,
}: {
  label: string;
  name: 'scanTopic' | 'motionTopic';
  value: string;
  among: readonly Channel[];
}) {
  const topics = among.map(({ topic }) => topic);
  const all = value === '' || topics.includes(value) ? topics : [...topics, value];
  return (
    <SelectField
      label={label}
      name={name}
      value={value}
      options={[['', topics[0] ? `first: ${topics[0]}` : 'first that comes'], ...all.map((one) => [one, one] as const)]}
      wide
      help={
        name === 'scanTopic'
          ? 'Detections of one radar: foxglove.PointCloud or sensor_msgs/PointCloud2 with range rates, or radar_msgs/RadarScan.'
          : 'Yaw rate and speed of the car: boresight.CarMotion, nav_msgs/Odometry, geometry_msgs/TwistStamped and others.'
      }
      onChange={(topic) => update({ [name]: topic })}
    />
  );
}

const now = signal(0);

/** The state of the connection in words. */
function State() {
  const state = connection.value;
  const waiting = state.kind === 'waiting';
  useEffect(() => {
    if (!waiting) return;
    const tick = (): void => {
      now.value = Date.now();
    };
    tick();
    const timer = setInterval(tick, 500);
    return () => clearInterval(timer);
  }, [waiting]);
  return (
    <span class="muted small" data-connection={state.kind}>
      {state.kind === 'connecting' && 'Connecting …'}
      {state.kind === 'connected' && `Connected${state.server ? ` to ${state.server}` : ''}`}
      {state.kind === 'waiting' && `Tries again in ${Math.max(Math.ceil((state.untilMs - now.value) / 1000), 0)} s`}
    </span>
  );
}
