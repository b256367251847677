/** State of the angle lab: all of it in the address. */
import { signal } from '@preact/signals';
import type { ArrayInput, Method, Position } from 'boresight';
import { fixed, signed } from '../../../plots/format.ts';
import { methodNames, networkNames } from '../../methods.ts';
import { optionsOf } from '../../options.ts';
import type { Caption } from '../../state/address.ts';
import { choice, codec, type Field, names, number, optional, text } from '../../state/codec.ts';
import { keptField } from '../../state/comparison.ts';
import { seed } from '../../state/seed.ts';

export interface Target {
  azimuthDeg: number;
  powerDb: number;
}

export const LIMITS = {
  azimuthDeg: [-89.9, 89.9],
  powerDb: [-40, 10],
  elements: [2, 128],
  targets: 12,
} as const;

/** What a Monte-Carlo run may vary. */
export const SWEPT = ['snr', 'separation', 'snapshots'] as const;

export const PRESETS = ['awr1642', 'awr1843', 'iwr6843isk', 'iwr6843aop', 'iwr6843ods', 'cascade86', 'lrr48'] as const;

const targets: Field<readonly Target[]> = {
  fallback: [
    { azimuthDeg: -5, powerDb: 0 },
    { azimuthDeg: 12, powerDb: 0 },
  ],
  read: (value) => {
    if (value === '-') return [];
    const list = value.split(',').map((part) => {
      const [azimuthDeg = Number.NaN, powerDb = 0] = part.split(':').map(Number);
      return { azimuthDeg, powerDb };
    });
    const valid =
      list.length <= LIMITS.targets &&
      list.every(
        (target) =>
          target.azimuthDeg >= LIMITS.azimuthDeg[0] &&
          target.azimuthDeg <= LIMITS.azimuthDeg[1] &&
          target.powerDb >= LIMITS.powerDb[0] &&
          target.powerDb <= LIMITS.powerDb[1],
      );
    return valid ? list : undefined;
  },
  write: (list) => list.map(({ azimuthDeg, powerDb }) => `${azimuthDeg}:${powerDb}`).join(',') || '-',
};

function validArray(name: string): boolean {
  if (name.startsWith('at:')) return positionsProblem(name.slice(3)) === null;
  const elements = /^ula(\d+)$/.exec(name)?.[1];
  if (elements) return Number(elements) >= LIMITS.elements[0] && Number(elements) <= LIMITS.elements[1];
  return PRESETS.some((preset) => preset === name);
}

const estimator = optionsOf('SharedEstimatorOptions');

export const angleCodec = codec(
  {
    array: text('ula10', validArray),
    targets,
    snr: number(20, [-30, 60]),
    snapshots: number(100, [1, 2000], 'integer'),
    seed,
    fluctuation: choice('complex-normal', ['complex-normal', 'random-phase', 'coherent']),
    gain: number(0, [0, 6]),
    phase: number(0, [0, 60]),
    position: number(0, [0, 0.5]),
    coupling: text('off', (value) => value === 'off' || (Number(value) >= -60 && Number(value) <= -5)),
    /** `known`: as many as there are targets. */
    sources: estimator.picks('sources', ['known', 'auto', 'mdl', 'aic'], 'known'),
    methods: names<Method>(['bartlett', 'capon', 'music', 'root-music'], methodNames),
    /** At most what quick methods do within a frame. */
    grid: estimator.field('gridPoints', { max: 8192 }),
    average: estimator.field('forwardBackward'),
    refine: estimator.field('refine'),
    networks: networkNames,
    smoothing: estimator.maybe('smoothing'),
    /** Of the Monte-Carlo runs: what is varied, between what, and how often each is drawn. */
    sweep: choice('snr', SWEPT),
    from: optional(number(0, [-30, 2000])),
    to: optional(number(0, [-30, 2000])),
    runs: number(200, [10, 5000], 'integer'),
    a: keptField,
  },
  ['array', 'targets', 'snr', 'snapshots', 'seed', 'methods'],
);

export type AngleState = typeof angleCodec.defaults;
export const angleState = signal<AngleState>(angleCodec.defaults);

export function update(patch: Partial<AngleState>): void {
  angleState.value = { ...angleState.value, ...patch };
}

