/** The frame from above, in the car's frame, with the angle applied. */
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../../elements/base/define.ts';
import type { Ground } from '../../../../elements/kinds/birds-eye.ts';
import { PointCloudElement } from '../../../../elements/kinds/point-cloud.ts';
import { inCar } from '../../../../plots/car.ts';
import { fixed } from '../../../../plots/format.ts';
import { quantiles } from '../../../../plots/quantiles.ts';
import { ElementFrame } from '../../../ui/plot-frame.tsx';
import { loaded } from '../drive/drive.ts';
import { where } from '../results/process.ts';
import { type FrameView, sample, usedAngleDeg } from './frame.ts';
import { fileParts, frameKey } from './time-plot.tsx';

defineElement('boresight-point-cloud', PointCloudElement);

export function BirdPlot({ view, label }: { view: FrameView; label: string }) {
  const drive = loaded.value?.drive;
  const at = where.value;
  const angleDeg = usedAngleDeg.value;
  const [xM, yM] = [at?.xM ?? 0, at?.yM ?? 0];
  const mounting = useMemo(() => ({ xM, yM, yawDeg: angleDeg }), [xM, yM, angleDeg]);
  // Of the whole drive, so that playing does not shake it.
  const extent = useMemo((): Ground => {
    const ranges = drive?.detections.rangeM;
    const azimuths = drive?.detections.azimuthDeg;
    const place = { xM, yM, yawDeg: at?.nominalDeg ?? angleDeg };
    const places = sample.value.map((k) => inCar(place, ranges?.[k] ?? Number.NaN, azimuths?.[k] ?? Number.NaN));
    const along = (axis: 0 | 1): [number, number] => {
      const [low, high] = quantiles(
        places.map((one) => one[axis]),
        0.02,
        0.95,
      ) ?? [-20, 20];
      return [Math.min(low, -3) - 2, Math.max(high, 6) + 2];
    };
    return { xM: along(0), yM: along(1) };
  }, [drive, sample.value, at?.nominalDeg]);
  const without = !view.rangeM || quantiles(view.rangeM, 0, 1) === null;
  return (
    <ElementFrame
      tag="boresight-point-cloud"
      own={{
        points: view,
        mounting,
        extent,
        boresight: true,
        'nominal-deg': at?.nominalDeg ?? undefined,
        'drag-zooms': true,
      }}
      title="From above, in the car’s frame"
      name="birds-eye"
      height="tall"
      keys="Space plays; arrows step by a frame, with Shift by ten."
      onKey={frameKey}
      fileParts={[...fileParts(), `${fixed(view.timeS, 2)}s`]}
      remarks={[
        without && view.azimuthDeg.length
          ? 'This drive has no ranges, so its detections have no place.'
          : `${label}. The radar is turned by the angle found. The car’s outline is a typical one.`,
      ]}
    />
  );
}
