import { useSignalEffect } from '@preact/signals';
import { count, fixed, signed } from '../../../plots/format.ts';
import { useAddress } from '../../state/address.ts';
import { announce } from '../../state/announce.ts';
import { About } from '../../ui/about.tsx';
import { MainColumn } from '../../ui/main-column.tsx';
import { startBeforeAfter } from './array-calibration/before-after.ts';
import { startCalibration } from './array-calibration/calibrate.ts';
import { calibrationProblem, calibrationWanted, mending } from './array-calibration/in-effect.ts';
import { ArrayCalibrationPanel } from './array-calibration/panel.tsx';
import { caption, start as startCompare } from './compare/compare.ts';
import { ComparePanel } from './compare/compare-panel.tsx';
import { Controls } from './controls.tsx';
import { DetectionTable } from './detections/detection-table.tsx';
import { compare } from './detections/match.ts';
import {
  cellResults,
  processProblem,
  result,
  type Shown,
  seesElevation,
  start,
  usedArray,
  wasCancelled,
  working,
} from './detections/process.ts';
import { doubtsOf } from './files/doubts.ts';
import {
  boardLog,
  fileProblem,
  filesWanted,
  isStudio,
  loaded,
  openBundled,
  startFiles,
  type Waiting,
  waiting,
} from './files/files.ts';
import { FrameBar } from './frames/frame-bar.tsx';
import { CellPanel } from './plots/cell-panel.tsx';
import { startOverTime } from './plots/over-time.ts';
import { CapturePoints } from './plots/point-cloud.tsx';
import { startRangeAzimuth } from './plots/range-azimuth.ts';
import { RangeAzimuth } from './plots/range-azimuth-plot.tsx';
import { CellWhy, RangeDopplerMap, RangeProfile } from './plots/range-plots.tsx';
import { TimePlots } from './plots/time-plots.tsx';
import { shownCell } from './plots/view.ts';
import { startRegions } from './regions/regions.ts';
import { RegionsPanel } from './regions/regions-panel.tsx';
import { captureCodec, captureState, update } from './state.ts';
import { Summary } from './summary.tsx';

