/** How what is live goes, and what was lost. */
import type { BoardFrame } from 'boresight';
import { byteSize, count, fixed, milliseconds } from '../../../plots/format.ts';
import { counts, frame, type Live, paused, saveData, stop, togglePause } from './session.ts';

const STATES = { opening: 'Opening', open: 'Live', lost: 'Unplugged', ended: 'Ended' } as const;
const KINDS = { board: 'Board', replay: 'Recording', bridge: 'Bridge' } as const;

export function LiveBar({ now }: { now: Live }) {
  const runs = now.state !== 'ended';
  return (
    <section class="panel frame-bar" aria-label="Live" data-live-state={now.state} data-live-kind={now.kind}>
      <button
        type="button"
        data-action="pause"
        aria-pressed={paused.value}
        disabled={!runs}
        title="Keeps the picture; frames are counted and kept on"
        onClick={togglePause}
      >
        {paused.value ? 'Go on' : 'Pause'}
      </button>
      {runs && now.kind !== 'board' && (
        <button type="button" data-action="stop" onClick={stop}>
          Stop
        </button>
      )}
      {now.kind !== 'bridge' && (
        <button
          type="button"
          data-action="save-dat"
          disabled={!counts.value?.recent?.bytes}
          title="The bytes of the data port that are kept, as a .dat"
          onClick={saveData}
        >
          Save .dat
        </button>
      )}
      <span>
        <strong>{now.kind === 'replay' && now.state === 'open' ? 'Replay' : STATES[now.state]}</strong>{' '}
        <span class="muted">
          {KINDS[now.kind]}: {now.name}
        </span>
      </span>
      {now.share !== null && runs && <progress max={1} value={now.share} aria-label="Of the recording" />}
    </section>
  );
}

type Fact = readonly [term: string, value: number | string, help: string, name: string];

export function Counters() {
  const all = counts.value;
  if (!all) return null;
  const { board, line, recent, bridge } = all;
  const facts: Fact[] = [
    ...(board
      ? ([
          ['Frames', board.frames, 'Packets that could be read, the last one of a recording in part', 'frames'],
          ['Damaged packets', board.damagedPackets, 'Cut, or not readable', 'damagedPackets'],
          ['Frames missed', board.missedFrames, 'Numbers that were passed over between frames', 'missedFrames'],
          ['Restarts', board.restarts, 'How often the numbers of frames began anew', 'restarts'],
          ['Bytes', board.bytes, 'That came over the data port', 'bytes'],
          ['Bytes dropped', board.skippedBytes, 'That belong to no packet that could be read', 'skippedBytes'],
        ] as const)
      : []),
    ...(line
      ? ([
          ['Framing errors', line.framingErrors, 'Bytes without a stop bit: noise, or another speed', 'framingErrors'],
          ['Overruns', line.overruns, 'Bytes came faster than they were taken, and some are lost', 'overruns'],
          ['Breaks', line.breaks, 'The line was held low', 'breaks'],
          ['Parity errors', line.parityErrors, 'Bytes with the wrong parity', 'parityErrors'],
          ['Other errors', line.otherErrors, 'Of the serial port', 'otherErrors'],
          ['Unplugged', line.losses, 'How often', 'losses'],
        ] as const)
      : []),
    ...(recent
      ? ([
          ['Kept', byteSize(recent.bytes), `Of the last ${fixed(recent.seconds, 0)} s, to be saved`, 'kept'],
          ['Not kept', byteSize(recent.forgottenBytes), 'Older, or more than is kept', 'forgotten'],
        ] as const)
      : []),
    ...(bridge
      ? ([
          ['Frames processed', all.processed, 'In this tab', 'processed'],
          ['Frames passed over', all.skipped, 'Came while others were processed', 'skipped'],
          ['Frames of the card', bridge.frames, 'That reached the bridge whole', 'cardFrames'],
          ['Frames dropped', bridge.damagedFrames, 'That lack packets', 'damagedFrames'],
          ['Packets lost', bridge.lostPackets, 'Between card and bridge', 'lostPackets'],
          ['Bytes lost', bridge.lostBytes, 'Of samples, in those packets', 'lostBytes'],
          ['Out of order', bridge.reordered, 'Packets that came after a later one', 'reordered'],
          ['Twice', bridge.duplicates, 'Packets that came again', 'duplicates'],
          ['Malformed', bridge.malformed, 'Packets that no card sends', 'malformed'],
        ] as const)
      : []),
  ];
  return (
    <section class="panel" aria-labelledby="live-counts">
      <div class="panel-head">
        <h3 id="live-counts">What came, and what was lost</h3>
      </div>
      <dl class="facts flat" data-facts="live">
        {facts.map(([term, value, help, name]) => (
          <div key={name} title={help} data-fact={name} data-value={value}>
            <dt>{term}</dt>
            <dd>{typeof value === 'number' ? count(value) : value}</dd>
          </div>
        ))}
      </dl>
      {frame.value?.stats && <Timing stats={frame.value.stats} />}
    </section>
  );
}

/** How long the board took. */
function Timing({ stats }: { stats: NonNullable<BoardFrame['stats']> }) {
  const times: readonly [string, string, string][] = [
    ['Processing', milliseconds(1000 * stats.processingS), 'Of a frame, on the board'],
    ['Sending', milliseconds(1000 * stats.transmitS), 'Of a packet, over the data port'],
    ['Left of a frame', milliseconds(1000 * stats.frameMarginS), 'Until the next one'],
    ['Left of a chirp', milliseconds(1000 * stats.chirpMarginS), 'Until the next one'],
    ['Load in a frame', `${stats.activeLoadPercent} %`, 'Of the board’s processor, while chirps are sent'],
    ['Load between', `${stats.idleLoadPercent} %`, 'Of the board’s processor, between frames'],
  ];
  return (
    <dl class="facts flat" data-facts="timing">
      {times.map(([term, value, help]) => (
        <div key={term} title={help}>
          <dt>{term}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
