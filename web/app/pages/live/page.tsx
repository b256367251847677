import { useAddress } from '../../state/address.ts';
import { About } from '../../ui/about.tsx';
import { MainColumn } from '../../ui/main-column.tsx';
import { ProgressLine } from '../../ui/progress.tsx';
import { BoardPlots } from './board-plots.tsx';
import { Controls } from './controls.tsx';
import { Counters, LiveBar } from './counters.tsx';
import { replayBundled } from './files.ts';
import { cancelSending, portProblem, sending } from './ports.ts';
import { config, loadBundledProfile, profile } from './profile.ts';
import { RawPlots } from './raw-plots.tsx';
import { frame, live, liveProblem, raw, stop } from './session.ts';
import { captionOf, liveCodec, liveState } from './state.ts';

/** What the address last asked to be played, and how. */
let played = '';

export function LivePage() {
  useAddress('live', {
    codec: liveCodec,
    restore: (params) => {
      const asked = liveCodec.read(params);
      liveState.value = asked;
      // A link plays what it names; the same settings once more do not, and none ends a board.
      const text = `${asked.play} ${asked.pace}`;
      if (text === played) return;
      played = text;
      const now = live.peek();
      const busy = now !== null && now.kind !== 'replay' && now.state !== 'ended';
      if (asked.play === 'bundled' && !busy) queueMicrotask(() => void replayBundled());
    },
    start: () => {
      if (!profile.peek()) void loadBundledProfile().catch(() => {});
      return () => {
        played = '';
        stop();
      };
    },
    write: () => liveCodec.write(liveState.value),
    caption: () => captionOf(liveState.peek(), live.peek()?.name ?? 'nothing'),
  });
  const now = live.value;
  const problems = [portProblem.value, liveProblem.value].filter((one) => one !== null);
  return (
    <div class="page">
      <Controls />
      <MainColumn busy={now?.state === 'opening'}>
        {problems.map(({ code, message }) => (
          <p key={code} class="alert" role="alert" data-error={code}>
            {message} <code>{code}</code>
          </p>
        ))}
        {sending.value && <Sending />}
        {now ? <LiveBar now={now} /> : <Beginning />}
        {now?.state === 'lost' && (
          <p class="notice" role="status" data-notice="lost">
            The board was unplugged. Plug it in again, and frames go on; or choose the data port anew.
          </p>
        )}
        {frame.value && <BoardPlots frame={frame.value} config={config.value} />}
        {raw.value && <RawPlots {...raw.value} />}
        {now && !frame.value && !raw.value && now.state !== 'ended' && (
          <p class="panel loading" role="status">
            Waiting for the first frame
          </p>
        )}
        <Counters />
        <About title="About this page">
          <p>
            A TI board with the demo of the mmWave SDK has two serial ports. The command port takes the configuration, a
            line after the answer to the one before; the data port sends a packet a frame. Packets are found by their
            beginning, so that bytes that are lost on the line cost the packets that they are in and no other. Errors of
            the line are counted, and reading goes on behind them.
          </p>
          <p>
            A recording comes over the same way as a board’s bytes do, and shows what a board would show. A DCA1000
            capture card sends raw samples over UDP, which pages cannot read; <code>boresight bridge</code> hands them
            on, and each frame is processed here as the page Capture does. Frames that come meanwhile are passed over.
          </p>
          <p>
            <b>Signs.</b> Azimuth is positive to the left of boresight; range rate is positive when receding. A board’s
            x points right; it is turned into this frame before it is shown.
          </p>
        </About>
      </MainColumn>
    </div>
  );
}

function Beginning() {
  return (
    <section class="panel loading" aria-label="Nothing is live yet">
      <p>
        {liveState.value.source === 'board'
          ? 'Choose the ports of a board and connect, or replay a recording.'
          : 'Start the bridge on this machine and connect.'}
      </p>
      {liveState.value.source === 'board' && (
        <p class="row">
          <button type="button" class="primary" data-action="replay-now" onClick={() => void replayBundled()}>
            Replay the bundled recording
          </button>
        </p>
      )}
    </section>
  );
}

/** The configuration on its way. */
function Sending() {
  const now = sending.value;
  if (!now) return null;
  const { lines, total, done } = now;
  return (
    <section class="panel" aria-labelledby="live-sent">
      <div class="panel-head">
        <h3 id="live-sent">Configuration</h3>
        <span class="muted" data-sent={lines.length}>
          {done ? `${lines.length} of ${total} lines taken` : ''}
        </span>
      </div>
      {!done && (
        <ProgressLine
          what="Sending the configuration"
          text={total ? `line ${lines.length + 1} of ${total}` : 'waiting for the board'}
          share={total ? lines.length / total : null}
          cancel="cancel-sending"
          onCancel={cancelSending}
        />
      )}
      <details class="table-details">
        <summary>What the board said</summary>
        <ol class="sent" tabIndex={0} aria-label="Lines that were sent">
          {lines.map(({ number, command, answer }) => (
            <li key={number} value={number}>
              <code>{command}</code> <span class="muted">{answer}</span>
            </li>
          ))}
        </ol>
      </details>
    </section>
  );
}