export function CapturePage() {
  useAddress('capture', {
    codec: captureCodec,
    restore: (params) => {
      captureState.value = captureCodec.read(params);
    },
    start: () => {
      const stops = [
        ...[startFiles(), start(), startOverTime(), startRangeAzimuth(), startRegions(), startCompare()],
        ...[startCalibration(), startBeforeAfter()],
      ];
      return () => {
        for (const stop of stops) stop();
      };
    },
    write: () => captureCodec.write(captureState.value),
    caption,
  });

  const capture = loaded.value;
  useSignalEffect(() => {
    const shown = result.value?.view;
    if (shown) {
      announce(
        `${shown.detections.length} detections. ${shown.detections
          .slice(0, 4)
          .map((row) => `${fixed(row.rangeM, 2)} metres at ${signed(row.azimuthDeg, 1)} degrees`)
          .join(', ')}.`,
      );
    }
  });
  const problem = fileProblem.value;
  return (
    <div class="page">
      <Controls />
      <MainColumn busy={working.value}>
        {problem && (
          <p class="alert" role="alert" data-error={problem.code}>
            <strong>{problem.file ? `${problem.file}: ` : ''}</strong>
            {problem.message} <code>{problem.code}</code>
            {capture && ' The capture opened before is still shown.'}
          </p>
        )}
        {calibrationProblem.value && (
          <p class="alert" role="alert" data-error={calibrationProblem.value.code}>
            <strong>No array calibration.</strong> {calibrationProblem.value.message}{' '}
            <code>{calibrationProblem.value.code}</code>
          </p>
        )}
        {waiting.value && <WaitingFor {...waiting.value} />}
        {filesWanted.value && (
          <p class="notice" role="status" data-notice="files">
            This link is of a capture that is not here. Open or drop its .bin and .cfg to see it with these settings, or{' '}
            <button type="button" onClick={() => void openBundled()}>
              open the bundled capture
            </button>
          </p>
        )}
        {calibrationWanted.value && (
          <p class="notice" role="status" data-notice="calibration">
            This link is of an array calibration that is not here ({captureState.value.calibration}). Open or drop its
            .calibration.json; until then that of the configuration is used, if there is one.{' '}
            <button type="button" onClick={() => update({ calibration: 'configured' })}>
              Leave it at that
            </button>
          </p>
        )}
        {result.value && <Doubts shown={result.value} />}
        {processProblem.value && (
          <p class="alert" role="alert" data-error={processProblem.value.code}>
            <strong>Cannot process with these settings.</strong> {processProblem.value.message}
            {processProblem.value.code === 'other-array' && mending('other-array')}{' '}
            <code>{processProblem.value.code}</code>
            {capture && !usedArray.value && (
              <>
                {' '}
                The configuration does not name the board: choose it under Detection, Virtual array
                {capture.files.some(({ name }) => isStudio(name)) && ', or open the .setup.json with the .mmwave.json'}.
              </>
            )}
          </p>
        )}
        {capture && <Summary info={capture.info} geometry={usedArray.value} />}
        {capture && <FrameBar />}
        {result.value ? (
          <Plots {...result.value} />
        ) : (
          !waiting.value &&
          !filesWanted.value &&
          !processProblem.value &&
          !wasCancelled.value &&
          (capture || !problem) && (
            <p key={capture ? 'processing' : 'loading'} class="panel loading" role="status">
              {capture ? 'Processing the capture' : 'Loading the capture'}
            </p>
          )
        )}
        <About title="About this page">
          <p>
            A capture is the raw samples of a DCA1000 board (.bin) and the configuration the radar ran with (.cfg, or
            mmWave Studio’s .mmwave.json, with .setup.json for the board); the log of the board’s own detections (.dat)
            may come with it. A recording in several numbered .bin files is opened by giving all of them together.
            Samples are windowed and transformed along range and Doppler; transmitters that take turns are aligned for
            the motion between them; cells over the threshold become detections, and the phases across the virtual array
            give their angle.
          </p>
          <p>
            <b>Signs.</b> Azimuth is positive to the left of boresight; range rate is positive when receding. The
            board’s log has x to the right; it is turned into this frame before it is shown.
          </p>
          <p>
            <b>In space</b> x points forward, y to the left and z up, in metres from the radar. Elevation takes an array
            with elements above each other, such as those of the AWR1843 and the 6843; “Simulated, 3-D” has one without
            a board.
          </p>
          <p>
            <b>Levels</b> are the power of one raw sample at one element relative to full scale (dBFS). SNR is a cell’s
            power over the noise level estimated around it.
          </p>
          <p>
            <b>All frames</b> averages the power maps, detects in the mean, and estimates each angle from one snapshot a
            frame, which methods that need a covariance call for. It is meant for scenes that stay in their cells.
          </p>
          <p>
            <b>Array calibration</b> takes gain and phase of each channel off the snapshots before angles are estimated.
            One that is made here is used at once, and checked on frames that were left out of it. Files of calibrations
            are JSON as this page, the package and the command line write it, tables of measured steering vectors, or
            TI’s line compRangeBiasAndRxChanPhase; that of the capture’s own configuration is used by default.
          </p>
          <p>
            <b>Over time</b> each frame is a column. The range-time plot has the frame’s range profile, the
            micro-Doppler its Doppler spectrum within a range gate around the chosen cell. Both step in whole frames, as
            the spectrum of a frame takes all its chirps: what moves back and forth within a frame widens the line, and
            is not followed.
          </p>
        </About>
      </MainColumn>
    </div>
  );
}

/** One's own files without the other that they need. */
function WaitingFor({ files, missing }: Waiting) {
  return (
    <p class="notice" role="status" data-waiting={missing.map(({ kind }) => kind).join(',')}>
      <strong>{files.map(({ name }) => name).join(', ')}:</strong> {missing.map(({ what }) => what).join(' and ')}{' '}
      {missing.length > 1 ? 'are' : 'is'} missing. Open or drop {missing.length > 1 ? 'them' : 'it'}, and processing
      begins; the bundled capture lends no file to one of your own.
    </p>
  );
}

