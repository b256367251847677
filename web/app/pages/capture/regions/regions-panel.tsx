/** Regions of the shown frame, how many targets a network counts in each, and where others see them. */
import type { RegionTarget, TargetRegion } from 'boresight';
import { count, fixed, signed } from '../../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../../plots/save.ts';
import { trainedOnBoards } from '../../../networks/models.ts';
import { LoadState } from '../../../ui/network-note.tsx';
import { captureState, update } from '../state.ts';
import { cancelRegions, regions, regionsProblem, regionsWorking, type ShownRegions, trio } from './regions.ts';

/** Most targets that networks here tell apart. */
const MOST = 2;

export function RegionsPanel({ fileParts }: { fileParts: readonly (string | number)[] }) {
  const wanted = captureState.value.regions;
  const networks = trio.value;
  const shown = regions.value;
  const problem = regionsProblem.value;
  const three = networks && typeof networks !== 'string' ? [networks.counting, networks.one, networks.two] : [];
  const boards = three.some(({ card }) => trainedOnBoards(card))
    ? three.every(({ card }) => trainedOnBoards(card))
      ? ' of boards that are not calibrated'
      : ', some of boards that are not calibrated'
    : ' of an exact array';
  return (
    <section class="panel" aria-labelledby="regions-title" aria-busy={regionsWorking.value} data-table="regions">
      <div class="panel-head">
        <h3 id="regions-title">Regions, counted and told by networks</h3>
        {shown && (
          <span class="muted" data-count={shown.view.regions.length}>
            {shown.view.regions.length} in frame {shown.frame + 1}
          </span>
        )}
        <div class="tools">
          {shown && (
            <button
              type="button"
              data-export="csv"
              onClick={() =>
                download(csv(shown), fileName(['regions', ...fileParts.slice(0, 1), `frame${shown.frame + 1}`], 'csv'))
              }
            >
              CSV
            </button>
          )}
        </div>
      </div>
      <p class="remark">
        Detection along range begins a region at each peak. A network counts its targets, none, one or two, and another
        for so many tells their angles in whole degrees; regions beyond 10° are turned to where most of their power
        comes from. All were trained on simulated data{boards}.
        {captureState.value.frame === 'all' && wanted && ' Networks take one frame at a time: this is the first.'}
      </p>
      {typeof networks === 'string' ? (
        <p class="notice" data-regions="none">
          The counting network {networks}.
        </p>
      ) : (
        <p class="row choices">
          {wanted ? (
            <button
              type="button"
              data-action="stop-regions"
              onClick={() => {
                cancelRegions();
                update({ regions: false });
              }}
            >
              Stop
            </button>
          ) : (
            <button
              type="button"
              class="primary"
              data-action="find-regions"
              disabled={!networks}
              onClick={() => update({ regions: true })}
            >
              Find regions
            </button>
          )}
          {wanted &&
            three.map(({ name, title }) => (
              <span key={name} class="muted">
                {title}: <LoadState name={name} />
              </span>
            ))}
        </p>
      )}
      {problem && (
        <p class="alert" role="alert" data-error={problem.code}>
          {problem.message} <code>{problem.code}</code>
        </p>
      )}
      {shown && <Table {...shown} />}
    </section>
  );
}

function Table({ view }: ShownRegions) {
  const { counts } = view;
  const left: [string, number][] = [
    ['Bins over threshold', counts.cellsOverThreshold],
    ['Joined to a peak', counts.grouped],
    ['Peaks in a stronger one’s region', counts.joined],
    ['Outside the limits', counts.outsideRegion],
    ['Beyond the most', counts.beyondLimit],
    ['Counted as empty', counts.withoutTarget],
    ['Beyond 90°', counts.beyondHorizon],
  ];
  return (
    <>
      <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Regions, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th scope="col">Range (m)</th>
              <th scope="col" title="Range rate, positive when receding">
                Rate (m/s)
              </th>
              <th scope="col" title="Over the noise around the peak">
                SNR (dB)
              </th>
              <th scope="col" title="Where most of the region’s power comes from, positive to the left of boresight">
                Coarse (°)
              </th>
              <th scope="col" title="Whether the region was turned to it, so that ±10° applies there">
                Turned
              </th>
              <th scope="col">Targets</th>
              <th scope="col" title="Probability of none, one and two targets, each for itself">
                P(0), P(1), P(2)
              </th>
              <th scope="col" title="Of each target, strongest first; positive to the left of boresight">
                Azimuths (°)
              </th>
            </tr>
          </thead>
          <tbody>
            {view.regions.map((region) => (
              <Row key={region.rangeBin} region={region} />
            ))}
            {view.regions.length === 0 && (
              <tr>
                <td class="text" colSpan={8}>
                  No regions with these settings.
                </td>
              </tr>
            )}
          </tbody>
        </table>
      </div>
      <dl class="facts flat" data-facts="regions">
        {left.map(([term, value]) => (
          <div key={term}>
            <dt>{term}</dt>
            <dd>{count(value)}</dd>
          </div>
        ))}
      </dl>
      {view.warnings.length > 0 && (
        <ul class="warnings">
          {view.warnings.map(({ code, message }) => (
            <li key={code}>
              {message} <code>{code}</code>
            </li>
          ))}
        </ul>
      )}
    </>
  );
}

function Row({ region }: { region: TargetRegion }) {
  const { rangeBin, rangeM, rateMps, snrDb, coarseAzimuthDeg, rotated, sources, probability, targets } = region;
  return (
    <tr data-region={rangeBin}>
      <td data-field="rangeM" data-value={rangeM}>
        {fixed(rangeM, 2)}
      </td>
      <td>{signed(rateMps, 2)}</td>
      <td>{fixed(snrDb, 1)}</td>
      <td data-field="coarse" data-value={coarseAzimuthDeg}>
        {signed(coarseAzimuthDeg, 1)}
      </td>
      <td class="text">{rotated ? 'yes' : 'no'}</td>
      <td data-field="sources" data-value={sources}>
        {sources}
      </td>
      <td>{[...probability].map((p) => fixed(p, 2)).join(', ')}</td>
      <td data-field="azimuths" data-value={targets.map(({ azimuthDeg }) => azimuthDeg).join(',')}>
        {targets.map(({ azimuthDeg }) => signed(azimuthDeg, 1)).join(', ') || '–'}
      </td>
    </tr>
  );
}

function csv({ view }: ShownRegions): string {
  const of = (target: RegionTarget | undefined): (number | undefined)[] => [target?.azimuthDeg, target?.powerDb];
  return toCsv(
    [
      ...['range_bin', 'range_m', 'rate_mps', 'snr_db', 'coarse_azimuth_deg', 'turned', 'targets', 'p0', 'p1', 'p2'],
      ...Array.from({ length: MOST }, (_, i) => [`azimuth_${i + 1}_deg`, `power_${i + 1}_db`]).flat(),
    ],
    view.regions.map((r) => [
      ...[r.rangeBin, r.rangeM, r.rateMps, r.snrDb, r.coarseAzimuthDeg, Number(r.rotated), r.sources, ...r.probability],
      ...Array.from({ length: MOST }, (_, i) => of(r.targets[i])).flat(),
    ]),
  );
}
