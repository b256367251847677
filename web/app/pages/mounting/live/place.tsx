/** Where the radar of a live server is. */
import { Control } from '../control.ts';
import { short } from '../controls.tsx';
import { livePlace } from './live.ts';

export function Place() {
  const { xM, yM, nominalDeg } = livePlace.value;
  return (
    <>
      <Control
        label="Ahead of rear axle"
        name="xM"
        value={short(xM)}
        step={0.01}
        note="Empty for what the server’s transforms say. The calibration begins anew where it changes."
      />
      <Control
        label="Left of centre line"
        name="yM"
        value={short(yM)}
        step={0.01}
        note="Negative to the right. Empty for what the server’s transforms say."
      />
      <Control
        label="Nominal angle"
        name="nominal"
        value={short(nominalDeg)}
        step={0.1}
        note="Positive to the left. Empty for what boresight.MountingAngle says, if the server has it."
      />
    </>
  );
}
