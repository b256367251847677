/** The detections of the shown frame as points, from above and in space. */
import type { Cell, FrameResult } from 'boresight';
import { useMemo } from 'preact/hooks';
import { CloudPlot } from '../../../ui/space/cloud.tsx';
import type { SpacePoint } from '../../../ui/space/points.ts';
import { seesElevation } from '../detections/process.ts';
import type { Loaded } from '../files/files.ts';
import { captureState, update } from '../state.ts';

const keyOf = ({ rangeBin, dopplerBin }: Cell): string => `${rangeBin}:${dopplerBin}`;

export function CapturePoints({
  view,
  capture,
  cell,
  label,
  fileParts,
}: {
  view: FrameResult;
  capture: Loaded;
  cell: Cell;
  label: string;
  fileParts: readonly (string | number)[];
}) {
  const { points: shown, pointColour } = captureState.value;
  const elevated = seesElevation();
  const points = useMemo(
    () =>
      view.detections.map(
        (row): SpacePoint => ({
          xM: row.xM,
          yM: row.yM,
          zM: row.zM,
          rateMps: row.rateMps,
          powerDb: row.powerDb,
          key: keyOf(row),
        }),
      ),
    [view],
  );
  const cloud = useMemo(
    () => ({
      rangeM: view.detections.map(({ rangeM }) => rangeM),
      azimuthDeg: view.detections.map(({ azimuthDeg }) => azimuthDeg),
      elevationDeg: elevated ? view.detections.map(({ elevationDeg }) => elevationDeg) : null,
      rangeRateMps: view.detections.map(({ rateMps }) => rateMps),
    }),
    [view, elevated],
  );
  return (
    <CloudPlot
      title="Point cloud"
      name="points"
      detail={label}
      cloud={cloud}
      points={points}
      of={capture}
      chosen={keyOf(cell)}
      onChoose={(key) => {
        const [rangeBin, dopplerBin] = (key ?? '').split(':').map(Number);
        update({
          cell: rangeBin === undefined || dopplerBin === undefined ? null : { rangeBin, dopplerBin },
        });
      }}
      inSpace={shown === 'space'}
      onSwitch={(inSpace) => update({ points: inSpace ? 'space' : 'above' })}
      by={pointColour}
      level="Power (dBFS)"
      onColour={(by) => update({ pointColour: by })}
      remarks={[
        ...(capture.simulated ? ['Simulated.'] : []),
        elevated
          ? 'The radar is at the origin: x forward, y to the left, z up.'
          : 'This array sees no elevation: all detections are drawn at the radar’s height.',
      ]}
      fileParts={fileParts}
    />
  );
}
