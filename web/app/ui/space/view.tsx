/** The 3-D view of a point cloud: a panel that loads three.js when it is opened, and says so where there is no WebGL. */
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useMemo, useRef } from 'preact/hooks';
import { fixed } from '../../../plots/format.ts';
import { png } from '../../../plots/picture.ts';
import { download, fileName } from '../../../plots/save.ts';
import { THEMES } from '../../../plots/theme.ts';
import { theme } from '../../state/theme.ts';
import { captionLines } from '../caption.ts';
import {
  COLOURED_BY,
  type ColouredBy,
  type ColourScale,
  cloudWords,
  colourAt,
  colourNames,
  colourScale,
  pointWords,
  type SpaceExtent,
  type SpacePoint,
  stepped,
  widened,
} from './points.ts';
import type { SpaceContent, SpaceScene } from './scene.ts';

/** What opening the view fetches, once: a test holds it to what is built. */
export const SPACE_KILOBYTES = 115;

interface Props {
  title: string;
  /** For file names and tests. */
  name: string;
  detail: string;
  points: readonly SpacePoint[];
  /** What the extent belongs to: it only grows until this changes. */
  of: unknown;
  /** Key of the chosen points. */
  chosen: string | null;
  onChoose(key: string | null): void;
  by: ColouredBy;
  /** What the level of points is, with its unit. */
  level: string;
  onColour(by: ColouredBy): void;
  /** The button back to the view from above. */
  switcher: ComponentChildren;
  fileParts?: readonly (string | number)[];
  remarks: readonly string[];
}

type State = 'loading' | 'ready' | 'lost' | 'no-webgl' | 'failed';

export function SpaceView(props: Props) {
  const { title, name, detail, points, chosen, by, level, remarks } = props;
  const names = colourNames(level);
  const host = useRef<HTMLDivElement>(null);
  const scene = useRef<SpaceScene | null>(null);
  const state = useSignal<State>('loading');
  const pointed = useSignal<number | null>(null);
  const attempt = useSignal(0);
  const extent = useRef<{ of: unknown; extent: SpaceExtent | null }>({ of: props.of, extent: null });
  const scale = useMemo(() => colourScale(points, by), [points, by]);
  const content = useMemo((): SpaceContent => {
    const before = extent.current.of === props.of ? extent.current.extent : null;
    extent.current = { of: props.of, extent: widened(points, before) };
    const shown = extent.current.extent as SpaceExtent;
    return { points, extent: shown, scale, chosen, theme: theme.value, palette: THEMES[theme.value] };
  }, [points, props.of, scale, chosen, theme.value]);
  // Listeners of the scene live longer than a rendering.
  const latest = useRef({ props, content });
  latest.current = { props, content };

  useEffect(() => {
    const place = host.current;
    if (!place) return undefined;
    let gone = false;
    state.value = 'loading';
    const canvas = document.createElement('canvas');
    canvas.setAttribute('aria-hidden', 'true');
    const context = canvas.getContext('webgl2', { antialias: true, alpha: true });
    if (!context) {
      state.value = 'no-webgl';
      return undefined;
    }
    const choose = (index: number | null): void => {
      const { props: now } = latest.current;
      now.onChoose(index === null ? null : (now.points[index]?.key ?? null));
    };
    import('./scene.ts').then(
      ({ SpaceScene: Made }) => {
        if (gone) return;
        scene.current = new Made(place, canvas, context, {
          point: (index) => (pointed.value = index),
          choose,
          lost: (lost) => (state.value = lost ? 'lost' : 'ready'),
        });
        scene.current.set(latest.current.content);
        state.value = 'ready';
      },
      () => {
        if (!gone) state.value = 'failed';
      },
    );
    return () => {
      gone = true;
      scene.current?.close();
      scene.current = null;
      // One that never came to be drawn on holds memory of the graphics card all the same.
      context.getExtension('WEBGL_lose_context')?.loseContext();
    };
  }, [attempt.value]);
  useEffect(() => scene.current?.set(content), [content]);
  useEffect(() => {
    pointed.value = null;
  }, [points]);

  const at = pointed.value ?? points.findIndex(({ key }) => key === chosen);
  const point = points[at];
  const ready = state.value === 'ready';
  const save = async (): Promise<void> => {
    if (!scene.current) return;
    const { palette, theme: name } = content;
    const view = scene.current;
    const pictured = {
      ratio: view.ratio,
      theme: name,
      palette,
      sizeAt: (times: number) => view.sizeAt(times),
      drawAgain: (times: number) => view.drawAgain(times),
    };
    const [low, high] = scale.limits;
    const colours = `Colour: ${names[by]}, from ${fixed(low, 1)} to ${fixed(high, 1)}.`;
    const caption = captionLines([cloudWords(points), colours, ...remarks]);
    download(
      await png(pictured, { heading: `${title}, ${detail}`, legend: [], caption }),
      fileName([props.name, '3d', ...(props.fileParts ?? [])], 'png'),
    );
  };
  return (
    <section class="panel space" aria-label={`${title} in 3-D`} data-space={name} data-state={state.value}>
      <div class="panel-head">
        <h3>{title}</h3>
        <span class="muted">{detail}</span>
        {props.switcher}
        <label class="row">
          <span class="muted">Colour</span>
          <select
            name={`${name}-colour`}
            value={by}
            onChange={(event) => props.onColour(event.currentTarget.value as ColouredBy)}
          >
            {COLOURED_BY.map((one) => (
              <option key={one} value={one}>
                {names[one]}
              </option>
            ))}
          </select>
        </label>
        <div class="tools" role="group" aria-label={`${title} in 3-D: tools`}>
          <button type="button" aria-label="Zoom in" title="Zoom in (+)" onClick={() => scene.current?.zoom(0.8)}>
            +
          </button>
          <button type="button" aria-label="Zoom out" title="Zoom out (−)" onClick={() => scene.current?.zoom(1.25)}>
            −
          </button>
          <button type="button" title="Show everything again (Home)" onClick={() => scene.current?.reset()}>
            Reset
          </button>
          <button
            type="button"
            data-export="png"
            disabled={!ready}
            title="Save the view as an image, at twice the screen’s resolution"
            onClick={() => void save()}
          >
            PNG
          </button>
        </div>
      </div>
      <p class="space-readout" data-readout>
        {point ? pointWords(point) : 'Point at a detection'}
      </p>
      <div
        class="space-host"
        tabIndex={0}
        role="application"
        aria-roledescription="3-D view"
        aria-label={`${title}. Arrows turn the view, plus and minus zoom, Home shows everything again. N and P choose the next and the previous detection, Escape none.`}
        aria-describedby={`${name}-words`}
        onKeyDown={(event) => {
          if (pressed(event, scene.current, props)) event.preventDefault();
        }}
      >
        <div class="space-canvas" ref={host} />
        {!ready && <Message state={state.value} again={() => (attempt.value += 1)} />}
      </div>
      <ColourBar scale={scale} name={names[by]} />
      <p class="remark">
        {remarks.join(' ')} Drag to turn, with the right button to move, wheel or pinch to zoom. A detection that is
        tapped is chosen in the table too.
      </p>
      <p class="visually-hidden" id={`${name}-words`}>
        {cloudWords(points)} The table lists them all.
      </p>
      <p class="visually-hidden" role="status">
        {chosen !== null && point?.key === chosen ? pointWords(point) : ''}
      </p>
    </section>
  );
}

