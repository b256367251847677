/** The array: where its elements are, its response from boresight, and the numbers that follow. */
import { useMemo } from 'preact/hooks';
import { AZIMUTH } from '../../../plots/axes.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { bands, markers } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { ACCENT_STYLE } from '../../../plots/theme.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { beamPattern, type Scene } from './compute.ts';

const ELEMENT = { ...ACCENT_STYLE, marker: 'circle' as const };

/** Width between the -3 dB points about 0 degrees, and the highest sidelobe beyond the first nulls. */
export function patternFigures(
  azimuthDeg: ArrayLike<number>,
  valuesDb: ArrayLike<number>,
): { widthDeg: number; sidelobeDb: number } {
  let peak = 0;
  for (let i = 1; i < valuesDb.length; i++) if ((valuesDb[i] as number) > (valuesDb[peak] as number)) peak = i;
  const crossing = (step: number): { at: number; end: number } => {
    let i = peak;
    while (i + step >= 0 && i + step < valuesDb.length && (valuesDb[i] as number) > -3) i += step;
    const [a, b] = [valuesDb[i - step] as number, valuesDb[i] as number];
    const share = a === b ? 0 : (a + 3) / (a - b);
    const at =
      (azimuthDeg[i - step] as number) + share * ((azimuthDeg[i] as number) - (azimuthDeg[i - step] as number));
    while (i + step >= 0 && i + step < valuesDb.length && (valuesDb[i + step] as number) < (valuesDb[i] as number))
      i += step;
    return { at, end: i };
  };
  const left = crossing(-1);
  const right = crossing(1);
  let sidelobeDb = Number.NEGATIVE_INFINITY;
  for (let i = 0; i < valuesDb.length; i++) {
    if (i < left.end || i > right.end) sidelobeDb = Math.max(sidelobeDb, valuesDb[i] as number);
  }
  return { widthDeg: right.at - left.at, sidelobeDb };
}

export function ArrayPanel({ scene }: { scene: Scene }) {
  const { geometry } = scene;
  const { array } = scene.state;
  const pattern = useMemo(() => beamPattern(array), [array]);
  const figures = useMemo(() => patternFigures(pattern.azimuthDeg, pattern.valuesDb), [pattern]);
  const layout = useMemo(() => {
    const ys = geometry.positions.map(([, y]) => y);
    const zs = geometry.positions.map(([, , z]) => z);
    const pad = (low: number, high: number, least: number): [number, number] => {
      const margin = Math.max((high - low) * 0.06, least);
      return [low - margin, high + margin];
    };
    return {
      x: [...ys].sort((a, b) => a - b),
      series: [],
      extent: { x: pad(Math.min(...ys), Math.max(...ys), 0.8), y: pad(Math.min(...zs), Math.max(...zs), 1) },
      above: [
        markers(
          geometry.positions.map(([, y, z]) => ({
            x: y,
            y: z,
            style: ELEMENT,
            size: geometry.positions.length > 24 ? 2.2 : 4,
          })),
        ),
      ],
    };
  }, [array]);
  const outside =
    geometry.unambiguousDeg < 89.9
      ? ([
          [-90, -geometry.unambiguousDeg],
          [geometry.unambiguousDeg, 90],
        ] as const)
      : [];
  const response = useMemo(
    () => ({
      x: pattern.azimuthDeg,
      series: [{ id: 'pattern', label: 'Response', y: pattern.valuesDb, style: { color: ACCENT_STYLE.color } }],
      extent: { x: [-90, 90] as const, y: [-50, 3] as const },
      below: [bands(outside, (t) => t.shade)],
    }),
    [pattern],
  );
  const facts: [string, string, string][] = [
    [
      'Elements',
      String(geometry.positions.length),
      `${geometry.tx.length} transmitters × ${geometry.rx.length} receivers`,
    ],
    [
      'Aperture',
      `${fixed(geometry.aperture, geometry.aperture % 1 ? 1 : 0)}\u00a0λ/2`,
      'Length along y, half wavelengths',
    ],
    ['Beam width, −3 dB', `${fixed(figures.widthDeg, 1)}°`, 'Of the beamformer at boresight'],
    [
      'Peak sidelobe',
      Number.isFinite(figures.sidelobeDb) ? `${fixed(figures.sidelobeDb, 1)}\u00a0dB` : 'none',
      'Highest response outside the main lobe',
    ],
    ['Unambiguous', `±${fixed(geometry.unambiguousDeg, 0)}°`, 'Sector without grating lobes'],
    [
      'Spacing',
      geometry.uniform ? 'uniform' : geometry.extent === 'area' ? 'planar' : 'not uniform',
      'Whether elements are evenly spaced on a line',
    ],
  ];
  return (
    <section class="array-panel" aria-label="Array">
      <dl class="facts" data-facts="array">
        {facts.map(([term, value, help]) => (
          <div key={term} title={help}>
            <dt>{term}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
      <div class="two">
        <PlotFrame
          title="Virtual elements"
          detail={`${geometry.positions.length} of ${array.split(':')[0]}`}
          name="elements"
          height="short"
          content={layout}
          axes={{
            x: { label: 'y (half wavelengths), positive left', descending: true },
            y: { label: 'z (half wavelengths)' },
          }}
          readout={({ x, y }) => `y ${signed(x, 2)}   z ${signed(y, 2)}`}
          csv={() =>
            toCsv(
              ['element', 'x_half_wavelengths', 'y_half_wavelengths', 'z_half_wavelengths', 'tx', 'rx'],
              geometry.positions.map((position, i) => [
                i,
                ...position,
                geometry.channels[i]?.tx,
                geometry.channels[i]?.rx,
              ]),
            )
          }
          fileParts={[array.split(':')[0] ?? '']}
        />
        <PlotFrame
          title="Beam pattern at boresight"
          detail={`of ${geometry.positions.length} elements, first null at ±${fixed(geometry.resolutionDeg, 1)}°`}
          name="pattern"
          height="short"
          content={response}
          axes={{ x: AZIMUTH, y: { label: 'Response (dB)' } }}
          readout={({ x, index }) =>
            `Azimuth ${signed(x, 2)}°   Response ${fixed(pattern.valuesDb[index ?? -1] ?? Number.NaN, 1)}\u00a0dB`
          }
          csv={() =>
            toCsv(
              ['azimuth_deg', 'response_db'],
              Array.from(pattern.azimuthDeg, (azimuth, i) => [azimuth, pattern.valuesDb[i]]),
            )
          }
          fileParts={[array.split(':')[0] ?? '']}
        />
      </div>
    </section>
  );
}
