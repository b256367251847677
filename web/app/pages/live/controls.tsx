/** Ports, configuration and recordings of the live page. */

import cfgLicence from '../../../../recordings/awr1642/LICENSE?url';
import { api } from '../../data.ts';
import { showHelp } from '../../state/settings.ts';
import { controlOf } from '../../ui/control.tsx';
import { ControlsHead } from '../../ui/controls-head.tsx';
import { useFileDrop } from '../../ui/drop.ts';
import { Group } from '../../ui/field.tsx';
import { FileButton } from '../../ui/file-button.tsx';
import { Licence } from '../../ui/licence.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { openFiles, replayBundled } from './files.ts';
import { choosePort, ports, type Role, sending, sendProfile, serial } from './ports.ts';
import { loadBundledProfile, parsed, profile } from './profile.ts';
import { changePort, connect, connectBridge, live, saveProfile, stop } from './session.ts';
import { bridgeAddress, liveCodec, liveState, QUICK, update } from './state.ts';

const Control = controlOf(liveCodec, liveState, update);

const PACES = {
  recorded: 'as recorded',
  port: 'as fast as the port',
  ten: 'ten times that',
  fast: 'as fast as can be',
};

export function Controls() {
  const { source } = liveState.value;
  const raw = source === 'raw';
  return (
    <Sidebar label="Live settings" button="board and settings">
      <ControlsHead
        code={async () => (await import('./code.ts')).liveCode}
        but="; ports and configuration stay"
        onDefaults={() => {
          liveState.value = { ...liveCodec.defaults, source };
        }}
      />
      <Group title="What is live">
        <Control
          label="Source"
          name="source"
          labels={{ board: 'detections', raw: 'raw samples' }}
          help="Detections come over a board’s serial ports; raw samples from a DCA1000 capture card over `boresight bridge`."
        />
      </Group>
      {raw ? <Bridge /> : <Board />}
      <Group title="Display">
        <Control
          label="Range"
          name="range"
          unit="m"
          help="How far the point cloud shows; 0 for as far as there are points."
        />
        <Control label="Colour span" name="span" labels={(span) => `${span} dB`} help="From the strongest cell down." />
        <Control label="Colour map" name="colors" help="All three are perceptually uniform." />
      </Group>
    </Sidebar>
  );
}

function Board() {
  const there = serial() !== undefined;
  return (
    <>
      <Group title="Ports">
        {there ? (
          <Ports />
        ) : (
          <p class="notice" role="status" data-notice="no-serial">
            {isSecureContext
              ? 'This browser has no serial ports for pages. Chrome, Edge and Opera on a computer have them.'
              : 'Serial ports are for pages of https and of this machine; this page is neither.'}{' '}
            Recordings are replayed here all the same.
          </p>
        )}
      </Group>
      <Group title="Configuration">
        <Configuration />
      </Group>
      <Group title="Recording">
        <Recording />
      </Group>
      <Group title="Kept" open={false}>
        <Control
          label="Keep"
          name="keep"
          labels={{ minute: 'the last minute', all: 'all there is room for' }}
          help="Bytes of the data port that can be saved as a .dat: the last minute, or all up to 256 MiB, of what begins next."
        />
      </Group>
    </>
  );
}

function Ports() {
  const { command, data } = ports.value;
  const now = live.value;
  const reading = now?.kind === 'board' && now.state !== 'ended';
  const busy = sending.value !== null && !sending.value.done;
  const choose = async (role: Role): Promise<void> => {
    const chosen = await choosePort(role);
    if (chosen && role === 'data' && reading) changePort();
  };
  return (
    <>
      {(['command', 'data'] as const).map((role) => (
        <div key={role} class="row" data-port={role}>
          <button
            type="button"
            data-action={`choose-${role}`}
            title={
              role === 'command'
                ? 'The port that takes the configuration: of TI’s boards the Application or User UART'
                : 'The port that frames come over: of TI’s boards the Auxiliary or Data port'
            }
            onClick={() => void choose(role)}
          >
            {role === 'command' ? 'Command port' : 'Data port'}
          </button>
          <span class={ports.value[role] ? '' : 'muted'}>{ports.value[role]?.name ?? 'not chosen'}</span>
        </div>
      ))}
      <div class="row">
        {reading ? (
          <button type="button" data-action="disconnect" onClick={stop}>
            Disconnect
          </button>
        ) : (
          <button
            type="button"
            class="primary"
            data-action="connect"
            disabled={!data}
            title={data ? 'Reads the data port' : 'Choose the data port first'}
            onClick={connect}
          >
            Connect
          </button>
        )}
        <button
          type="button"
          data-action="send"
          disabled={!command || !profile.value?.text.trim() || busy}
          title={command ? 'Sends the configuration line by line' : 'Choose the command port first'}
          onClick={() => void sendProfile()}
        >
          Send configuration
        </button>
      </div>
      <Control label="Data port" name="dataBaud" unit="bit/s" help="921600 with TI’s demos." />
      <Control label="Command port" name="commandBaud" unit="bit/s" help="115200 with TI’s demos." />
    </>
  );
}

