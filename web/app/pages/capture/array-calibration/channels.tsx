/** Gain and phase of each channel with their deviations, as plots and as a table. */
import type { ArrayCalibration } from 'boresight';
import { useMemo } from 'preact/hooks';
import { fixed, signed } from '../../../../plots/format.ts';
import { horizontalLine, type Marker, markers } from '../../../../plots/layers.ts';
import { toCsv } from '../../../../plots/save.ts';
import { ACCENT_STYLE, type SeriesStyle } from '../../../../plots/theme.ts';
import { PlotFrame } from '../../../ui/plot-frame.tsx';
import { type FileParts, withDeviation } from './words.ts';

export function Channels({ calibration, fileParts }: { calibration: ArrayCalibration; fileParts: FileParts }) {
  const { channels, rx } = calibration;
  const moved = channels.some(({ displacement }) => displacement);
  return (
    <>
      <div class="two">
        <ChannelPlot
          calibration={calibration}
          quantity="gain"
          title="Gain of each channel"
          unit="dB"
          of={({ gainDb, gainStdDb }) => [gainDb, gainStdDb]}
          fileParts={fileParts}
        />
        <ChannelPlot
          calibration={calibration}
          quantity="phase"
          title="Phase of each channel"
          unit="°"
          of={({ phaseDeg, phaseStdDeg }) => [phaseDeg, phaseStdDeg]}
          fileParts={fileParts}
        />
      </div>
      <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Channels of the array, scrollable">
        <table class="data compact" data-table="channels">
          <thead>
            <tr>
              <th scope="col" class="text">
                Channel
              </th>
              <th scope="col" title="In their order of transmission">
                Transmitter
              </th>
              <th scope="col">Receiver</th>
              <th scope="col" title="Over that of the plan, with its standard deviation">
                Gain (dB)
              </th>
              <th scope="col" title="Over that of the plan, with its standard deviation">
                Phase (°)
              </th>
              {moved && (
                <th scope="col" title="To the left, and upwards">
                  Displacement (λ/2)
                </th>
              )}
            </tr>
          </thead>
          <tbody>
            {channels.map(({ gainDb, gainStdDb, phaseDeg, phaseStdDeg, displacement }, i) => (
              <tr key={i} data-channel={i}>
                <th scope="row" class="text">
                  {i + 1}
                </th>
                <td>{Math.floor(i / rx.length) + 1}</td>
                <td>{(i % rx.length) + 1}</td>
                <td data-field="gainDb" data-value={gainDb} data-deviation={gainStdDb}>
                  {withDeviation(signed(gainDb, 2), gainStdDb, 2)}
                </td>
                <td data-field="phaseDeg" data-value={phaseDeg} data-deviation={phaseStdDeg}>
                  {withDeviation(signed(phaseDeg, 1), phaseStdDeg, 1)}
                </td>
                {moved && (
                  <td>
                    {(displacement ?? [0, 0, 0])
                      .slice(1)
                      .map((one) => signed(one, 3))
                      .join(', ')}
                  </td>
                )}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

const POINTS: SeriesStyle = { color: ACCENT_STYLE.color, marker: 'circle' };

function ChannelPlot({
  calibration,
  quantity,
  title,
  unit,
  of,
  fileParts,
}: {
  calibration: ArrayCalibration;
  quantity: 'gain' | 'phase';
  title: string;
  unit: string;
  of(channel: ArrayCalibration['channels'][number]): readonly [value: number, deviation: number | undefined];
  fileParts: FileParts;
}) {
  const points = useMemo(() => calibration.channels.map(of), [calibration]);
  const label = `${quantity === 'gain' ? 'Gain' : 'Phase'} (${unit})`;
  const known = points.some(([, deviation]) => deviation !== undefined);
  const content = useMemo(() => {
    const reach = Math.max(...points.map(([value, deviation = 0]) => Math.abs(value) + deviation), 1e-3) * 1.15;
    return {
      x: points.map((_, i) => i + 1),
      series: [],
      above: [
        horizontalLine(0, 'plan'),
        markers(
          points.map(
            ([y, deviation], i): Marker => ({
              x: i + 1,
              y,
              style: POINTS,
              ...(deviation === undefined ? {} : { deviation: { x: 0, y: deviation } }),
            }),
          ),
        ),
      ],
      // The name of the line stands behind the last.
      extent: { x: [0.5, points.length + 1.1] as const, y: [-reach, reach] as const },
    };
  }, [points]);
  const text = ([value, deviation]: readonly [number, number | undefined]): string =>
    withDeviation(signed(value, 2), deviation, 2);
  return (
    <PlotFrame
      title={title}
      name={`channel-${quantity}`}
      height="short"
      content={content}
      axes={{ x: { label: 'Virtual channel', steps: [1, 2, 5, 10, 20, 50, 100] }, y: { label } }}
      legend={[{ id: quantity, label: known ? `${label}, bars ±σ` : label, style: POINTS, line: false }]}
      alternative={points.map((point, i) => `Channel ${i + 1}: ${text(point)} ${unit}.`).join('\n')}
      readout={({ x, y, index }) => {
        const point = points[index ?? -1];
        return point
          ? `Channel ${(index ?? 0) + 1}   ${text(point)} ${unit}`
          : `Channel ${fixed(x, 0)}   ${fixed(y, 2)} ${unit}`;
      }}
      csv={() => {
        const name = quantity === 'gain' ? 'gain_db' : 'phase_deg';
        return toCsv(
          ['channel', name, `${name}_std`],
          points.map(([value, deviation], i) => [i + 1, value, deviation]),
        );
      }}
      fileParts={fileParts}
      remarks={['Over that of the plan, all receivers of a transmitter after each other.']}
    />
  );
}

/** What the calibration does on cells that it was not made from. */
