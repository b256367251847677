/** Calibration of the array: what is in effect, how one is made, and what it does to the chosen cell. */
import type { Cell, Detection, FrameResult } from 'boresight';
import { useRef } from 'preact/hooks';
import { fixed, signed } from '../../../../plots/format.ts';
import { download, fileName } from '../../../../plots/save.ts';
import { api, describeError } from '../../../data.ts';
import { controlOf } from '../../../ui/control.tsx';
import { FileButton } from '../../../ui/file-button.tsx';
import { NumberCell } from '../../../ui/number-field.tsx';
import { ProgressLine, Stopped } from '../../../ui/progress.tsx';
import { usedArray } from '../detections/process.ts';
import { loaded } from '../files/files.ts';
import { captureCodec, captureState, type KnownReflector, MOST_REFLECTORS, update } from '../state.ts';
import {
  type CalibrateBy,
  calibrate,
  cancelCalibration,
  made,
  makeProblem,
  makeProgress,
  makeStopped,
  makingBy,
} from './calibrate.ts';
import { calibrationProblem, configured, inEffect, openCalibrations } from './in-effect.ts';
import { ownOf } from './own-calibrations.ts';
import { CalibrationResults } from './results.tsx';

const Control = controlOf(captureCodec, captureState, update);

/** What captures are processed by, in words. */
export function effectInWords(): string {
  const { calibration } = captureState.value;
  if (calibration === 'none') return 'none, by choice';
  const own = ownOf(calibration);
  if (own) return own.name;
  return configured.value ? 'of the configuration (compRangeBiasAndRxChanPhase)' : 'none: the configuration has none';
}

export function ArrayCalibrationPanel({
  view,
  cell,
  fileParts,
}: {
  view: FrameResult;
  cell: Cell;
  fileParts: readonly (string | number)[];
}) {
  const calibration = inEffect.value;
  const working = makingBy.value;
  const problem = makeProblem.value;
  const { done, total } = makeProgress.value;
  const { reflectors } = captureState.value;
  const parts = ['array', ...fileParts.slice(0, 1)];
  return (
    <section
      class="panel"
      aria-labelledby="array-calibration-title"
      aria-busy={working !== null}
      data-panel="array-calibration"
    >
      <div class="panel-head">
        <h3 id="array-calibration-title">Array calibration</h3>
        <span class="muted" data-in-effect>
          In effect: {effectInWords()}
        </span>
        <div class="tools">
          <button
            type="button"
            data-export="json"
            title="Save the calibration in effect, for this page, the package and the command line"
            disabled={!calibration}
            onClick={() =>
              calibration && download(`${JSON.stringify(calibration, null, 2)}\n`, fileName(parts, 'calibration.json'))
            }
          >
            JSON
          </button>
          <button
            type="button"
            data-export="line"
            title="Save TI’s line compRangeBiasAndRxChanPhase, for the configuration of the board"
            disabled={!calibration}
            onClick={() => saveLine(parts)}
          >
            TI line
          </button>
        </div>
      </div>
      <p class="remark">
        Channels of a board differ in gain and phase by what lines, antennas and reflections near them do. Strong cells
        with a single target tell how much, without its angle being known; a reflector at a known angle tells the
        direction too. Targets have to stay in their cells. Which calibration is in effect is chosen under Detection,
        Array calibration.
      </p>
      <div class="row choices">
        <Control
          label="Frames"
          name="calibrationFrames"
          labels={{ even: 'even, checked on odd', half: 'first half, checked on the other', all: 'all, not checked' }}
          help="Frames it is made from, and those it is checked on."
        />
        <Control label="Estimate" name="calibrationModel" labels={{ channels: 'gain and phase' }} />
        <Control label="Least SNR" name="calibrationSnr" />
        <Control label="Most left over" name="calibrationResidual" />
      </div>
      <Reflectors view={view} cell={cell} />
      <div class="row choices">
        <button
          type="button"
          class="primary"
          data-action="self-calibrate"
          title="From all strong cells that hold one target; no angle has to be known"
          disabled={working !== null}
          onClick={() => void calibrate('cells')}
        >
          Self-calibrate
        </button>
        <button
          type="button"
          data-action="calibrate-reflectors"
          title="From the reflectors in the list"
          disabled={working !== null || reflectors.length === 0}
          onClick={() => void calibrate('reflectors')}
        >
          Calibrate by reflectors
        </button>
        <FileButton
          label="Array calibration"
          accept=".json,.cfg,.txt"
          action="open-calibration"
          title="A calibration as JSON, a table of measured steering vectors as JSON, or a configuration with TI’s line compRangeBiasAndRxChanPhase"
          onFiles={(files) => void openCalibrations(files.map(({ file }) => file))}
        >
          Open calibration
        </FileButton>
        {working && (
          <ProgressLine
            what="Calibrating the array"
            share={total > 0 ? done / total : 0}
            cancel="cancel-calibration"
            onCancel={cancelCalibration}
          />
        )}
        {makeStopped.value && (
          <Stopped
            text="Cancelled; the calibration before is in effect"
            action="resume-calibration"
            label="Calibrate again"
            onResume={() => void calibrate(makeStopped.peek() as CalibrateBy)}
          />
        )}
      </div>
      {problem && (
        <p class="alert" role="alert" data-error={problem.code}>
          <strong>The array could not be calibrated.</strong> {problem.message} <code>{problem.code}</code>
        </p>
      )}
      {calibration && (
        <CalibrationResults calibration={calibration} made={ofEffect()} fileParts={fileParts.slice(0, 1)} />
      )}
    </section>
  );
}

