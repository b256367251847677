import type { Estimate } from 'boresight';
import { AZIMUTH } from '../../plots/axes.ts';
import { fixed, signed } from '../../plots/format.ts';
import { bands, horizontalLine, type Marker, markers, verticalLines } from '../../plots/layers.ts';
import { toCsv } from '../../plots/save.ts';
import { type Curve, curve, highest, onOneGrid, sourceMarkers, withBars } from '../../plots/spectra.ts';
import { truthLayer } from '../../plots/targets.ts';
import { faint, methodStyle, type SeriesStyle, TRUTH_STYLE } from '../../plots/theme.ts';
import type { CursorPosition, Interval } from '../../plots/types.ts';
import type { Drawing, LegendItem, MovablePoints } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';
import { sectorOf } from '../base/sector.ts';

/** An estimate with its name and looks, where they are not those of its method. */
export interface NamedEstimate {
  /** Without one there is its place in the legend. */
  estimate: Estimate | null;
  id: string;
  label: string;
  style?: SeriesStyle;
  /** Whether its sign in the legend has a line; where it has a spectrum by default. */
  line?: boolean;
  /** In place of the attribute `closed`. */
  closed?: boolean;
  /** Faint, to compare with. */
  behind?: boolean;
  /** With larger marks, over the others. */
  leading?: boolean;
}

/** A true target: where it is, and its power on the plot's scale. */
export interface ShownTarget {
  azimuthDeg: number;
  powerDb: number;
}

const TRUTH_RING = { ...TRUTH_STYLE, marker: 'circle' } as const;

type Shown = NamedEstimate & Required<Pick<NamedEstimate, 'style' | 'line' | 'behind'>>;

/**
 * Spectra of angle, one a method, with the angles found. A pseudo-spectrum is shifted to the strongest estimated power.
 *
 * @element boresight-spectrum
 * @attr {boolean} closed - the array sees at 90 degrees what it sees at -90, so that spectra go on to there
 * @attr {number} floor-db - the lowest level shown, dB below the highest (60)
 * @attr {number} high-db - the highest level shown; what all fits below by default
 * @attr {'absolute'} levels - levels as they are estimated, not relative to the strongest of each
 * @attr {boolean} movable - targets can be moved: `boresight-drag` tells azimuth and power as x and y
 * @attr {number} noise-db - level of the noise at one element, a line
 * @attr {string} sector - how far to each side the plot shows, deg, or from where to where; the spectra by default
 * @attr {number} unambiguous-deg - what is further to the side is shaded
 * @attr {string} unit - of levels (dB)
 * @attr {string} y-label - of the vertical axis
 */
export class SpectrumElement extends PlotElement {
  static override get observedAttributes(): string[] {
    const own = ['closed', 'floor-db', 'high-db', 'levels', 'movable', 'noise-db', 'sector', 'unambiguous-deg', 'unit'];
    return [...PlotElement.observedAttributes, ...own, 'y-label'];
  }

  #estimates: readonly (Estimate | NamedEstimate)[] = [];
  #truthDeg: readonly number[] = [];
  #targets: readonly ShownTarget[] | null = null;
  #boundsDeg: ArrayLike<number> = [];
  #lines: readonly { azimuthDeg: number; label: string }[] = [];

  /** Results of `estimate`, of one array and one scene, named where they are not to have their methods' names. */
  get estimates(): readonly (Estimate | NamedEstimate)[] {
    return this.#estimates;
  }

  set estimates(given: readonly (Estimate | NamedEstimate)[] | Estimate | null) {
    this.#estimates = Array.isArray(given) ? given : given ? [given as Estimate] : [];
    this.changed();
  }

  /** True azimuths where they are known, deg: lines. */
  get truthDeg(): readonly number[] {
    return this.#truthDeg;
  }

  set truthDeg(given: readonly number[] | null) {
    this.#truthDeg = given || [];
    this.changed();
  }

  /** True targets with their powers: rings with their numbers. */
  get targets(): readonly ShownTarget[] | null {
    return this.#targets;
  }

