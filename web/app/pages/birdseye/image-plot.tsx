/** One method's image of the ground around the car. */

import type { MethodInfo } from 'boresight';
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../elements/base/define.ts';
import type { PlotElement } from '../../../elements/base/plot-element.ts';
import { BirdsEyeElement } from '../../../elements/kinds/birds-eye.ts';
import { decibels } from '../../../plots/format.ts';
import { download, fileName, sideBySide } from '../../../plots/save.ts';
import type { View } from '../../../plots/types.ts';
import { api } from '../../data.ts';
import { ElementFrame } from '../../ui/plot-frame.tsx';
import { boardPoints, grid, input, type Point, shownRadars } from './input.ts';
import { fieldsOfView, truth } from './layers.ts';
import { legendItems } from './legend.tsx';
import { frames, images, isPending, type MethodImage, working } from './process.ts';
import { birdseyeState, zoom } from './state.ts';

/**
 * Powers of the first and last colour: the same in all images, so that they compare. No target is stronger than the
 * strongest cell; where a method says so, two of its directions cancel each other.
 */
function colorLimits(span: number, top: number | null): [number, number] {
  const cell = Math.max(...frames.value.map(({ cells }) => cells.powerDb[0] ?? Number.NEGATIVE_INFINITY));
  const peak = Math.max(
    ...[...images.value.values()].map(({ peakDb = Number.NEGATIVE_INFINITY }) => Math.min(peakDb, cell)),
  );
  const high = top ?? (Number.isFinite(peak) ? Math.ceil(peak) : 0);
  return [high - span, high];
}

defineElement('boresight-birds-eye', BirdsEyeElement);

/** The images that are shown, for one picture of all of them. */
const shown = new Map<string, PlotElement>();

/** All images as one. */
export async function saveAll(): Promise<void> {
  const all = api.methods().flatMap(({ name }) => shown.get(name)?.picture() ?? []);
  if (all.length) download(await sideBySide(await Promise.all(all)), fileName(['birdseye', ...fileParts()], 'png'));
}

function fileParts(): (string | number)[] {
  const { source, seed, frame, from } = birdseyeState.peek();
  return source === 'street' ? ['street', `seed${seed}`, from] : ['capture', `frame${frame + 1}`, from];
}

function detailOf(image: MethodImage): string {
  const { problem, from, measure } = image;
  if (isPending(image) && working.value) return 'computing';
  if (problem || isPending(image)) return 'no image';
  return `${from ?? ''}${measure ? `, ${decibels(measure.outsideDb)} outside` : ''}`;
}

/** What a true point under the cursor belongs to. */
function thingAt(points: readonly Point[], xM: number, yM: number): string {
  let best: Point | null = null;
  let nearest = 0.7;
  for (const point of points) {
    const distance = Math.hypot(point.xM - xM, point.yM - yM);
    if (distance < nearest) [best, nearest] = [point, distance];
  }
  return best ? `${(best.kind ?? 'board’s object').replace('-', ' ')}` : '';
}

/** The plots' horizontal axis is the car's y, their vertical one its x. */
const turned = (view: View | null): View | null => view && { x: view.y, y: view.x };

export function ImagePlot({ info, image }: { info: MethodInfo; image: MethodImage }) {
  const { span, top, colors, opacity, truth: truthShown, fields } = birdseyeState.value;
  const looked = input.value;
  const limits = colorLimits(Number(span), top);
  const points = useMemo(
    () => (looked?.street ? [...new Set(frames.value.flatMap(({ visible }) => visible ?? []))] : boardPoints.value),
    [frames.value, boardPoints.value, looked],
  );
  const view = useMemo(() => turned(zoom.value), [zoom.value]);
  const overlays = useMemo(
    () => [
      ...(fields
        ? [
            fieldsOfView(
              shownRadars.value.map((radar) => ({ radar, rangeM: api.waveformSummary(radar.waveform).maxRangeM })),
            ),
          ]
        : []),
      ...(truthShown ? [truth(looked?.street ?? null, points)] : []),
    ],
    [truthShown, fields, points, shownRadars.value],
  );
  const about = useMemo(
    () => (truthShown ? (xM: number, yM: number) => thingAt(points, xM, yM) : null),
    [truthShown, points],
  );
  const signs = useMemo(legendItems, [birdseyeState.value]);
  return (
    <ElementFrame
      tag="boresight-birds-eye"
      own={{
        view: image.view,
        extent: grid.value,
        radars: image.radars,
        overlays,
        signs,
        about,
        bar: 'below',
        colors,
        'low-db': limits[0],
        'high-db': limits[1],
        opacity: opacity / 100,
        unit: 'dBFS',
        'without-car': !looked?.street,
      }}
      title={info.title}
      detail={detailOf(image)}
      name={`image-${info.name}`}
      height="portrait"
      listed="image"
      view={view}
      cursorKey="birdseye"
      onView={(next, zoomed) => {
        zoom.value = zoomed ? turned(next) : null;
      }}
      fileParts={fileParts()}
      attach={(element) => {
        shown.set(info.name, element);
        return () => shown.delete(info.name);
      }}
    />
  );
}