function Configuration() {
  const said = parsed.value;
  const problem = said && 'problem' in said ? said.problem : null;
  return (
    <>
      <label class="visually-hidden" for="live-cfg">
        Configuration, a command a line
      </label>
      <textarea
        id="live-cfg"
        name="cfg"
        rows={9}
        spellcheck={false}
        placeholder="The .cfg that the board is to run, or runs"
        value={profile.value?.text ?? ''}
        aria-invalid={problem ? 'true' : undefined}
        aria-describedby="live-cfg-problem"
        onInput={(event) => {
          profile.value = { name: profile.peek()?.name ?? 'own.cfg', text: event.currentTarget.value };
        }}
      />
      <p id="live-cfg-problem" class="problem" role="alert" hidden={!problem}>
        {problem?.message}
      </p>
      <div class="row">
        <FileButton
          label="Configuration file"
          accept=".cfg"
          onFiles={(files) => void openFiles(files.map(({ file }) => file))}
        >
          Open .cfg
        </FileButton>
        <button type="button" data-action="bundled-cfg" onClick={() => void loadBundledProfile()}>
          Example
        </button>
        <button type="button" data-action="save-cfg" disabled={!profile.value?.text} onClick={saveProfile}>
          Save .cfg
        </button>
      </div>
      <p class={showHelp.value ? 'help' : 'muted small'}>
        It tells the widths of bins; without it detections have no range rates. It counts from the next start on.
      </p>
    </>
  );
}

function Recording() {
  const over = useFileDrop('live', (files) => void openFiles(files.map(({ file }) => file)));
  return (
    <div class={`drop${over.value ? ' over' : ''}`}>
      <div class="row">
        <FileButton
          label="Recording"
          accept=".dat,.cfg"
          multiple
          action="open-dat"
          onFiles={(files) => void openFiles(files.map(({ file }) => file))}
        >
          Replay a .dat
        </FileButton>
        <button type="button" data-action="replay" onClick={() => void replayBundled()}>
          Bundled recording
        </button>
      </div>
      <Control
        label="Pace"
        name="pace"
        labels={PACES}
        help="How fast bytes of a recording come. As recorded needs the configuration, which tells the time from frame to frame."
      />
      <p class={showHelp.value ? 'help' : 'muted small'}>Or drop a .dat, with its .cfg, anywhere on the page.</p>
      <Licence
        address={cfgLicence}
        summary="Recorded at the University of Colorado Boulder, Apache-2.0"
        remark="From cstahoviak/radar-velocity-estimation."
      />
    </div>
  );
}

function Bridge() {
  const now = live.value;
  const reading = now?.kind === 'bridge' && now.state !== 'ended';
  const methods = api.methods();
  return (
    <>
      <Group title="Bridge">
        <p class="small">
          Run <code>boresight bridge --config profile.cfg</code> on this machine, which hears the capture card; with{' '}
          <code>--replay capture.bin</code> a recording stands in for it.
        </p>
        <Control
          label="Port"
          name="bridge"
          help="That of the bridge on this machine. The page may connect to no other machine."
        />
        <div class="row">
          {reading ? (
            <button type="button" data-action="disconnect" onClick={stop}>
              Disconnect
            </button>
          ) : (
            <button type="button" class="primary" data-action="connect-bridge" onClick={connectBridge}>
              Connect
            </button>
          )}
          <span class="muted">{bridgeAddress(liveState.value)}</span>
        </div>
      </Group>
      <Group title="Detection">
        <Control label="False-alarm rate" name="falseAlarm" />
        <Control label="Remove static clutter" name="clutter" />
        <Control
          label="Angle by"
          name="angle"
          only={QUICK}
          labels={(name) => methods.find((info) => info.name === name)?.title ?? name}
          help="Method for the angle of each detection."
        />
      </Group>
    </>
  );
}
