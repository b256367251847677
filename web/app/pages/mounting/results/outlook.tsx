/** What driving on would bring, where the angle is not settled or its verdict does not stand. */
import type { CalibrationOutlook, CalibrationResult } from 'boresight';
import { fixed } from '../../../../plots/format.ts';
import { results } from './process.ts';

/** Whether another minute could change what is said. */
const open = ({ converged, alignment }: CalibrationResult): boolean => !converged || alignment === 'undecided';

export function Outlook() {
  const { outlook, result } = results.value.get('recursive')?.calibration ?? {};
  return outlook && result ? <OutlookOf outlook={outlook} result={result} /> : null;
}

export function OutlookOf({ outlook, result }: { outlook: CalibrationOutlook; result: CalibrationResult }) {
  if (!open(result)) return null;
  return (
    <div class="outlook" data-outlook>
      <p>
        <strong>Next.</strong> {outlook.advice}
      </p>
      <details>
        <summary>What a minute more would bring</summary>
        <div class="table-scroll" tabIndex={0} role="region" aria-label="What a minute more would bring, scrollable">
          <table class="data">
            <thead>
              <tr>
                <th scope="col" class="text">
                  How to drive
                </th>
                <th scope="col" title="Standard deviation of the angle after a minute of it">
                  σ after a minute (°)
                </th>
                <th scope="col" title="Minutes of it until the angle is settled and the verdict stands">
                  Enough after (min)
                </th>
              </tr>
            </thead>
            <tbody>
              {outlook.forecasts.map(({ manoeuvre, instruction, sigmaDeg, minutes }) => (
                <tr key={manoeuvre} data-manoeuvre={manoeuvre}>
                  <th scope="row" class="text">
                    {instruction}
                  </th>
                  <td>±{fixed(sigmaDeg, 3)}</td>
                  <td>{minutes ?? 'over 20'}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
        <p class="small muted">
          Now ±{fixed(outlook.sigmaDeg, 3)}°; ±{fixed(outlook.neededDeg, 3)}° are needed. No drive brings less than ±
          {fixed(outlook.leastDeg, 3)}°: that much azimuths may be off as a whole.
        </p>
      </details>
    </div>
  );
}