/** Array, noise and snapshots in words. */
export function setupOf({ array, snr, snapshots, fluctuation }: AngleState): string {
  const told = snapshots === 1 || fluctuation === 'complex-normal' ? '' : `, ${fluctuation.replace('-', ' ')}`;
  return (
    `${array.startsWith('at:') ? `elements at ${array.slice(3)}` : array}, SNR ${fixed(snr, 1)} dB, ` +
    `${snapshots} snapshot${snapshots === 1 ? '' : 's'}${told}`
  );
}

/** For those who see a plot alone. */
export function captionOf(state: AngleState): Caption {
  const targets = state.targets.map(
    ({ azimuthDeg, powerDb }) => `${signed(azimuthDeg, 1)}°${powerDb ? ` at ${signed(powerDb, 1)} dB` : ''}`,
  );
  return {
    data: `simulated, seed ${state.seed}`,
    settings: `${setupOf(state)}, targets: ${targets.join(', ') || 'none'}`,
  };
}

const clamp = (value: number, [low, high]: readonly [number, number]): number => Math.min(Math.max(value, low), high);
const round = (value: number, step: number): number => Number((Math.round(value / step) * step).toFixed(4));

export function setTarget(index: number, patch: Partial<Target>, step = { azimuthDeg: 0.1, powerDb: 0.5 }): void {
  update({
    targets: angleState.value.targets.map((target, i) => {
      if (i !== index) return target;
      return {
        azimuthDeg: clamp(round(patch.azimuthDeg ?? target.azimuthDeg, step.azimuthDeg), LIMITS.azimuthDeg),
        powerDb: clamp(round(patch.powerDb ?? target.powerDb, step.powerDb), LIMITS.powerDb),
      };
    }),
  });
}

export function addTarget(target: Target): void {
  if (angleState.value.targets.length >= LIMITS.targets) return;
  update({ targets: [...angleState.value.targets, target] });
  setTarget(angleState.value.targets.length - 1, {});
}

export function removeTarget(index: number): void {
  update({ targets: angleState.value.targets.filter((_, i) => i !== index) });
}

/** The widest gap between targets, for a new one. */
export function freeAzimuth(list: readonly Target[]): number {
  const edges = [-60, ...list.map((target) => target.azimuthDeg).sort((a, b) => a - b), 60];
  let best = [0, 0];
  for (let i = 1; i < edges.length; i++) {
    const [a, b] = [edges[i - 1] as number, edges[i] as number];
    if (b - a > (best[1] as number)) best = [(a + b) / 2, b - a];
  }
  return round(best[0] as number, 0.1);
}

/** `0, 1, 4:0.5`: y in half wavelengths, and z after a colon. */
export function parsePositions(value: string): Position[] | string {
  const parts = value.split(/[\s,;]+/).filter(Boolean);
  const positions: Position[] = [];
  for (const [i, part] of parts.entries()) {
    const [y, z = 0, ...rest] = part.split(':').map((number) => (number.trim() === '' ? Number.NaN : Number(number)));
    if (y === undefined || !Number.isFinite(y) || !Number.isFinite(z) || rest.length) {
      return `Element ${i + 1}: “${part}” is no position. Write y, or y:z, in half wavelengths.`;
    }
    if (Math.abs(y) > 1000 || Math.abs(z) > 1000) return `Element ${i + 1}: ${part} is beyond ±1000 half wavelengths.`;
    const twin = positions.findIndex((other) => other[1] === y && other[2] === z);
    if (twin >= 0) return `Elements ${twin + 1} and ${i + 1} are at the same position.`;
    positions.push([0, y, z]);
  }
  if (positions.length < LIMITS.elements[0] || positions.length > LIMITS.elements[1]) {
    return `An array has ${LIMITS.elements[0]} to ${LIMITS.elements[1]} elements; ${positions.length} given.`;
  }
  return positions;
}

export function positionsProblem(value: string): string | null {
  const result = parsePositions(value);
  return typeof result === 'string' ? result : null;
}

export function arrayInput(name: string): ArrayInput {
  if (!name.startsWith('at:')) return name;
  const positions = parsePositions(name.slice(3));
  return { positions: typeof positions === 'string' ? [] : positions };
}