/** What was made here, where that is in effect. */
const ofEffect = () => {
  const own = made.value;
  return own && captureState.value.calibration === `own:${own.id}` ? own : null;
};

function saveLine(parts: readonly string[] | readonly (string | number)[]): void {
  const [calibration, capture] = [inEffect.peek(), loaded.peek()];
  if (!calibration || !capture) return;
  try {
    download(`${api.tiCompensation(calibration, capture.cfg)}\n`, fileName(parts, 'cfg'));
  } catch (error) {
    calibrationProblem.value = describeError(error);
  }
}

/** The range of a cell: of the detection there, or of the bin. */
function rangeOf({ detections, rangeM }: FrameResult, cell: Cell): number {
  const there = (row: Detection): boolean => row.rangeBin === cell.rangeBin && row.dopplerBin === cell.dopplerBin;
  return Number((detections.find(there)?.rangeM ?? rangeM[cell.rangeBin] ?? 0).toFixed(3));
}

function Reflectors({ view, cell }: { view: FrameResult; cell: Cell }) {
  const list = useRef<HTMLDivElement>(null);
  const { reflectors, exactRanges } = captureState.value;
  const set = (at: number, patch: Partial<KnownReflector>): void =>
    update({ reflectors: reflectors.map((one, i) => (i === at ? { ...one, ...patch } : one)) });
  const { extent } = usedArray.value ?? {};
  const elevated = extent === 'area' || extent === 'line';
  const range = rangeOf(view, cell);
  return (
    <div class="reflectors" ref={list}>
      <div class="row choices">
        <button
          type="button"
          data-action="add-reflector"
          title="Click a cell on the map, the profile or the table of detections first"
          disabled={reflectors.length >= MOST_REFLECTORS}
          onClick={() => {
            update({ reflectors: [...reflectors, { rangeM: range, azimuthDeg: null, elevationDeg: 0 }] });
            // Its angle is typed next.
            requestAnimationFrame(() =>
              list.current?.querySelector<HTMLElement>(`[name="reflector-azimuth-${reflectors.length}"]`)?.focus(),
            );
          }}
        >
          Add the chosen cell as a reflector
        </button>
        <span class="muted small">
          {fixed(range, 2)} m, {signed(view.rateMps[cell.dopplerBin] ?? Number.NaN, 2)} m/s: click another on the map,
          the profile or the table.
        </span>
      </div>
      {reflectors.length > 0 && (
        <div class="table-scroll" tabIndex={0} role="region" aria-label="Reflectors, scrollable">
          <table class="data compact" data-table="reflectors">
            <thead>
              <tr>
                <th scope="col" class="text">
                  Reflector
                </th>
                <th scope="col">Range (m)</th>
                <th scope="col" title="Positive to the left; empty where it is not known">
                  Azimuth (°)
                </th>
                {elevated && (
                  <th scope="col" title="Positive upwards">
                    Elevation (°)
                  </th>
                )}
                <th>
                  <span class="visually-hidden">Remove</span>
                </th>
              </tr>
            </thead>
            <tbody>
              {reflectors.map((one, i) => (
                <tr key={i} data-reflector={i}>
                  <th scope="row" class="text">
                    {i + 1}
                  </th>
                  <td>
                    <NumberCell
                      label={`Range of reflector ${i + 1}, m`}
                      name={`reflector-range-${i}`}
                      value={one.rangeM}
                      step={0.01}
                      min={0}
                      max={100_000}
                      onChange={(rangeM) => set(i, { rangeM })}
                    />
                  </td>
                  <td>
                    <NumberCell
                      label={`Azimuth of reflector ${i + 1}, degrees; empty where it is not known`}
                      name={`reflector-azimuth-${i}`}
                      value={one.azimuthDeg ?? Number.NaN}
                      step={0.1}
                      min={-90}
                      max={90}
                      onChange={(azimuthDeg) => set(i, { azimuthDeg })}
                      onEmpty={() => set(i, { azimuthDeg: null })}
                    />
                  </td>
                  {elevated && (
                    <td>
                      <NumberCell
                        label={`Elevation of reflector ${i + 1}, degrees`}
                        name={`reflector-elevation-${i}`}
                        value={one.elevationDeg}
                        step={0.1}
                        min={-90}
                        max={90}
                        onChange={(elevationDeg) => set(i, { elevationDeg })}
                      />
                    </td>
                  )}
                  <td>
                    <button
                      type="button"
                      class="plain"
                      aria-label={`Remove reflector ${i + 1}`}
                      title="Remove"
                      onClick={() => update({ reflectors: reflectors.filter((_, at) => at !== i) })}
                    >
                      {'×'}
                    </button>
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      )}
      {(reflectors.length > 0 || exactRanges) && (
        <div class="row choices">
          <Control label="Ranges are exact" name="exactRanges" />
        </div>
      )}
    </div>
  );
}
