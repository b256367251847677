import { useSignalEffect } from '@preact/signals';
import { count, fixed } from '../../../plots/format.ts';
import { api } from '../../data.ts';
import { useAddress } from '../../state/address.ts';
import { announce } from '../../state/announce.ts';
import { About } from '../../ui/about.tsx';
import { MainColumn } from '../../ui/main-column.tsx';
import { ProgressLine, Stopped } from '../../ui/progress.tsx';
import { fileNames, fileProblem, loaded, openBundled, waiting } from '../capture/files/files.ts';
import { Controls } from './controls.tsx';
import { ImagePlot, saveAll } from './image-plot.tsx';
import { gridProblem, input, problemOfInput, shownRadars } from './input.ts';
import { Legend } from './legend.tsx';
import { cancel, frameProblem, frames, images, progress, restart, start, wasCancelled, working } from './process.ts';
import { ResultsTable } from './results-table.tsx';
import { birdseyeCodec, birdseyeState, captionOf, zoom } from './state.ts';

function restore(params: URLSearchParams): void {
  const { view, ...state } = birdseyeCodec.read(params);
  birdseyeState.value = state;
  zoom.value = view;
}

export function BirdseyePage() {
  useAddress('birdseye', {
    codec: birdseyeCodec,
    restore,
    start,
    write: () => birdseyeCodec.write({ ...birdseyeState.value, view: zoom.value }),
    caption: () => captionOf(birdseyeState.peek(), shownRadars.peek(), fileNames()),
  });
  useSignalEffect(() => {
    if (birdseyeState.value.source === 'capture' && !loaded.peek() && !waiting.peek()) void openBundled();
  });
  useSignalEffect(() => {
    if (working.value) return;
    const lines = api.methods().flatMap(({ name, title }) => {
      const measure = images.value.get(name)?.measure;
      return measure ? [`${title}: ${fixed(measure.outsideDb, 1)} dB outside the targets`] : [];
    });
    if (lines.length) announce(`${lines.join('. ')}.`);
  });
  const capture = birdseyeState.value.source === 'capture';
  const problems = [
    problemOfInput.value,
    gridProblem.value,
    frameProblem.value,
    capture ? fileProblem.value : null,
  ].filter((problem) => problem !== null);
  const begins = images.value.size === 0 && problems.length === 0 && !wasCancelled.value;
  const awaited = working.value || begins ? birdseyeState.value.methods : [];
  return (
    <div class="page">
      <Controls />
      <MainColumn busy={working.value}>
        {problems.map((problem) => (
          <p key={problem.code} class="alert" role="alert" data-error={problem.code}>
            <strong>No image with these settings.</strong> {problem.message} <code>{problem.code}</code>
          </p>
        ))}
        <Bar />
        {input.value && shownRadars.value.length === 0 && (
          <p class="notice" role="status" data-notice="radars">
            No radar is switched on.
          </p>
        )}
        {images.value.size === 0 && (
          <p class="notice" role="status" data-notice="methods">
            No method is chosen.
          </p>
        )}
        <div class="images">
          {api.methods().map((info) => {
            const image = images.value.get(info.name);
            if (image) return <ImagePlot key={info.name} info={info} image={image} />;
            return awaited.includes(info.name) && <Awaited key={info.name} title={info.title} />;
          })}
        </div>
        <ResultsTable />
        <Counts />
        <Help />
      </MainColumn>
    </div>
  );
}

/** Keeps the place of an image that is being computed. */
function Awaited({ title }: { title: string }) {
  return (
    <div class="panel" data-awaited>
      <div class="panel-head">
        <h3 class="muted">{title}</h3>
      </div>
      <div class="portrait" />
    </div>
  );
}

/** What the signs mean, how far the work is, and how to move about. */
function Bar() {
  return (
    <section class="panel birdseye-bar" aria-label="Legend and progress">
      <Legend />
      <Progress />
      <button
        type="button"
        data-action="save-all"
        disabled={working.value || !images.value.size}
        title="Save all images side by side"
        onClick={() => void saveAll()}
      >
        PNG of all
      </button>
    </section>
  );
}

