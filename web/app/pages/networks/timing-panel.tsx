/** "Time it here": network and classical methods on the same cells, in this browser. */
import { engineering, fixed, milliseconds } from '../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../plots/save.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { ProgressLine } from '../../ui/progress.tsx';
import { Swatch } from '../../ui/swatch.tsx';
import { selected } from './attempt.ts';
import type { Spread } from './measure.ts';
import { BATCHES, type Batch, cancelTiming, timeModel, timing, timingKey, timingProblem, timings } from './timing.ts';

const perSecond = (spread: Spread, batch: Batch): number => (1000 * batch) / spread.median;
const short = (value: number): string => milliseconds(value).replace('\u00a0ms', '');

export function TimingPanel() {
  const model = selected.value;
  if (!model) return null;
  const state = timing.value;
  const mine = state?.model === model.name ? state : null;
  const problem = timingProblem.value?.model === model.name ? timingProblem.value.problem : null;
  const made = timings.value.get(timingKey(model));
  const csv = (): string =>
    toCsv(
      ['subject', 'batch', 'median_ms', 'lower_quartile_ms', 'upper_quartile_ms', 'calls', 'samples_per_s'],
      (made?.rows ?? []).flatMap(({ subject, method, network, batches }) =>
        [...batches].map(([batch, spread]) => [
          network ? method : subject,
          batch,
          spread.median,
          spread.low,
          spread.high,
          spread.calls,
          perSecond(spread, batch),
        ]),
      ),
    );
  const against = made?.rows.find(({ network }) => network)?.batches;
  return (
    <section class="panel" aria-labelledby="time-title" aria-busy={mine !== null} data-table="timing">
      <div class="panel-head">
        <h2 id="time-title">Time it here</h2>
        <div class="tools">
          <button
            type="button"
            class="primary"
            data-action="time"
            disabled={mine !== null}
            onClick={() => void timeModel(model)}
          >
            Time it here
          </button>
          {made && (
            <button
              type="button"
              data-export="csv"
              onClick={() => download(csv(), fileName(['times', model.name], 'csv'))}
            >
              CSV
            </button>
          )}
        </div>
      </div>
      {mine && (
        <div class="timing-progress">
          <ProgressLine what={mine.what} share={mine.share} cancel="cancel-timing" onCancel={cancelTiming} />
        </div>
      )}
      {problem && (
        <p class="alert" role="alert" data-error={problem.code}>
          <strong>Nothing was timed.</strong> {problem.message} <code>{problem.code}</code>
        </p>
      )}
      {made ? (
        <>
          <div class="table-scroll" tabIndex={0} role="region" aria-label="Times, scrollable">
            <table class="data">
              <thead>
                <tr>
                  <th rowSpan={2} scope="col" class="text">
                    On the same cells
                  </th>
                  {BATCHES.map((batch) => (
                    <th key={batch} colSpan={3} scope="colgroup" class="group-head">
                      {batch === 1 ? 'One at a time' : `Batches of ${batch}`}
                    </th>
                  ))}
                </tr>
                <tr>
                  {BATCHES.map((batch) => [
                    <th key={`m${batch}`} scope="col" class="group-start" title="Median of a call, with its quartiles">
                      Call (ms)
                    </th>,
                    <th key={`s${batch}`} scope="col" title="Cells a second at the median">
                      Cells/s
                    </th>,
                    <th key={`r${batch}`} scope="col" title="Time a cell over the network’s">
                      Time, network = 1
                    </th>,
                  ])}
                </tr>
              </thead>
              <tbody>
                {made.rows.map(({ subject, title, method, network, batches }) => (
                  <tr key={subject} class={network ? 'reference' : ''} data-row={subject}>
                    <th scope="row" class="text">
                      <Swatch style={methodStyle(method)} line /> {title}
                    </th>
                    {BATCHES.map((batch) => {
                      const spread = batches.get(batch);
                      const base = against?.get(batch);
                      return (
                        spread && [
                          <td
                            key={`m${batch}`}
                            class="group-start"
                            data-field={`batch${batch}`}
                            data-value={spread.median}
                            title={`${spread.calls} calls`}
                          >
                            {short(spread.median)}{' '}
                            <span class="muted">
                              ({short(spread.low)} to {short(spread.high)})
                            </span>
                          </td>,
                          <td key={`s${batch}`} data-field={`rate${batch}`} data-value={perSecond(spread, batch)}>
                            {engineering(perSecond(spread, batch), '')}
                          </td>,
                          <td key={`r${batch}`}>{base ? fixed(spread.median / base.median, 2) : ''}</td>,
                        ]
                      );
                    })}
                  </tr>
                ))}
              </tbody>
            </table>
          </div>
          <p class="remark">
            On one worker, which shares this machine with all else; {milliseconds(made.travelMs)} of each call are the
            way there and back. The network: its graph alone. Classical methods take one cell after the other, also in
            batches.
          </p>
        </>
      ) : (
        !mine && (
          <p class="remark">
            Runs the network and classical methods on the same simulated cells in this browser for some ten seconds:
            median and quartiles, one at a time and in batches of 32.
          </p>
        )
      )}
    </section>
  );
}
