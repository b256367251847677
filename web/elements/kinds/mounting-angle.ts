import type { CalibrationResult } from 'boresight';
import { angleBand, angleExtent } from '../../plots/angle-history.ts';
import { fixed, signed } from '../../plots/format.ts';
import { horizontalLine, type Layer } from '../../plots/layers.ts';
import { toCsv } from '../../plots/save.ts';
import { methodStyle } from '../../plots/theme.ts';
import type { Drawing } from '../base/drawing.ts';
import { PlotElement } from '../base/plot-element.ts';

/** A mounting angle over time, as `calibrateDrive` gives it or as a live calibration is asked now and then. */
export interface AngleOverTime {
  timeS: ArrayLike<number>;
  angleDeg: ArrayLike<number>;
  sigmaDeg: ArrayLike<number>;
}

/** Whether a radar is where it should be. */
export type Alarm = 'pass' | 'fail' | 'undecided';

const WORDS: Record<Alarm, string> = {
  pass: 'within tolerance',
  fail: 'out of tolerance',
  undecided: 'not settled',
};
const STYLE = methodStyle('recursive');

/**
 * A mounting angle with its deviation over time, and whether it is where it should be.
 *
 * @element boresight-mounting-angle
 * @attr {number} nominal-deg - where the radar should look
 * @attr {number} tolerance-deg - how far off it may be (1)
 * @attr {number} sigmas - deviations that the band shows, and that a verdict needs (2)
 * @fires boresight-alarm - the verdict changed (`detail`: alarm, angleDeg, sigmaDeg)
 */
export class MountingAngleElement extends PlotElement {
  static override get observedAttributes(): string[] {
    return [...PlotElement.observedAttributes, 'nominal-deg', 'tolerance-deg', 'sigmas'];
  }

  #history: AngleOverTime = { timeS: [], angleDeg: [], sigmaDeg: [] };
  #live: { timeS: number[]; angleDeg: number[]; sigmaDeg: number[] } | null = null;
  #alarm: Alarm = 'undecided';
  #value: HTMLElement | undefined;
  #verdict: HTMLElement | undefined;

  /** The angle over time, with its deviation. */
  get history(): AngleOverTime {
    return this.#history;
  }

  set history(given: AngleOverTime | null) {
    this.#history = given ?? { timeS: [], angleDeg: [], sigmaDeg: [] };
    this.#live = null;
    this.changed();
  }

  /** The verdict on the last angle. */
  get alarm(): Alarm {
    return this.#alarm;
  }

  /** Adds what a live calibration estimates at a time, s; of more than 4,096 every second one is forgotten. */
  add(timeS: number, { angleDeg, sigmaDeg }: Pick<CalibrationResult, 'angleDeg' | 'sigmaDeg'>): void {
    const { timeS: times, angleDeg: angles, sigmaDeg: sigmas } = this.#history;
    let live = this.#live;
    live ??= { timeS: Array.from(times), angleDeg: Array.from(angles), sigmaDeg: Array.from(sigmas) };
    if (live.timeS.length >= 4096) {
      const half = (column: number[]): number[] => column.filter((_, i) => i % 2 === 0);
      live = { timeS: half(live.timeS), angleDeg: half(live.angleDeg), sigmaDeg: half(live.sigmaDeg) };
    }
    live.timeS.push(timeS);
    live.angleDeg.push(angleDeg);
    live.sigmaDeg.push(sigmaDeg);
    this.#live = live;
    this.#history = live;
    this.changed();
  }

  /** @internal */
  protected override axes() {
    return { x: { label: 'Time (s)' }, y: { label: 'Mounting angle (°)', width: 64 } };
  }

