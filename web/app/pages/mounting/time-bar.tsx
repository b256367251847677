/** The moment that is shown: slider, playback, speed; progress of the work and its end. */
import { fixed } from '../../plots/format.ts';
import { cancelOpening, interrupted, openAgain, opening, scans, sensor } from './drive.ts';
import { frame, playing, showFrame, time, togglePlaying } from './playhead.ts';
import { cancel, progress, restart, wasCancelled } from './process.ts';
import { mountingState, SPEEDS, update } from './state.ts';

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
      <div class="progress-line" data-opening>
        <progress max={1} value={being.share ?? undefined} aria-label={being.what} />
        <span>{being.what}</span>
        <button type="button" data-action="cancel-opening" onClick={cancelOpening}>
          Cancel
        </button>
      </div>
    );
  }
  if (interrupted.value) {
    return (
      <div class="progress-line" data-interrupted>
        <span class="muted">Cancelled</span>
        <button type="button" data-action="open-again" onClick={openAgain}>
          Open again
        </button>
      </div>
    );
  }
  const state = progress.value;
  if (state) {
    const share = state.total > 0 ? state.done / state.total : 0;
    return (
      <div class="progress-line" data-progress>
        <progress max={1} value={share} aria-label="Calibrating" />
        <span>{Math.round(100 * share)} %</span>
        <button type="button" data-action="cancel" onClick={cancel}>
          Cancel
        </button>
      </div>
    );
  }
  if (wasCancelled.value && sensor.value) {
    return (
      <div class="progress-line" data-cancelled>
        <span class="muted">Cancelled</span>
        <button type="button" data-action="resume" onClick={restart}>
          Calibrate again
        </button>
      </div>
    );
  }
  return null;
}
