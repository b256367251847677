/** Axes that several plots have. What is left of the radar or the car stands at the left of every plot. */
import type { AxisOptions } from './plot.ts';

export const AZIMUTH: AxisOptions = {
  label: 'Azimuth (°), positive to the left of boresight',
  steps: [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 45, 60, 90],
  descending: true,
};

/** Of places in the car's frame, m. */
export const AHEAD: AxisOptions = { label: 'x, ahead (m)' };
export const LEFT: AxisOptions = { label: 'y, left (m)', descending: true };