  set targets(given: readonly ShownTarget[] | null) {
    this.#targets = given || null;
    this.changed();
  }

  /** Bounds on the standard deviation of each target's azimuth, deg: bands. */
  get boundsDeg(): ArrayLike<number> {
    return this.#boundsDeg;
  }

  set boundsDeg(given: ArrayLike<number> | null) {
    this.#boundsDeg = given || [];
    this.changed();
  }

  /** Azimuths with words beside them: dotted lines. */
  get lines(): readonly { azimuthDeg: number; label: string }[] {
    return this.#lines;
  }

  set lines(given: readonly { azimuthDeg: number; label: string }[] | null) {
    this.#lines = given || [];
    this.changed();
  }

  /** @internal */
  protected override axes() {
    const relative = this.getAttribute('levels') !== 'absolute';
    return {
      x: AZIMUTH,
      y: { label: this.getAttribute('y-label') ?? (relative ? 'Relative power (dB)' : 'Power (dB)') },
    };
  }

  /** @internal */
  protected override movablePoints(): MovablePoints | null {
    if (!this.hasAttribute('movable')) return null;
    return {
      points: (this.#targets ?? []).map(({ azimuthDeg, powerDb }, i) => ({
        x: azimuthDeg,
        y: powerDb,
        label: `Target ${i + 1}: azimuth ${signed(azimuthDeg, 1)} degrees, power ${signed(powerDb, 1)} dB. Arrows move it, plus and minus change power, Delete removes.`,
      })),
      steps: { x: [0.1, 1], y: [0.5, 3] },
      help: 'Drag: angle and power. Keys: arrows 0.1° (Shift: 1°), + and − power, Delete removes.',
    };
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const shown = this.#estimates.map(named);
    const targets = this.#targets;
    if (!shown.length && !targets) return null;
    const unit = this.getAttribute('unit') ?? 'dB';
    const { curves, marks } = this.#levels(shown);
    const styles = new Map(shown.map(({ id, style }) => [id, style]));
    const x = curves[0]?.azimuthDeg ?? new Float64Array(0);
    const sides = sectorOf(this.getAttribute('sector'), [x[0] ?? -90, x[x.length - 1] ?? 90]);
    const noise = this.numberOf('noise-db', Number.NaN);
    const beyond = this.numberOf('unambiguous-deg', 90);
    const bounds = (targets ?? []).flatMap(({ azimuthDeg }, i): Interval[] => {
      const sigma = this.#boundsDeg[i] as number;
      return Number.isFinite(sigma) ? [[azimuthDeg - sigma, azimuthDeg + sigma]] : [];
    });
    const value = (id: string): ((position: CursorPosition) => string) | undefined => {
      const own = curves.find(({ method }) => method === id);
      return own && (({ index }) => `${fixed(own.valuesDb[index ?? -1] ?? Number.NaN, 1)}\u00a0${unit}`);
    };
    return {
      content: {
        x,
        series: curves.map(({ method: id, title, valuesDb }) => ({
          id,
          label: title,
          y: valuesDb,
          style: styles.get(id) as SeriesStyle,
        })),
        below: [
          bands(beyond < 89.9 ? [[-90, -beyond] as const, [beyond, 90] as const] : [], (t) => t.shade),
          bands(bounds, (t) => t.band),
        ],
        above: [
          ...(Number.isFinite(noise) ? [horizontalLine(noise, 'noise at one element')] : []),
          verticalLines(this.#truthDeg.map((angle) => ({ x: angle }))),
          verticalLines(
            this.#lines.map(({ azimuthDeg, label }) => ({ x: azimuthDeg, label })),
            { dash: [2, 4], color: (t) => t.muted },
          ),
          markers(marks),
          truthLayer(targets ?? []),
        ],
        extent: { x: sides, y: this.#limits(curves, marks) },
      },
      legend: [
        ...(targets
          ? [
              {
                id: 'truth',
                label: bounds.length ? 'Target, CRB ±σ band' : 'Target',
                style: TRUTH_RING,
                line: false,
                hollow: true,
              },
            ]
          : []),
        ...shown.map(({ id, label, style, line, behind, estimate }): LegendItem => {
          const at = behind ? undefined : value(id);
          return {
            id,
            label: behind ? label : withBars(label, estimate?.sources ?? []),
            style,
            line,
            hollow: behind,
            ...(at ? { value: at } : {}),
          };
        }),
      ],
      alternative: shown
        .filter(({ behind, estimate }) => !behind && estimate)
        .map(({ label, estimate }) => {
          const angles = estimate?.sources.map(({ azimuthDeg }) => `${signed(azimuthDeg, 2)}°`).join(', ');
          return `${label}: ${angles || 'no angle found'}.`;
        })
        .join('\n'),
      readout: (position) =>
        // Where no legend says the values, they stand here.
        this.getAttribute('legend') === 'image'
          ? `Azimuth ${signed(position.x, 2)}°   ${curves.map(({ title, valuesDb }) => `${title.split(' ')[0]} ${fixed(valuesDb[position.index ?? -1] ?? Number.NaN, 1)}`).join('   ')} ${unit}`
          : `Azimuth ${signed(position.x, 2)}°   Level ${fixed(position.y, 1)}\u00a0${unit}`,
      csv: () =>
        toCsv(
          ['azimuth_deg', ...curves.map(({ method }) => `${method.replaceAll('-', '_')}_${unit.toLowerCase()}`)],
          Array.from(x, (azimuth, i) => [azimuth, ...curves.map(({ valuesDb }) => valuesDb[i])]),
        ),
    };
  }

  /** Curves on one grid and marks of sources, on the plot's scale. */
  #levels(shown: readonly Shown[]): { curves: Curve[]; marks: Marker[] } {
    const absolute = this.getAttribute('levels') === 'absolute';
    const all = this.hasAttribute('closed');
    const marks: Marker[] = [];
    const curves = shown.map(({ id, label, style, behind, leading, closed = all, estimate }): Curve | null => {
      const own = estimate && curve(estimate, label, closed);
      const zero = absolute ? 0 : strongest(estimate, own);
      for (const mark of sourceMarkers(estimate?.sources ?? [], style)) {
        const { deviation: _, ...plain } = mark;
        const placed = { ...(behind ? { ...plain, hollow: true } : mark), y: mark.y - zero };
        marks.push(leading ? { ...placed, size: 6 } : placed);
      }
      return own && { ...own, method: id, valuesDb: zero ? own.valuesDb.map((level) => level - zero) : own.valuesDb };
    });
    const order = ({ hollow, size }: Marker): number => Number(size !== undefined) - Number(hollow ?? false);
    return { curves: onOneGrid(curves), marks: marks.sort((a, b) => order(a) - order(b)) };
  }

  #limits(curves: readonly Curve[], marks: readonly Marker[]): Interval {
    const top = Math.max(...curves.map(({ valuesDb }) => highest(valuesDb)), ...marks.map(({ y }) => y));
    const above = this.getAttribute('levels') === 'absolute' && Number.isFinite(top) ? Math.ceil((top + 4) / 5) * 5 : 3;
    const high = this.numberOf('high-db', above);
    const from = this.getAttribute('levels') === 'absolute' ? high : 0;
    return [from - Math.abs(this.numberOf('floor-db', 60)), high];
  }
}

function named(given: Estimate | NamedEstimate): Shown {
  const one: NamedEstimate =
    'sources' in given ? { estimate: given, id: given.method, label: given.method } : (given as NamedEstimate);
  const { estimate, behind = false } = one;
  const own = one.style ?? methodStyle(estimate?.method ?? one.id);
  return {
    ...one,
    behind,
    style: behind ? faint(own) : own,
    line: one.line ?? estimate?.spectrum !== undefined,
  };
}

/** The power that levels are relative to. */
function strongest(estimate: Estimate | null, own: Curve | null): number {
  const powers = estimate?.sources.map(({ powerDb }) => powerDb).filter(Number.isFinite) ?? [];
  return powers.length ? Math.max(...powers) : own ? highest(own.valuesDb) : 0;
}