function pressed(event: KeyboardEvent, scene: SpaceScene | null, props: Props): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  const times = event.shiftKey ? 3 : 1;
  const step = (by: 1 | -1) => props.onChoose(stepped(props.points, props.chosen, by));
  const actions: Record<string, () => void> = {
    ArrowLeft: () => scene?.turn(times, 0),
    ArrowRight: () => scene?.turn(-times, 0),
    ArrowUp: () => scene?.turn(0, times),
    ArrowDown: () => scene?.turn(0, -times),
    '+': () => scene?.zoom(0.8),
    '=': () => scene?.zoom(0.8),
    '-': () => scene?.zoom(1.25),
    '0': () => scene?.reset(),
    Home: () => scene?.reset(),
    n: () => step(1),
    p: () => step(-1),
    Escape: () => props.onChoose(null),
  };
  const act = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  act?.();
  return act !== undefined;
}

/** Why there is nothing to see. */
function Message({ state, again }: { state: State; again(): void }) {
  if (state === 'loading') {
    return (
      <p class="space-message" role="status">
        Loading the 3-D view, {SPACE_KILOBYTES} KB
      </p>
    );
  }
  const words = {
    'no-webgl':
      'This browser gives no WebGL 2, which the 3-D view is drawn by: it may be turned off in the settings, or the graphics driver is not trusted. The view from above shows the same detections.',
    lost: 'The browser took the graphics memory away, as it does when there is little of it. The view comes back by itself as soon as it may.',
    failed: 'The 3-D view could not be loaded. The view from above shows the same detections.',
    ready: '',
  }[state];
  return (
    <p class="space-message alert" role="alert" data-space-problem={state}>
      {words}{' '}
      {state !== 'no-webgl' && (
        <button type="button" data-action="space-again" onClick={again}>
          Try again
        </button>
      )}
    </p>
  );
}

/** What the colours mean. */
function ColourBar({ scale, name }: { scale: ColourScale; name: string }) {
  const { by, limits } = scale;
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const ctx = canvas.current?.getContext('2d');
    if (!ctx) return;
    for (let i = 0; i < 128; i++) {
      ctx.fillStyle = `rgb(${colourAt(by, i / 127, theme.value).join(', ')})`;
      ctx.fillRect(i, 0, 1, 10);
    }
  }, [by, theme.value]);
  const words = by === 'rate' ? ['approaching', 'receding'] : ['', ''];
  return (
    <div class="space-legend" data-legend={by}>
      <span class="muted">{name}</span>
      <span>
        {fixed(limits[0], 1)} {words[0]}
      </span>
      <canvas ref={canvas} width={128} height={10} />
      <span>
        {fixed(limits[1], 1)} {words[1]}
      </span>
    </div>
  );
}