function Plots({ capture, frame, view }: Shown) {
  const log = boardLog.value;
  const { cell: chosen, board } = captureState.value;
  const cell = shownCell(view, chosen);
  const boardIndex = log?.frames.length
    ? board === 'last'
      ? log.frames.length - 1
      : Math.min(Number(board), log.frames.length - 1)
    : -1;
  const boardFrame = log?.frames[boardIndex];
  const objects = boardFrame?.objects ?? [];
  const gateM = Math.max(2 * capture.info.config.summary.rangeResolutionM, 0.1);
  const here = compare(view.detections, objects, gateM).find(
    ({ row }) => row && Math.abs(row.rangeBin - cell.rangeBin) <= 1 && Math.abs(row.dopplerBin - cell.dopplerBin) <= 1,
  )?.board;
  const label = frame === 'all' ? `Mean of ${view.frames} frames` : `Frame ${frame + 1} of ${capture.info.frames}`;
  const fileParts = [
    capture.files[0]?.name.replace(/\.bin$/i, '') ?? 'capture',
    frame === 'all' ? 'all-frames' : `frame${frame + 1}`,
  ];
  const shared = { view, cell, board: objects, label, fileParts };
  const geometry = usedArray.value;
  const elevated = seesElevation();
  return (
    <>
      <div class="wide-narrow">
        <div class="stack">
          <RangeProfile {...shared} />
          <CellWhy view={view} cell={cell} />
          <RangeDopplerMap {...shared} />
        </div>
        <CellPanel
          view={view}
          cell={cell}
          results={cellResults.value}
          boardDeg={here?.azimuthDeg}
          unambiguousDeg={geometry?.unambiguousDeg ?? 90}
          positions={geometry?.positions}
          label={label}
          fileParts={fileParts}
        />
      </div>
      <ComparePanel view={view} />
      <CapturePoints view={view} capture={capture} cell={cell} label={label} fileParts={fileParts} />
      <DetectionTable
        view={view}
        cell={cell}
        board={boardFrame ? objects : null}
        gateM={gateM}
        elevated={elevated}
        fileParts={fileParts}
        foot={
          log &&
          boardFrame && (
            <>
              {log.frames.length > 1 && (
                <div class="row board-frame">
                  <label for="board-frame">Board’s frame</label>
                  <input
                    id="board-frame"
                    type="range"
                    min={0}
                    max={log.frames.length - 1}
                    step={1}
                    value={boardIndex}
                    name="board"
                    onInput={(event) => {
                      const value = Number(event.currentTarget.value);
                      update({ board: value === log.frames.length - 1 ? 'last' : String(value) });
                    }}
                  />
                  <output>
                    {boardIndex + 1} of {log.frames.length}
                  </output>
                </div>
              )}
              <p class="remark">
                Matched within {fixed(gateM, 2)} m of range.
                {capture.bundled && ' The bundled log is from a separate run on what appears to be the same scene.'}
              </p>
            </>
          )
        }
      />
      <ArrayCalibrationPanel view={view} cell={cell} fileParts={fileParts} />
      <TimePlots view={view} fileParts={fileParts} />
      <RangeAzimuth fileParts={fileParts} />
      <RegionsPanel fileParts={fileParts} />
      <Remarks capture={capture} view={view} />
    </>
  );
}

/** What speaks against the files, above what is drawn from them. */
function Doubts({ shown }: { shown: Shown }) {
  const doubts = doubtsOf(shown);
  if (!doubts.length) return null;
  return (
    <ul class="notice doubts" role="status" aria-label="Doubts about the capture">
      {doubts.map(({ code, message }) => (
        <li key={code} data-doubt={code}>
          {message} <code>{code}</code>
        </li>
      ))}
    </ul>
  );
}

/** What was dropped on the way, and what the files and the processing had to say. */
function Remarks({ capture, view }: Pick<Shown, 'capture' | 'view'>) {
  const log = boardLog.value;
  const { counts } = view;
  const facts: [string, number, string][] = [
    ['Cells over threshold', counts.cellsOverThreshold, 'Before grouping'],
    ['Joined to a peak', counts.grouped, 'Cells over the threshold that are no local peak'],
    ['Other Doppler bands', counts.otherBands, 'Echoes of stronger targets, in Doppler-division multiplexing'],
    ['Undecided rates', counts.undecidedFolds, 'Cells whose fold of the range rate is not certain'],
    ['Outside the region', counts.outsideRegion, 'Dropped by the limits of range, sector and elevation'],
    ['Without angle', counts.withoutAngle, 'Cells in which the method found no direction'],
    ['Beyond the limit', counts.beyondLimit, 'Dropped because there were more than the most that are kept'],
    ['Clipped samples', counts.clippedSamples, 'Samples at the converter’s limits'],
    ['Trailing bytes', capture.info.trailingBytes, 'After the last whole frame of the .bin'],
    ...(log
      ? ([
          ['Skipped log bytes', log.skippedBytes, 'Between the packets of the .dat'],
          ['Damaged packets', log.damagedPackets, 'Packets of the .dat that were cut or not readable'],
        ] as [string, number, string][])
      : []),
  ];
  const warnings = [
    ...capture.info.config.warnings,
    ...(capture.cascade ?? []),
    ...capture.info.warnings,
    ...view.warnings,
    ...(log?.warnings ?? []),
  ];
  return (
    <section class="panel" aria-labelledby="counts-title">
      <div class="panel-head">
        <h3 id="counts-title">What was dropped, and remarks</h3>
      </div>
      <dl class="facts flat" data-facts="counts">
        {facts.map(([term, value, help]) => (
          <div key={term} title={help}>
            <dt>{term}</dt>
            <dd>{count(value)}</dd>
          </div>
        ))}
      </dl>
      {warnings.length > 0 && (
        <ul class="warnings">
          {warnings.map(({ code, message }, i) => (
            <li key={i}>
              {message} <code>{code}</code>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
