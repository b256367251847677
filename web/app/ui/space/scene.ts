/** Points in space by three.js, which comes with this file alone. x is forward, y left, z up, in metres, as everywhere. */
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  LineBasicMaterial,
  LineSegments,
  PerspectiveCamera,
  Points,
  Scene,
  ShaderMaterial,
  Spherical,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { PlotTheme, ThemeName } from '../../../plots/theme.ts';
import { type ColourScale, gridStep, pointColour, type SpaceExtent, type SpacePoint, ticks } from './points.ts';

/** What is to be seen. */
export interface SpaceContent {
  points: readonly SpacePoint[];
  extent: SpaceExtent;
  scale: ColourScale;
  chosen: string | null;
  theme: ThemeName;
  palette: PlotTheme;
}

const POINT_PX = 9;
const CHOSEN_PX = 17;
/** How near to a point one has to be to point at it, px. */
const REACH_PX = 16;
/** Turn of a key, rad. */
const TURN = Math.PI / 36;
/** A finger or a mouse that moved less has tapped, px. */
const TAP_PX = 5;

const VERTEX = `
attribute float size;
attribute vec3 colour;
varying vec3 vColour;
varying float vSize;
void main() {
  vColour = colour;
  vSize = size;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = size;
}`;
/** A disc with a rim; that of a chosen point is wide, and its disc has a gap around it. */
const FRAGMENT = `
uniform vec3 rim;
uniform vec3 ring;
uniform float wide;
varying vec3 vColour;
varying float vSize;
void main() {
  float whole = 0.5 * vSize;
  float r = length(gl_PointCoord - 0.5) * vSize;
  if (r > whole) discard;
  bool chosen = vSize >= wide;
  vec3 colour = vColour;
  if (chosen && r > 0.72 * whole) colour = ring;
  else if (r > (chosen ? 0.52 : 0.76) * whole) colour = rim;
  gl_FragColor = vec4(colour, 1.0);
  #include <colorspace_fragment>
}`;

/** What the scene tells. */
export interface SpaceEvents {
  /** The point that is pointed at, or none. */
  point(index: number | null): void;
  /** The point that was chosen, or none where a tap hit none. */
  choose(index: number | null): void;
  /** The browser took the graphics away, or gave them back. */
  lost(lost: boolean): void;
}

export class SpaceScene {
  readonly canvas: HTMLCanvasElement;
  readonly #host: HTMLElement;
  readonly #labels = document.createElement('canvas');
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(42, 1, 0.02, 5000);
  readonly #controls: OrbitControls;
  readonly #cloud: Points<BufferGeometry, ShaderMaterial>;
  readonly #stems: LineSegments<BufferGeometry, LineBasicMaterial>;
  readonly #grid: LineSegments<BufferGeometry, LineBasicMaterial>;
  readonly #axes: LineSegments<BufferGeometry, LineBasicMaterial>;
  readonly #sizes: ResizeObserver;
  readonly #events: SpaceEvents;
  readonly #stop = new AbortController();
  #content: SpaceContent | null = null;
  #extentKey = '';
  #request = 0;
  #ratio = 1;
  #down: { x: number; y: number } | null = null;