function Progress() {
  const state = progress.value;
  if (state) return <ProgressLine {...state} cancel="cancel" onCancel={cancel} />;
  if (wasCancelled.value) {
    return (
      <Stopped
        text="Cancelled: what is greyed is of other settings"
        action="resume"
        label="Compute again"
        onResume={restart}
      />
    );
  }
  return (
    <p class="muted small">Drag to move, wheel over a chosen image or two fingers to zoom; all images move together.</p>
  );
}

/** What was dropped on the way, radar by radar. */
function Counts() {
  if (!frames.value.length) return null;
  const rows = frames.value.map(({ radar, cells: { counts, rangeM }, visible }) => ({
    radar,
    counts,
    cells: rangeM.length,
    visible: visible?.length,
  }));
  const street = input.value?.street;
  return (
    <section class="panel" aria-labelledby="counts-title" data-table="counts">
      <div class="panel-head">
        <h3 id="counts-title">What each radar detected, and what was dropped</h3>
      </div>
      <div class="table-scroll" tabIndex={0} role="region" aria-label="Counts, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th scope="col" class="text">
                Radar
              </th>
              {street && (
                <th scope="col" title="Points of the street in its field of view that nothing hides">
                  True points
                </th>
              )}
              <th scope="col" title="Cells of range and Doppler that go into the images">
                Cells
              </th>
              <th scope="col" title="Before grouping">
                Over threshold
              </th>
              <th scope="col" title="Cells over the threshold that are no local peak">
                Joined to a peak
              </th>
              <th scope="col" title="Dropped by the limits of range">
                Outside the region
              </th>
              <th scope="col" title="Dropped because there were more than the most that are kept">
                Beyond the limit
              </th>
              <th scope="col" title="Samples at the converter’s limits">
                Clipped samples
              </th>
            </tr>
          </thead>
          <tbody>
            {rows.map(({ radar, counts, cells, visible }) => (
              <tr key={radar.name} data-radar={radar.name}>
                <th scope="row" class="text">
                  {radar.title}
                </th>
                {street && <td>{count(visible ?? 0)}</td>}
                <td data-field="cells" data-value={cells}>
                  {count(cells)}
                </td>
                <td>{count(counts.cellsOverThreshold)}</td>
                <td>{count(counts.grouped)}</td>
                <td>{count(counts.outsideRegion)}</td>
                <td>{count(counts.beyondLimit)}</td>
                <td>{count(counts.clippedSamples)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

function Help() {
  return (
    <About title="What is seen here">
      <p>
        Each radar sends one frame of chirps. Range and Doppler transforms and a detector leave the cells in which
        something is; the phases across the antennas of such a cell give one snapshot, and a method makes of it a
        spectrum over azimuth, or a few directions. All cells together make a map over range and azimuth, which is laid
        on the ground around the car. Where radars overlap, the strongest is shown.
      </p>
      <p>
        <b>Why IAA is cleaner.</b> The FFT (Bartlett) sees a point through the array’s beam pattern: a main lobe as wide
        as the aperture allows, and with 48 sparse elements side lobes 14 dB below it in every direction. Each strong
        point thus draws an arc at its range. IAA weighs the data anew for each direction by what all the other
        directions were found to hold, and so takes their side lobes away; NOMP finds one direction after the other and
        subtracts it.
      </p>
      <p>
        <b>Energy outside</b> is the image’s energy farther from all true points than the radars resolve, over all of
        its energy, dB. True points are those which a radar that is on can see: in its field of view and hidden by
        nothing.
      </p>
      <p>
        <b>Frames and signs.</b> The car’s frame: origin at the rear axle, x ahead, y to the left. Powers are those of
        one raw sample at one element relative to full scale. A capture says nothing of a car: its board lies at the
        origin.
      </p>
      <p>
        <b>Keys</b> on a chosen image: plus and minus zoom, 0 shows all, arrows move, with Shift they move the cursor.
        With the mouse a drag moves, a drag with Shift zooms to a region, the wheel zooms an image that was clicked, or
        any with Ctrl.
      </p>
    </About>
  );
}
