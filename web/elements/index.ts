/** Radar plots as custom elements. Importing this defines them all. */
import { BirdsEyeElement } from './birds-eye.ts';
import { BoardElement } from './board.ts';
import { CaptureElement } from './capture.ts';
import { defineElement } from './define.ts';
import { DopplerAzimuthElement } from './doppler-azimuth.ts';
import { DriveElement } from './drive.ts';
import { MountingAngleElement } from './mounting-angle.ts';
import { OwnPlotElement } from './plot.ts';
import { PointCloudElement } from './point-cloud.ts';
import { RangeDopplerElement } from './range-doppler.ts';
import { SpectrumElement } from './spectrum.ts';

export type { Layer, LayerContext } from '../plots/layers.ts';
export type { Axes, AxisOptions, CursorPosition, PlotContent, PlotSeries, View } from '../plots/types.ts';
export type { Ground, RadarName } from './birds-eye.ts';
export type { DopplerFrame, MotionCurve } from './doppler-azimuth.ts';
export type { Drawing, LegendItem, MovablePoints } from './drawing.ts';
export type { NamedBytes } from './intake.ts';
export type { Alarm, AngleOverTime } from './mounting-angle.ts';
export type { OwnDrawing } from './plot.ts';
export type { Place, PointCloud } from './point-cloud.ts';
export { usePool } from './pool.ts';
export type { RangeDopplerFrame } from './range-doppler.ts';
export type { NamedEstimate, ShownTarget } from './spectrum.ts';
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
