/** Range rate against azimuth of one frame, with the curve of what stands. */
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../../elements/base/define.ts';
import { DopplerAzimuthElement, type MotionCurve } from '../../../../elements/kinds/doppler-azimuth.ts';
import { fixed } from '../../../../plots/format.ts';
import { quantiles } from '../../../../plots/quantiles.ts';
import { methodStyle, TRUTH_STYLE } from '../../../../plots/theme.ts';
import { ElementFrame } from '../../../ui/plot-frame.tsx';
import { loaded } from '../drive/drive.ts';
import { about } from '../motion/ways.ts';
import { shownMethod } from '../results/process.ts';
import { mountingState } from '../state.ts';
import { expectedMotion, type FrameView, sample } from './frame.ts';
import { fileParts, frameKey } from './time-plot.tsx';

defineElement('boresight-doppler-azimuth', DopplerAzimuthElement);

export function DopplerPlot({ view, label }: { view: FrameView; label: string }) {
  const { residual } = mountingState.value;
  const method = shownMethod.value;
  const drive = loaded.value?.drive;
  const sector = useMemo(() => {
    const azimuth = drive?.detections.azimuthDeg;
    const [low, high] = quantiles(
      sample.value.map((k) => azimuth?.[k] ?? Number.NaN),
      0,
      1,
    ) ?? [-60, 60];
    return `${Math.floor((low - 2) / 5) * 5} ${Math.ceil((high + 2) / 5) * 5}`;
  }, [drive, sample.value]);
  const expected = expectedMotion(view);
  const motions = useMemo((): MotionCurve[] => {
    const all = [...view.motions].map(
      ([name, motion]): MotionCurve => ({
        id: name,
        label: `${about(name).title}: ${fixed(Math.hypot(motion.vxMps, motion.vyMps), 2)} m/s`,
        motion,
        style: { ...methodStyle(name), width: name === method ? 2.4 : 1.2 },
        leading: name === method,
      }),
    );
    const label = 'From the car’s speed and yaw rate, with the angle found';
    const style = { color: TRUTH_STYLE.color, width: 1.2, dash: [2, 3] };
    return [...(expected ? [{ id: 'expected', label, motion: expected, style }] : []), ...all];
  }, [view, method, expected?.vxMps, expected?.vyMps]);
  return (
    <ElementFrame
      tag="boresight-doppler-azimuth"
      own={{ frame: view, motions, residual, sector, 'weight-bar': true }}
      title={residual ? 'Range-rate residual against azimuth' : 'Range rate against azimuth'}
      name="doppler-azimuth"
      height="tall"
      keys="Space plays; arrows step by a frame, with Shift by ten."
      onKey={frameKey}
      fileParts={[...fileParts(), `${fixed(view.timeS, 2)}s`]}
      remarks={[
        `${label}. Lines: what stands, −(vx cos a + vy sin a), for the radar’s own motion as each method has it.`,
      ]}
    />
  );
}
