/** Radar plots as custom elements. Importing this defines them all. */

import { defineElement } from './base/define.ts';
import { BirdsEyeElement } from './kinds/birds-eye.ts';
import { BoardElement } from './kinds/board.ts';
import { CaptureElement } from './kinds/capture.ts';
import { DopplerAzimuthElement } from './kinds/doppler-azimuth.ts';
import { DriveElement } from './kinds/drive.ts';
import { MountingAngleElement } from './kinds/mounting-angle.ts';
import { OwnPlotElement } from './kinds/plot.ts';
import { PointCloudElement } from './kinds/point-cloud.ts';
import { RangeDopplerElement } from './kinds/range-doppler.ts';
import { SpectrumElement } from './kinds/spectrum.ts';

export type { Layer, LayerContext } from '../plots/layers.ts';
export type { Axes, AxisOptions, CursorPosition, PlotContent, PlotSeries, View } from '../plots/types.ts';
export type { Drawing, LegendItem, MovablePoints } from './base/drawing.ts';
export type { NamedBytes } from './intake.ts';
export type { Ground, RadarName } from './kinds/birds-eye.ts';
export type { DopplerFrame, MotionCurve } from './kinds/doppler-azimuth.ts';
export type { Alarm, AngleOverTime } from './kinds/mounting-angle.ts';
export type { OwnDrawing } from './kinds/plot.ts';
export type { Place, PointCloud } from './kinds/point-cloud.ts';
export type { RangeDopplerFrame } from './kinds/range-doppler.ts';
export type { NamedEstimate, ShownTarget } from './kinds/spectrum.ts';
export { usePool } from './pool.ts';
export {
  BirdsEyeElement,
  BoardElement,
  CaptureElement,
  DopplerAzimuthElement,
  DriveElement,
  MountingAngleElement,
  OwnPlotElement,
  PointCloudElement,
  RangeDopplerElement,
  SpectrumElement,
};

/** The elements by the names they are defined under. */
export const elements = {
  'boresight-birds-eye': BirdsEyeElement,
  'boresight-board': BoardElement,
  'boresight-capture': CaptureElement,
  'boresight-doppler-azimuth': DopplerAzimuthElement,
  'boresight-drive': DriveElement,
  'boresight-mounting-angle': MountingAngleElement,
  'boresight-plot': OwnPlotElement,
  'boresight-point-cloud': PointCloudElement,
  'boresight-range-doppler': RangeDopplerElement,
  'boresight-spectrum': SpectrumElement,
} as const;

/** The elements as the JSX types of a framework take them: properties of their classes, and any attributes. */
export type JsxElements = {
  [Name in keyof typeof elements]: Partial<Omit<InstanceType<(typeof elements)[Name]>, keyof HTMLElement>> & {
    [attribute: string]: unknown;
  };
};

/** Defines the elements that are not defined yet: a cell of a notebook may run twice. Does nothing on a server. */
export function define(): void {
  for (const [name, made] of Object.entries(elements)) defineElement(name, made);
}

define();

declare global {
  interface HTMLElementTagNameMap {
    'boresight-birds-eye': BirdsEyeElement;
    'boresight-board': BoardElement;
    'boresight-capture': CaptureElement;
    'boresight-doppler-azimuth': DopplerAzimuthElement;
    'boresight-drive': DriveElement;
    'boresight-mounting-angle': MountingAngleElement;
    'boresight-plot': OwnPlotElement;
    'boresight-point-cloud': PointCloudElement;
    'boresight-range-doppler': RangeDopplerElement;
    'boresight-spectrum': SpectrumElement;
  }
}
