/** The frame from above, in the car's frame, with the angle applied. */

import { useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../elements/drawing.ts';
import { AHEAD, LEFT } from '../../../plots/axes.ts';
import { carOutline, ground } from '../../../plots/car.ts';
import { detectionLayer, detectionLegend, nearest } from '../../../plots/detections.ts';
import { fixed, signed } from '../../../plots/format.ts';
import type { Layer } from '../../../plots/layers.ts';
import { quantiles } from '../../../plots/quantiles.ts';
import { toCsv } from '../../../plots/save.ts';
import { ACCENT_STYLE } from '../../../plots/theme.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { loaded } from './drive.ts';
import { type FrameView, inCar, sample, usedAngleDeg } from './frame.ts';
import { where } from './process.ts';
import { fileParts, frameKey } from './time-plot.tsx';

export function BirdPlot({ view, label }: { view: FrameView; label: string }) {
  const drive = loaded.value?.drive;
  const at = where.value;
  const angleDeg = usedAngleDeg.value;
  const extent = useMemo(() => {
    const ranges = drive?.detections.rangeM;
    const azimuths = drive?.detections.azimuthDeg;
    const places = sample.value.map((k) =>
      inCar(ranges?.[k] ?? Number.NaN, azimuths?.[k] ?? Number.NaN, at?.nominalDeg ?? angleDeg),
    );
    const along = (axis: 0 | 1): [number, number] => {
      const [low, high] = quantiles(
        places.map((place) => place[axis]),
        0.02,
        0.95,
      ) ?? [-20, 20];
      return [Math.min(low, -3) - 2, Math.max(high, 6) + 2];
    };
    return { x: along(1), y: along(0) };
  }, [drive, sample.value, at?.nominalDeg]);
  const places = useMemo(() => {
    const all = Array.from(view.azimuthDeg, (azimuth, i) => inCar(view.rangeM?.[i] ?? Number.NaN, azimuth, angleDeg));
    return { ahead: all.map(([x]) => x), left: all.map(([, y]) => y) };
  }, [view, angleDeg, at]);
  const content = useMemo(
    () => ({
      x: [],
      series: [],
      extent,
      below: [carOutline(), boresight(at?.xM ?? 0, at?.yM ?? 0, at?.nominalDeg ?? null, angleDeg)],
      above: [detectionLayer(places.left, places.ahead, view)],
    }),
    [places, view, extent, at?.nominalDeg, angleDeg],
  );
  const legend: LegendItem[] = [
    ...detectionLegend(view),
    { id: 'boresight', label: `Boresight, ${signed(angleDeg, 2)}°`, style: BORESIGHT, line: true },
    ...(at?.nominalDeg == null
      ? []
      : [
          {
            id: 'nominal',
            label: `Nominal, ${signed(at.nominalDeg, 2)}°`,
            style: { ...BORESIGHT, dash: [3, 4] },
            line: true,
          },
        ]),
  ];
  const without = !view.rangeM || quantiles(view.rangeM, 0, 1) === null;
  return (
    <PlotFrame
      title="From above, in the car’s frame"
      name="birds-eye"
      height="tall"
      content={content}
      legend={legend}
      keys="Space plays; arrows step by a frame, with Shift by ten."
      axes={{ x: LEFT, y: AHEAD, equal: true }}
      onKey={frameKey}
      readout={(position) => {
        const i = nearest(places.left, places.ahead, position, extent);
        if (i === null) return `Ahead ${signed(position.y, 1)} m   left ${signed(position.x, 1)} m`;
        const rcs = view.rcsDbsm?.[i];
        return (
          `Detection ${i + 1}: ahead ${signed(places.ahead[i] as number, 1)} m   left ${signed(places.left[i] as number, 1)} m   range ${fixed(view.rangeM?.[i] ?? Number.NaN, 1)} m` +
          (rcs !== undefined && Number.isFinite(rcs) ? `   RCS ${signed(rcs, 1)} dBsm` : '')
        );
      }}
      csv={() =>
        toCsv(
          ['x_m', 'y_m', 'range_m', 'azimuth_deg', 'rcs_dbsm', 'weight'],
          Array.from(view.azimuthDeg, (azimuth, i) => [
            places.ahead[i],
            places.left[i],
            view.rangeM?.[i],
            azimuth,
            view.rcsDbsm?.[i],
            view.weights?.[i],
          ]),
        )
      }
      fileParts={[...fileParts(), `${fixed(view.timeS, 2)}s`]}
      remarks={[
        without && view.azimuthDeg.length
          ? 'This drive has no ranges, so its detections have no place.'
          : `${label}. The radar is turned by the angle found. The car’s outline is a typical one.`,
      ]}
    />
  );
}

const BORESIGHT = { color: ACCENT_STYLE.color };

/** The radar and where it looks: as found, and as it should. */
function boresight(xM: number, yM: number, nominalDeg: number | null, angleDeg: number): Layer {
  return (context) => {
    const { ctx, plot, themeName, ratio } = context;
    const reach = Math.hypot(plot.bbox.width, plot.bbox.height);
    const [px, py] = ground(context)(xM, yM);
    const ray = (direction: number, dash: number[]): void => {
      const radians = (direction * Math.PI) / 180;
      ctx.setLineDash(dash.map((d) => d * ratio));
      ctx.beginPath();
      ctx.moveTo(px, py);
      ctx.lineTo(px - reach * Math.sin(radians), py - reach * Math.cos(radians));
      ctx.stroke();
    };
    ctx.strokeStyle = BORESIGHT.color[themeName];
    ctx.fillStyle = BORESIGHT.color[themeName];
    ctx.lineWidth = 1.3 * ratio;
    if (nominalDeg !== null) ray(nominalDeg, [3, 4]);
    ray(angleDeg, []);
    ctx.setLineDash([]);
    ctx.beginPath();
    ctx.arc(px, py, 3.5 * ratio, 0, 2 * Math.PI);
    ctx.fill();
  };
}
