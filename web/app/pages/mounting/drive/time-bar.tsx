/** The moment that is shown: slider, playback, speed; progress of the work and its end. */
import { fixed } from '../../../../plots/format.ts';
import { ProgressLine, Stopped } from '../../../ui/progress.tsx';
import { cancel, progress, restart, wasCancelled } from '../results/process.ts';
import { mountingState, SPEEDS, update } from '../state.ts';
import { cancelOpening, interrupted, openAgain, opening, scans, sensor } from './drive.ts';
import { frame, playing, showFrame, time, togglePlaying } from './playhead.ts';

export function TimeBar() {
  const { timeS } = scans.value;
  const start = timeS[0] ?? 0;
  const at = frame.value;
  return (
    <section class="panel frame-bar time-bar" aria-label="Time">
      <button
        type="button"
        aria-pressed={playing.value}
        data-action="play"
        disabled={timeS.length < 2}
        title="Play the frames on (space)"
        onClick={togglePlaying}
      >
        {playing.value ? 'Pause' : 'Play'}
      </button>
      <select
        class="speed"
        aria-label="Playback speed"
        title="Playback speed"
        name="speed"
        value={mountingState.value.speed}
        onChange={(event) => update({ speed: event.currentTarget.value as (typeof SPEEDS)[number] })}
      >
        {SPEEDS.map((speed) => (
          <option key={speed} value={speed} selected={speed === mountingState.value.speed}>
            {speed} {'×'}
          </option>
        ))}
      </select>
      <input
        type="range"
        min={0}
        max={Math.max(timeS.length - 1, 0)}
        step={1}
        value={at}
        aria-label="Time"
        name="time"
        disabled={timeS.length < 2}
        title="Arrows step by a frame; Page Up and Page Down by a tenth of the drive"
        aria-valuetext={`${fixed(time.value - start, 1)} s, frame ${at + 1} of ${timeS.length}`}
        onInput={(event) => {
          playing.value = false;
          showFrame(Number(event.currentTarget.value));
        }}
      />
      <output data-time={time.value}>
        {fixed(time.value - start, 1)} s of {fixed((timeS.at(-1) ?? 0) - start, 1)} s, frame {timeS.length ? at + 1 : 0}{' '}
        of {timeS.length}
      </output>
      <Progress />
    </section>
  );
}

/** How far the work is, and its end. */
export function Progress() {
  const being = opening.value;
  if (being) {
    return (
      <ProgressLine
        mark="data-opening"
        what={being.what}
        share={being.share}
        cancel="cancel-opening"
        onCancel={cancelOpening}
      />
    );
  }
  if (interrupted.value) {
    return (
      <Stopped text="Cancelled" mark="data-interrupted" action="open-again" label="Open again" onResume={openAgain} />
    );
  }
  const state = progress.value;
  if (state) {
    const share = state.total > 0 ? state.done / state.total : 0;
    return (
      <ProgressLine
        what="Calibrating"
        text={`${Math.round(100 * share)} %`}
        share={share}
        cancel="cancel"
        onCancel={cancel}
      />
    );
  }
  if (wasCancelled.value && sensor.value) {
    return <Stopped text="Cancelled" action="resume" label="Calibrate again" onResume={restart} />;
  }
  return null;
}
