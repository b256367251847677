/** Detections of a scan around the car, from above. */
import { defineElement } from '../../elements/base/define.ts';
import { PointCloudElement } from '../../elements/kinds/point-cloud.ts';
import type { Panel } from '../panel.ts';
import { placeSettings, signSettings, topicSettings } from '../radar-settings.ts';
import { choiceSetting, maybeNumber } from '../settings.ts';
import { viewOfLatest } from './latest.ts';

const settings = {
  ...topicSettings,
  ...placeSettings,
  ...signSettings,
  rangeM: maybeNumber(
    {
      group: 'Display',
      label: 'Range (m)',
      help: 'How far the plot shows; as far as there were detections if not given.',
    },
    { min: 1, max: 1000, step: 10 },
  ),
  weighed: choiceSetting(
    { group: 'Display', label: 'Colours', help: 'What stands is found from the range rates of the scan.' },
    { standing: 'what stands and what moves', none: 'all alike' },
  ),
};

export const birdsEyePanel: Panel<typeof settings> = {
  name: 'Detections from above',
  settings,
  make() {
    defineElement('boresight-point-cloud', PointCloudElement);
    const element = document.createElement('boresight-point-cloud') as PointCloudElement;
    element.toggleAttribute('boresight', true);
    return viewOfLatest<typeof settings>(
      element,
      ({ rangeM }) => {
        if (rangeM === null) element.removeAttribute('range');
        else element.setAttribute('range', String(rangeM));
      },
      (latest, values) => {
        const { nominalDeg, weighed } = values;
        element.mounting = { ...(latest.place(values) ?? { xM: 0, yM: 0 }), yawDeg: nominalDeg ?? 0 };
        if (!latest.scan) {
          element.points = null;
          return;
        }
        const { scan, outcome } = latest.scan;
        const weights = weighed === 'standing' && outcome?.motion ? outcome.weights : null;
        const { rangeM, azimuthDeg, rangeRateMps, rcsDbsm } = scan;
        element.points = { rangeM, azimuthDeg, rangeRateMps, rcsDbsm, weights };
      },
    );
  },
};
