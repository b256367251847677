/** One method's image of the ground around the car. */

import type { MethodInfo } from 'boresight';
import { useMemo } from 'preact/hooks';
import type { PlotElement } from '../../../elements/plot-element.ts';
import { AHEAD, LEFT } from '../../../plots/axes.ts';
import { carOutline } from '../../../plots/car.ts';
import { decibels, fixed, signed } from '../../../plots/format.ts';
import { COLOR_BAR_HEIGHT, colorBarBelow, heatImage } from '../../../plots/heat.ts';
import { faded } from '../../../plots/layers.ts';
import type { PlotContent, View } from '../../../plots/plot.ts';
import { download, fileName, sideBySide, toCsv } from '../../../plots/save.ts';
import { api } from '../../data.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { boardPoints, grid, input, type Point, shownRadars } from './input.ts';
import { fieldsOfView, truth } from './layers.ts';
import { legendItems } from './legend.tsx';
import { frames, images, type MethodImage, working } from './process.ts';
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

function detailOf({ stale, problem, from, measure }: MethodImage): string {
  if (problem) return 'no image';
  const made = stale ? (working.value ? 'computing' : 'not of these settings') : (from ?? '');
  return `${made}${measure ? `, ${decibels(measure.outsideDb)} outside` : ''}`;
}

/** A view's cell at a place. */
function cellAt({ view, radars }: MethodImage, xM: number, yM: number): { levelDb: number; radar: string } | null {
  if (!view) return null;
  const [ahead, across] = view.shape;
  const i = Math.round((xM - (view.xM[0] as number)) / view.cellM);
  const j = Math.round((yM - (view.yM[0] as number)) / view.cellM);
  if (i < 0 || j < 0 || i >= ahead || j >= across) return null;
  const at = i * across + j;
  const radar = radars?.[view.radar[at] as number];
  return radar ? { levelDb: 10 * Math.log10(view.power[at] as number), radar: radar.title } : null;
}

/** What a true point under the cursor belongs to. */
function thingAt(points: readonly Point[], xM: number, yM: number): string {
  let best: Point | null = null;
  let nearest = 0.7;
  for (const point of points) {
    const distance = Math.hypot(point.xM - xM, point.yM - yM);
    if (distance < nearest) [best, nearest] = [point, distance];
  }
  return best ? `  ${(best.kind ?? 'board’s object').replace('-', ' ')}` : '';
}

/** The plots' horizontal axis is the car's y, their vertical one its x. */
const turned = (view: View | null): View | null => view && { x: view.y, y: view.x };

export function ImagePlot({ info, image }: { info: MethodInfo; image: MethodImage }) {
  const { span, top, colors, opacity, truth: truthShown, fields } = birdseyeState.value;
  const looked = input.value;
  const limits = colorLimits(Number(span), top);
  const heat = useMemo(
    () =>
      image.view && image.levelsDb
        ? heatImage({ x: image.view.yM.slice().reverse(), y: image.view.xM, values: image.levelsDb, limits, colors })
        : () => {},
    [image.view, limits[0], limits[1], colors],
  );
  const points = useMemo(
    () => (looked?.street ? [...new Set(frames.value.flatMap(({ visible }) => visible ?? []))] : boardPoints.value),
    [frames.value, boardPoints.value, looked],
  );
  const { xM, yM } = grid.value;
  const view = useMemo(() => turned(zoom.value), [zoom.value]);
  const content = useMemo(
    (): PlotContent => ({
      x: [],
      series: [],
      extent: { x: yM, y: xM },
      below: [faded(heat, opacity / 100)],
      above: [
        ...(looked?.street ? [carOutline()] : []),
        ...(fields
          ? [
              fieldsOfView(
                shownRadars.value.map((radar) => ({ radar, rangeM: api.waveformSummary(radar.waveform).maxRangeM })),
              ),
            ]
          : []),
        ...(truthShown ? [truth(looked?.street ?? null, points)] : []),
        colorBarBelow(limits, colors, 'dBFS'),
      ],
    }),
    [heat, opacity, truthShown, fields, points, shownRadars.value, grid.value],
  );
  return (
    <PlotFrame
      title={info.title}
      detail={detailOf(image)}
      name={`image-${info.name}`}
      height="portrait"
      content={content}
      view={view}
      legendElsewhere
      legend={legendItems()}
      axes={{ x: LEFT, y: AHEAD, bottom: COLOR_BAR_HEIGHT, equal: true, navigate: true, grid: false, minZoom: 0.01 }}
      cursorKey="birdseye"
      onView={(next, zoomed) => {
        zoom.value = zoomed ? turned(next) : null;
      }}
      readout={({ x: yM, y: xM }) => {
        const cell = cellAt(image, xM, yM);
        return `x ${signed(xM, 1)} m  y ${signed(yM, 1)} m  ${cell ? `${Number.isFinite(cell.levelDb) ? `${fixed(cell.levelDb, 1)}\u00a0dBFS` : 'nothing'}  ${cell.radar.toLowerCase()}` : 'not seen'}${truthShown ? thingAt(points, xM, yM) : ''}`;
      }}
      csv={() =>
        toCsv(
          ['x_m', 'y_m', 'power_dbfs', 'radar'],
          (function* rows() {
            const { view, radars } = image;
            if (!view) return;
            const [ahead, across] = view.shape;
            for (let i = 0; i < ahead; i++) {
              for (let j = 0; j < across; j++) {
                const at = i * across + j;
                const levelDb = 10 * Math.log10(view.power[at] as number);
                if (view.seen[at])
                  yield [
                    view.xM[i]?.toFixed(3),
                    view.yM[j]?.toFixed(3),
                    Number.isFinite(levelDb) ? levelDb.toFixed(2) : '',
                    radars?.[view.radar[at] as number]?.name,
                  ];
              }
            }
          })(),
        )
      }
      fileParts={fileParts()}
      attach={(element) => {
        shown.set(info.name, element);
        return () => shown.delete(info.name);
      }}
    />
  );
}