  /** `context` is WebGL 2 of `canvas`. */
  constructor(host: HTMLElement, canvas: HTMLCanvasElement, context: WebGL2RenderingContext, events: SpaceEvents) {
    this.#host = host;
    this.canvas = canvas;
    this.#events = events;
    this.#labels.className = 'space-labels';
    this.#labels.setAttribute('aria-hidden', 'true');
    host.append(canvas, this.#labels);
    this.#renderer = new WebGLRenderer({ canvas, context, antialias: true });
    this.#camera.up.set(0, 0, 1);
    this.#cloud = new Points(
      new BufferGeometry(),
      new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: { rim: { value: new Color() }, ring: { value: new Color() }, wide: { value: CHOSEN_PX } },
      }),
    );
    this.#stems = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.55 }));
    this.#grid = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    this.#axes = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
    for (const part of [this.#grid, this.#axes, this.#stems, this.#cloud]) {
      part.frustumCulled = false;
      this.#scene.add(part);
    }
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.maxPolarAngle = Math.PI;
    this.#controls.addEventListener('change', this.#soon);
    this.#sizes = new ResizeObserver(() => this.#resize());
    this.#sizes.observe(host);
    const { signal } = this.#stop;
    canvas.addEventListener('pointerdown', ({ clientX: x, clientY: y }) => (this.#down = { x, y }), { signal });
    canvas.addEventListener('pointerup', this.#up, { signal });
    canvas.addEventListener('pointermove', this.#move, { signal });
    canvas.addEventListener('pointerleave', () => events.point(null), { signal });
    canvas.addEventListener(
      'webglcontextlost',
      (event) => {
        event.preventDefault();
        events.lost(true);
      },
      { signal },
    );
    canvas.addEventListener(
      'webglcontextrestored',
      () => {
        events.lost(false);
        this.#soon();
      },
      { signal },
    );
    this.#resize();
  }

  set(content: SpaceContent): void {
    const before = this.#content;
    this.#content = content;
    const { extent, palette, theme } = content;
    const key = JSON.stringify([extent, palette, theme]);
    if (key !== this.#extentKey) {
      this.#extentKey = key;
      this.#surround(content);
    }
    if (before?.points !== content.points || before.scale !== content.scale || before.theme !== theme) this.#place();
    this.#mark();
    if (!before) this.reset();
    this.#soon();
  }

  /** Turns by shares of a key's turn: to the left, and up. */
  turn(left: number, up: number): void {
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const spherical = toSpherical(offset);
    spherical.theta -= left * TURN;
    spherical.phi -= up * TURN;
    spherical.makeSafe();
    this.#camera.position.copy(fromSpherical(spherical)).add(this.#controls.target);
    this.#controls.update();
    this.#soon();
  }

  /** Shows less for a factor below 1. */
  zoom(factor: number): void {
    const offset = this.#camera.position.clone().sub(this.#controls.target).multiplyScalar(factor);
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.#soon();
  }

  /** All there is, from behind the radar and above it. */
  reset(): void {
    const { x, y, z } = this.#content?.extent ?? { x: [0, 1], y: [-1, 1], z: [-1, 1] };
    const centre = new Vector3((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, (Math.max(z[0], -2) + Math.min(z[1], 4)) / 2);
    const radius = Math.hypot(x[1] - x[0], y[1] - y[0], z[1] - z[0]) / 2;
    const narrow = Math.min(this.#camera.aspect, 1.25) / 1.25;
    const away = (0.86 * radius) / Math.sin((this.#camera.fov / 2) * (Math.PI / 180)) / narrow;
    const look = new Vector3(-0.75, -0.42, 0.5).normalize();
    this.#controls.target.copy(centre);
    this.#camera.position.copy(centre).addScaledVector(look, away);
    this.#controls.maxDistance = 6 * away;
    this.#controls.minDistance = 0.05;
    this.#controls.update();
    this.#soon();
  }

  /** Where a point is on the screen, px from the canvas' corner; null where it is behind the eye. */
  at(index: number): { x: number; y: number } | null {
    const point = this.#content?.points[index];
    if (!point) return null;
    const seen = this.#project(point.xM, point.yM, point.zM);
    return seen && { x: seen.x, y: seen.y };
  }

  /** What the camera looks from, for tests: forward, left, up, m. */
  get eye(): readonly [number, number, number] {
    const { x, y, z } = this.#camera.position;
    return [x, y, z];
  }

  get ratio(): number {
    return this.#ratio;
  }

  sizeAt(scale: number): { width: number; height: number } {
    const { clientWidth, clientHeight } = this.#host;
    return {
      width: Math.round(clientWidth * this.#ratio * scale),
      height: Math.round(clientHeight * this.#ratio * scale),
    };
  }

  /** The view at another scale, with its labels, on a canvas of its own. */
  drawAgain(scale: number): HTMLCanvasElement {
    const { width, height } = this.sizeAt(scale);
    const copy = document.createElement('canvas');
    [copy.width, copy.height] = [width, height];
    const ctx = copy.getContext('2d');
    if (!ctx) throw new Error('This browser gives no 2-D canvas to draw the image on.');
    this.#renderer.setPixelRatio(this.#ratio * scale);
    this.#mark(this.#ratio * scale);
    this.#renderer.render(this.#scene, this.#camera);
    // What is drawn is there until the browser next has time to paint.
    ctx.drawImage(this.#renderer.domElement, 0, 0, width, height);
    this.#renderer.setPixelRatio(this.#ratio);
    this.#mark();
    this.#draw();
    ctx.scale(this.#ratio * scale, this.#ratio * scale);
    this.#write(ctx);
    return copy;
  }

  /** Gives back all that it holds. */
  close(): void {
    cancelAnimationFrame(this.#request);
    this.#stop.abort();
    this.#sizes.disconnect();
    this.#controls.removeEventListener('change', this.#soon);
    this.#controls.dispose();
    for (const part of [this.#cloud, this.#stems, this.#grid, this.#axes]) {
      part.geometry.dispose();
      part.material.dispose();
    }
    this.#renderer.dispose();
    this.#renderer.forceContextLoss();
    this.canvas.remove();
    this.#labels.remove();
  }

  #soon = (): void => {
    this.#request ||= requestAnimationFrame(() => {
      this.#request = 0;
      this.#draw();
    });
  };

  #draw(): void {
    this.#renderer.render(this.#scene, this.#camera);
    const { clientWidth, clientHeight } = this.#host;
    const ctx = this.#labels.getContext('2d');
    if (!ctx) return;
    ctx.setTransform(this.#ratio, 0, 0, this.#ratio, 0, 0);
    ctx.clearRect(0, 0, clientWidth, clientHeight);
    this.#write(ctx);
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.#host;
    if (!width || !height) return;
    this.#ratio = Math.min(globalThis.devicePixelRatio || 1, 3);
    this.#renderer.setPixelRatio(this.#ratio);
    this.#renderer.setSize(width, height);
    [this.#labels.width, this.#labels.height] = [width * this.#ratio, height * this.#ratio];
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    if (this.#content) this.#mark();
    // The browser clears what changes its size, and paints before the next frame.
    this.#draw();
  }

  /** Grid, axes and colours. */
  #surround({ extent: { x, y, z }, palette }: SpaceContent): void {
    const [ground, poles]: number[][] = [[], []];
    for (const at of ticks(x, gridStep(x[1] - x[0]))) ground?.push(at, y[0], 0, at, y[1], 0);
    for (const at of ticks(y, gridStep(y[1] - y[0]))) ground?.push(x[0], at, 0, x[1], at, 0);
    poles?.push(x[0], 0, 0, x[1], 0, 0, 0, y[0], 0, 0, y[1], 0, 0, 0, z[0], 0, 0, z[1]);
    const tick = 0.012 * (x[1] - x[0]);
    for (const at of ticks(z, gridStep(z[1] - z[0]))) poles?.push(0, -tick, at, 0, tick, at);
    fill(this.#grid.geometry, ground ?? []);
    fill(this.#axes.geometry, poles ?? []);
    // The renderer forgets its own with a context that is lost.
    this.#scene.background = new Color(palette.background);
    this.#grid.material.color.set(palette.grid);
    this.#axes.material.color.set(palette.muted);
    this.#stems.material.color.set(palette.muted);
    const { rim, ring } = this.#cloud.material.uniforms;
    rim?.value.set(palette.background);
    ring?.value.set(palette.text);
  }

  /** Positions, colours, and a line from each point to the ground. */
  #place(): void {
    if (!this.#content) return;
    const { points, scale, theme } = this.#content;
    const [places, colours, stems] = [
      new Float32Array(3 * points.length),
      new Float32Array(3 * points.length),
      new Float32Array(6 * points.length),
    ];
    points.forEach((point, i) => {
      const { xM, yM, zM } = point;
      places.set([xM, yM, zM], 3 * i);
      stems.set([xM, yM, zM, xM, yM, 0], 6 * i);
      const [r, g, b] = pointColour(point, scale, theme);
      colours.set(new Color().setRGB(r / 255, g / 255, b / 255, SRGBColorSpace).toArray(), 3 * i);
    });
    fill(this.#stems.geometry, stems);
    const { geometry } = this.#cloud;
    fill(geometry, places);
    geometry.setAttribute('colour', new BufferAttribute(colours, 3).setUsage(DynamicDrawUsage));
  }

  /** Sizes of points, of which chosen ones are larger. */
  #mark(ratio = this.#ratio): void {
    if (!this.#content) return;
    const { points, chosen } = this.#content;
    const sizes = Float32Array.from(points, ({ key }) => (key === chosen ? CHOSEN_PX : POINT_PX) * ratio);
    this.#cloud.geometry.setAttribute('size', new BufferAttribute(sizes, 1).setUsage(DynamicDrawUsage));
    const { wide } = this.#cloud.material.uniforms;
    if (wide) wide.value = CHOSEN_PX * ratio * 0.99;
  }

  #project(x: number, y: number, z: number): { x: number; y: number; depth: number } | null {
    this.#camera.updateMatrixWorld();
    const seen = new Vector3(x, y, z).project(this.#camera);
    if (seen.z > 1) return null;
    const { clientWidth, clientHeight } = this.#host;
    return { x: ((seen.x + 1) / 2) * clientWidth, y: ((1 - seen.y) / 2) * clientHeight, depth: seen.z };
  }

  /** Metres and names along the axes. */
  #write(ctx: CanvasRenderingContext2D): void {
    if (!this.#content) return;
    const { extent, palette } = this.#content;
    const { x, y, z } = extent;
    ctx.font = `11px ${palette.font}`;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    const { clientWidth, clientHeight } = this.#host;
    const taken: { x: number; y: number; half: number }[] = [];
    const text = (words: string, place: readonly [number, number, number], colour: string): void => {
      const at = this.#project(...place);
      if (!at) return;
      const half = ctx.measureText(words).width / 2 + 2;
      const over = taken.some((other) => Math.abs(other.x - at.x) < other.half + half && Math.abs(other.y - at.y) < 13);
      if (over || at.x < half || at.x > clientWidth - half || at.y < 8 || at.y > clientHeight - 8) return;
      taken.push({ x: at.x, y: at.y, half });
      ctx.lineWidth = 3;
      ctx.strokeStyle = palette.background;
      ctx.strokeText(words, at.x, at.y);
      ctx.fillStyle = colour;
      ctx.fillText(words, at.x, at.y);
    };
    const [stepX, stepY, stepZ] = [x, y, z].map(([low, high]) => gridStep(high - low)) as [number, number, number];
    text('x, forward (m)', [x[1] + 0.6 * stepX, 0, 0], palette.text);
    text('y, left (m)', [x[0], y[1] + 0.7 * stepY, 0], palette.text);
    text('z, up (m)', [0, 0, z[1] + 0.06 * (x[1] - x[0])], palette.text);
    for (const at of ticks(x, stepX)) text(number(at), [at, y[0] - 0.35 * stepY, 0], palette.muted);
    for (const at of ticks(y, stepY)) text(number(at), [x[0] - 0.3 * stepX, at, 0], palette.muted);
    for (const at of ticks(z, stepZ)) if (at) text(number(at), [0, 0.25 * stepY, at], palette.muted);
  }

  #nearest({ clientX, clientY }: PointerEvent): number | null {
    const { left, top } = this.canvas.getBoundingClientRect();
    const points = this.#content?.points ?? [];
    let best: number | null = null;
    let least = REACH_PX;
    let front = 1;
    points.forEach(({ xM, yM, zM }, i) => {
      const at = this.#project(xM, yM, zM);
      if (!at) return;
      const apart = Math.hypot(at.x - (clientX - left), at.y - (clientY - top));
      // Of points in one place on the screen the one in front.
      if (apart < least - 1 || (apart < least + 1 && apart < REACH_PX && at.depth < front)) {
        [best, least, front] = [i, Math.min(apart, least), at.depth];
      }
    });
    return best;
  }

  #move = (event: PointerEvent): void => {
    if (event.buttons) return;
    const index = this.#nearest(event);
    this.canvas.classList.toggle('over', index !== null);
    this.#events.point(index);
  };

  #up = (event: PointerEvent): void => {
    const down = this.#down;
    this.#down = null;
    if (!down || Math.hypot(event.clientX - down.x, event.clientY - down.y) > TAP_PX) return;
    this.#events.choose(this.#nearest(event));
  };
}

/** Three.js measures angles from its y axis; here z is up. */
const toSpherical = ({ x, y, z }: Vector3): Spherical => new Spherical().setFromVector3(new Vector3(y, z, x));

function fromSpherical(spherical: Spherical): Vector3 {
  const { x, y, z } = new Vector3().setFromSpherical(spherical);
  return new Vector3(z, x, y);
}

function fill(geometry: BufferGeometry, numbers: ArrayLike<number>): void {
  const before = geometry.getAttribute('position');
  const array = Float32Array.from(numbers);
  if (before instanceof BufferAttribute && before.array.length === array.length) {
    before.array.set(array);
    before.needsUpdate = true;
    return;
  }
  // What has another length needs memory of its own on the graphics card.
  geometry.dispose();
  geometry.setAttribute('position', new BufferAttribute(array, 3).setUsage(DynamicDrawUsage));
}

const number = (value: number): string => `${Math.round(value * 1000) / 1000}`.replace('-', '−');