  /** @internal */
  protected override build(above: HTMLElement): void {
    const gauge = document.createElement('div');
    gauge.className = 'gauge';
    this.#value = Object.assign(document.createElement('span'), { className: 'value' });
    this.#verdict = Object.assign(document.createElement('span'), { className: 'verdict' });
    this.#value.setAttribute('part', 'value');
    this.#verdict.setAttribute('part', 'verdict');
    this.#verdict.setAttribute('role', 'status');
    gauge.append(this.#value, this.#verdict);
    above.append(gauge);
  }

  /** @internal */
  protected override update(): void {
    const last = this.#last();
    const alarm = this.#judge(last);
    if (this.#value)
      this.#value.textContent = last ? `${signed(last.angleDeg, 2)}° ± ${fixed(last.sigmaDeg, 2)}°` : '–';
    if (this.#verdict) {
      const text = last && this.hasAttribute('nominal-deg') ? WORDS[alarm] : '';
      if (this.#verdict.textContent !== text) this.#verdict.textContent = text;
      this.#verdict.dataset.verdict = alarm;
    }
    if (alarm !== this.#alarm) {
      this.#alarm = alarm;
      this.tell('boresight-alarm', { alarm, ...last });
    }
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const { timeS, angleDeg, sigmaDeg } = this.#history;
    if (!timeS.length) return null;
    const sigmas = Math.abs(this.numberOf('sigmas', 2)) || 2;
    const start = timeS[0] as number;
    const x = Float64Array.from(timeS, (time) => time - start);
    const nominal = this.numberOf('nominal-deg', Number.NaN);
    const tolerance = Math.abs(this.numberOf('tolerance-deg', 1));
    const limits: Layer[] = Number.isFinite(nominal)
      ? [
          horizontalLine(nominal, 'nominal'),
          horizontalLine(nominal - tolerance, 'tolerance', { dash: [6, 3], left: true }),
          horizontalLine(nominal + tolerance, 'tolerance', { dash: [6, 3], left: true }),
        ]
      : [];
    const last = this.#last();
    const { band, line } = angleBand(x, this.#history, sigmas, STYLE);
    const alwaysDeg = Number.isFinite(nominal) ? [nominal - 1.2 * tolerance, nominal + 1.2 * tolerance] : [];
    const nominalDeg = Number.isFinite(nominal) ? nominal : null;
    return {
      content: {
        x,
        series: [],
        below: [band],
        above: [...limits, line],
        extent: {
          x: [0, Math.max(x[x.length - 1] as number, 1)],
          y: angleExtent([this.#history], sigmas, { nominalDeg, shownDeg: last?.angleDeg, alwaysDeg }),
        },
      },
      alternative: last
        ? `After ${fixed(x[x.length - 1] as number, 0)} s: ${signed(last.angleDeg, 2)}°, standard deviation ${fixed(last.sigmaDeg, 2)}°${Number.isFinite(nominal) ? `; ${WORDS[this.#judge(last)]}` : ''}.`
        : 'No angle yet.',
      csv: () =>
        toCsv(
          ['time_s', 'angle_deg', 'sigma_deg'],
          Array.from(timeS, (time, i) => [time, angleDeg[i], sigmaDeg[i]]),
        ),
      readout: ({ x: time, index }) =>
        `${fixed(time, 1)} s   ${signed(angleDeg[index ?? -1] ?? Number.NaN, 2)}° ± ${fixed(sigmaDeg[index ?? -1] ?? Number.NaN, 2)}°`,
    };
  }

  #last(): { angleDeg: number; sigmaDeg: number } | null {
    const { angleDeg, sigmaDeg } = this.#history;
    const at = angleDeg.length - 1;
    const last = { angleDeg: angleDeg[at] ?? Number.NaN, sigmaDeg: sigmaDeg[at] ?? Number.NaN };
    return Number.isFinite(last.angleDeg) ? last : null;
  }

  #judge(last: { angleDeg: number; sigmaDeg: number } | null): Alarm {
    const nominal = this.numberOf('nominal-deg', Number.NaN);
    if (!last || !Number.isFinite(nominal) || !Number.isFinite(last.sigmaDeg)) return 'undecided';
    const off = Math.abs(last.angleDeg - nominal);
    const tolerance = Math.abs(this.numberOf('tolerance-deg', 1));
    const chance = Math.abs(this.numberOf('sigmas', 2)) * last.sigmaDeg;
    if (off + chance <= tolerance) return 'pass';
    return off - chance > tolerance ? 'fail' : 'undecided';
  }
}
