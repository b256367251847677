/** Frames: slider, playback, all together; progress of the work and its end. */
import { useEffect } from 'preact/hooks';
import { significant } from '../../../../plots/format.ts';
import { ProgressLine, Stopped } from '../../../ui/progress.tsx';
import { cancel, progress, restart, result, wasCancelled } from '../detections/process.ts';
import { loaded } from '../files/files.ts';
import { captureState, update } from '../state.ts';
import { frameAt, playing, playOn, showFrame, togglePlaying } from './playback.ts';

/** Playback is no faster than one can see. */
const SHORTEST_MS = 200;

export function FrameBar() {
  const capture = loaded.value;
  const { frame } = captureState.value;
  const frames = capture?.info.frames ?? 0;
  const interval = capture?.info.config.waveform.frameIntervalS ?? 0;
  useEffect(() => {
    if (!playing.value || frames < 2) return undefined;
    const timer = setInterval(playOn, Math.max(interval * 1000, SHORTEST_MS));
    return () => clearInterval(timer);
  }, [playing.value, frames, interval]);
  useEffect(
    () => () => {
      playing.value = false;
    },
    [],
  );
  if (!capture) return null;
  const at = frameAt();
  return (
    <section class="panel frame-bar" aria-label="Frames">
      <button
        type="button"
        aria-pressed={frame === 'all'}
        data-action="all-frames"
        title="Powers averaged over all frames; detections of all frames joined"
        onClick={() => {
          playing.value = false;
          update({ frame: frame === 'all' ? 0 : 'all' });
        }}
      >
        All {frames} frames
      </button>
      <button
        type="button"
        aria-pressed={playing.value}
        data-action="play"
        disabled={frames < 2}
        title="Step through the frames"
        onClick={togglePlaying}
      >
        {playing.value ? 'Pause' : 'Play'}
      </button>
      <input
        type="range"
        min={0}
        max={Math.max(frames - 1, 0)}
        step={1}
        value={at}
        aria-label="Frame"
        name="frame"
        disabled={frames < 2}
        aria-valuetext={frame === 'all' ? 'all frames' : `frame ${at + 1} of ${frames}`}
        onInput={(event) => showFrame(Number(event.currentTarget.value))}
      />
      <output>
        {frame === 'all' ? 'all combined' : `frame ${at + 1} of ${frames}, ${significant(at * interval * 1000)} ms`}
      </output>
      <Progress />
    </section>
  );
}

function Progress() {
  const percent = ({ done, total }: { done: number; total: number }): string =>
    `${Math.round((100 * done) / Math.max(total, 1))} %`;
  const state = progress.value;
  if (state) {
    return (
      <ProgressLine
        what="Processing"
        text={percent(state)}
        share={state.total > 0 ? state.done / state.total : 0}
        cancel="cancel"
        onCancel={cancel}
      >
        {result.value && <span class="muted">Shown until then: the settings before</span>}
      </ProgressLine>
    );
  }
  if (wasCancelled.value) {
    return (
      <Stopped
        text={`Cancelled at ${percent(wasCancelled.value)}`}
        action="resume"
        label="Process again"
        onResume={restart}
      />
    );
  }
  return null;
}
