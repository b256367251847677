/** Range rates of a scan over azimuth, with the curve of what stands. */
import { defineElement } from '../../elements/base/define.ts';
import { DopplerAzimuthElement, type MotionCurve } from '../../elements/kinds/doppler-azimuth.ts';
import { carriedMotion } from '../../plots/doppler.ts';
import { methodStyle } from '../../plots/theme.ts';
import type { Panel } from '../panel.ts';
import { placeSettings, signSettings, topicSettings } from '../radar-settings.ts';
import { choiceSetting, numberSetting } from '../settings.ts';
import { type LatestScan, viewOfLatest } from './latest.ts';

const settings = {
  ...topicSettings,
  ...placeSettings,
  ...signSettings,
  shown: choiceSetting(
    { group: 'Display', label: 'Shows', help: 'Residuals show small deviations from what stands.' },
    { rates: 'range rates', residuals: 'residuals to what stands' },
  ),
  sectorDeg: numberSetting({ group: 'Display', label: 'To each side (°)', help: 'How far the plot shows.' }, 90, {
    min: 5,
    max: 180,
    step: 5,
  }),
};

export const dopplerPanel: Panel<typeof settings> = {
  name: 'Doppler over azimuth',
  settings,
  make() {
    defineElement('boresight-doppler-azimuth', DopplerAzimuthElement);
    const element = document.createElement('boresight-doppler-azimuth') as DopplerAzimuthElement;
    return viewOfLatest<typeof settings>(
      element,
      ({ shown, sectorDeg }) => {
        element.toggleAttribute('residual', shown === 'residuals');
        element.setAttribute('sector', String(sectorDeg));
      },
      (latest, values) => {
        const { scan } = latest;
        if (!scan) {
          element.frame = element.motions = null;
          return;
        }
        const { azimuthDeg, rangeRateMps, rangeM, rcsDbsm } = scan.scan;
        const curves = curvesOf(scan, latest.place(values), values.nominalDeg);
        const motion = curves[0]?.motion ?? null;
        element.frame = { azimuthDeg, rangeRateMps, rangeM, rcsDbsm, motion, weights: scan.outcome?.weights ?? null };
        element.motions = curves;
      },
    );
  },
};

/** What stands as the scan itself has it, and as the car's motion and the radar's nominal angle have it. */
function curvesOf(
  { outcome, motion }: LatestScan,
  place: { xM: number; yM: number } | null,
  nominalDeg: number | null,
): MotionCurve[] {
  const curves: MotionCurve[] = [];
  if (outcome?.motion) {
    const [vxMps, vyMps] = outcome.motion.velocityMps;
    const style = methodStyle('recursive');
    curves.push({ id: 'scan', label: 'What stands, by the scan', motion: { vxMps, vyMps }, style, leading: true });
  }
  if (motion && Number.isFinite(motion.speedMps) && place && nominalDeg !== null) {
    const carried = carriedMotion({ ...place, yawDeg: nominalDeg }, motion.speedMps, motion.yawRateDegps);
    curves.push({
      id: 'car',
      label: 'By the car and the nominal angle',
      motion: carried,
      style: methodStyle('weighted-mean'),
    });
  }
  return curves;
}
