/** A raw frame, processed in this tab. */
import type { Detection } from 'boresight';
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../elements/base/define.ts';
import { PointCloudElement } from '../../../elements/kinds/point-cloud.ts';
import { RangeDopplerElement } from '../../../elements/kinds/range-doppler.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { ElementFrame } from '../../ui/plot-frame.tsx';
import type { RawShown } from './session.ts';
import { liveState } from './state.ts';

defineElement('boresight-point-cloud', PointCloudElement);
defineElement('boresight-range-doppler', RangeDopplerElement);

const COLUMNS: readonly [
  name: keyof Omit<Detection, 'foldProbability'>,
  heading: string,
  said: (value: number) => string,
][] = [
  ['rangeM', 'Range (m)', (value) => fixed(value, 3)],
  ['rateMps', 'Rate (m/s)', (value) => signed(value, 2)],
  ['azimuthDeg', 'Azimuth (°)', (value) => signed(value, 2)],
  ['powerDb', 'Power (dBFS)', (value) => fixed(value, 1)],
  ['snrDb', 'SNR (dB)', (value) => fixed(value, 1)],
];

export function RawPlots({ number, view }: RawShown) {
  const { span, colors, range } = liveState.value;
  const points = useMemo(
    () => ({
      rangeM: view.detections.map(({ rangeM }) => rangeM),
      azimuthDeg: view.detections.map(({ azimuthDeg }) => azimuthDeg),
      rangeRateMps: view.detections.map(({ rateMps }) => rateMps),
    }),
    [view],
  );
  const detail = `Frame ${number}`;
  return (
    <>
      <div class="wide-narrow">
        <ElementFrame
          tag="boresight-range-doppler"
          own={{ frame: view, colors, 'span-db': span }}
          title="Range-Doppler map"
          name="raw-range-doppler"
          height="medium"
          listed="none"
          detail={detail}
          remarks={['Squares: detections.']}
        />
        <ElementFrame
          tag="boresight-point-cloud"
          own={{ points, boresight: true, range: range > 0 ? range : undefined }}
          title="Detections"
          name="raw-points"
          height="medium"
          detail={detail}
        />
      </div>
      <section class="panel" aria-labelledby="raw-detections">
        <div class="panel-head">
          <h3 id="raw-detections">Detections</h3>
          <span class="muted">{detail}</span>
        </div>
        <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Detections">
          <table class="data" data-table="raw-detections" data-frame={number}>
            <thead>
              <tr>
                {COLUMNS.map(([name, heading]) => (
                  <th key={name} scope="col">
                    {heading}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {view.detections.map((row) => (
                <tr key={`${row.rangeBin}:${row.dopplerBin}`}>
                  {COLUMNS.map(([name, , said]) => (
                    <td key={name} data-field={name} data-value={row[name]}>
                      {said(row[name])}
                    </td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </section>
    </>
  );
}
