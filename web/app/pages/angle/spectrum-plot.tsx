/** Spectra of all chosen methods over each other, with truth, estimates and bounds; targets can be dragged. */
import { useMemo } from 'preact/hooks';
import type { LegendItem, MovablePoints } from '../../../elements/drawing.ts';
import { AZIMUTH } from '../../../plots/axes.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { bands, horizontalLine, type Layer, markers } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { faint, methodStyle, TRUTH_STYLE } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { type Curve, closes, curve, oneSeries, onOneGrid, sourceMarkers, withBars } from '../../estimates.ts';
import { announce } from '../../state/announce.ts';
import { hasMoved, rememberMoved } from '../../state/settings.ts';
import { KeepButton } from '../../ui/comparison.tsx';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { compared, type Kept, kept } from './compare.ts';
import { results, type Scene } from './compute.ts';
import { addTarget, LIMITS, removeTarget, setTarget, setupOf } from './state.ts';

const EXTENT = { x: [-90, 90], y: [-50, 14] } as const;

function curves({ scene: { geometry }, results }: Kept): (Curve | null)[] {
  return api.methods().map(({ name, title }) => {
    const estimate = results.get(name)?.estimate;
    return estimate ? curve(estimate, title, closes(geometry.positions)) : null;
  });
}

/** A's curves by the side of B's. */
const ofA = (curve: Curve): Curve => ({ ...curve, method: `${curve.method}-a`, title: `A: ${curve.title}` });

const SHIFTED = 'Pseudo-spectra (MUSIC, min-norm) are shifted to the strongest estimated power.';

const TRUTH_RING = { ...TRUTH_STYLE, marker: 'circle' } as const;

/** Targets as crosshairs: a stem up to their power, a ring, and their number. */
export function truthLayer(targets: readonly { azimuthDeg: number; powerDb: number }[]): Layer {
  return ({ ctx, plot, theme, ratio, x, y }) => {
    const { left, top, width, height } = plot.bbox;
    ctx.strokeStyle = theme.truth;
    ctx.fillStyle = theme.truth;
    ctx.font = `600 ${11 * ratio}px ${theme.font}`;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'bottom';
    targets.forEach((target, i) => {
      const px = x(target.azimuthDeg);
      if (px < left || px > left + width) return;
      const py = Math.min(Math.max(y(target.powerDb), top), top + height);
      const r = 8 * ratio;
      ctx.lineWidth = ratio;
      ctx.setLineDash([4 * ratio, 3 * ratio]);
      ctx.beginPath();
      ctx.moveTo(px, top + height);
      ctx.lineTo(px, py + r);
      ctx.stroke();
      ctx.setLineDash([]);
      ctx.lineWidth = 1.5 * ratio;
      ctx.beginPath();
      ctx.arc(px, py, r, 0, 2 * Math.PI);
      ctx.stroke();
      const label = Math.max(py - r - 3 * ratio, top + 12 * ratio);
      ctx.strokeStyle = theme.background;
      ctx.lineWidth = 3 * ratio;
      ctx.strokeText(String(i + 1), px, label);
      ctx.strokeStyle = theme.truth;
      ctx.fillText(String(i + 1), px, label);
    });
  };
}

export function SpectrumPlot({ scene }: { scene: Scene }) {
  const { targets, snr } = scene.state;
  const found = results.value;
  const a = kept.value;
  const own = curves({ scene, results: found });
  const shown = onOneGrid([...own, ...(a ? curves(a).map((item) => item && ofA(item)) : [])]);
  const methodOfA = new Map(a ? [...a.results.keys()].map((name) => [`${name}-a`, name]) : []);
  const content = useMemo(() => {
    const { unambiguousDeg } = scene.geometry;
    const outside: [number, number][] =
      unambiguousDeg < 89.9
        ? [
            [-90, -unambiguousDeg],
            [unambiguousDeg, 90],
          ]
        : [];
    const bound = scene.state.targets.flatMap((target, i) => {
      const sigma = scene.bound?.[i];
      return sigma !== undefined && Number.isFinite(sigma)
        ? [[target.azimuthDeg - sigma, target.azimuthDeg + sigma] as const]
        : [];
    });
    const estimates = [...found].flatMap(([method, { estimate }]) => sourceMarkers(method, estimate?.sources ?? []));
    return {
      x: shown[0]?.azimuthDeg ?? [],
      series: shown.map((item) => {
        const method = methodOfA.get(item.method);
        return { ...oneSeries(item), ...(method ? { style: faint(methodStyle(method)) } : {}) };
      }),
      extent: EXTENT,
      below: [bands(outside, (t) => t.shade), bands(bound, (t) => t.band)],
      above: [
        horizontalLine(-snr, 'noise at one element'),
        markers(
          [...(a?.results ?? [])].flatMap(([method, { estimate }]) =>
            sourceMarkers(method, estimate?.sources ?? []).map(({ x, y }) => ({
              x,
              y,
              style: faint(methodStyle(method)),
              hollow: true,
            })),
          ),
        ),
        markers(estimates),
        truthLayer(targets),
      ],
    };
  }, [scene, found, a]);

  const movable: MovablePoints = {
    points: targets.map((target, i) => ({
      x: target.azimuthDeg,
      y: target.powerDb,
      label: `Target ${i + 1}: azimuth ${signed(target.azimuthDeg, 1)} degrees, power ${signed(target.powerDb, 1)} dB. Arrows move it, plus and minus change power, Delete removes.`,
    })),
    steps: { x: [0.1, 1], y: [0.5, 3] },
    help: 'Drag: angle and power. Keys: arrows 0.1° (Shift: 1°), + and − power, Delete removes.',
  };

  const legend: LegendItem[] = [
    { id: 'truth', label: 'Target, CRB ±σ band', style: TRUTH_RING, line: false, hollow: true },
    ...api
      .methods()
      .filter(({ name }) => found.has(name))
      .map((info): LegendItem => {
        const curve = shown.find(({ method }) => method === info.name);
        return {
          id: info.name,
          label: withBars(info.title, found.get(info.name)?.estimate?.sources ?? []),
          style: methodStyle(info.name),
          line: info.spectrum,
          ...(curve ? { value: ({ index }) => `${fixed(curve.valuesDb[index ?? -1] ?? Number.NaN, 1)}\u00a0dB` } : {}),
        };
      }),
    ...api
      .methods()
      .filter(({ name }) => a?.results.has(name))
      .map(
        (info): LegendItem => ({
          id: `${info.name}-a`,
          label: `A: ${info.title}`,
          style: faint(methodStyle(info.name)),
          line: info.spectrum,
          hollow: true,
        }),
      ),
  ];

  const { state } = scene;
  return (
    <PlotFrame
      title="Angle spectrum"
      name="spectrum"
      height="tall"
      content={content}
      legend={legend}
      movable={movable}
      onDrag={(index, azimuthDeg, powerDb) => {
        rememberMoved();
        setTarget(index, { azimuthDeg, powerDb });
      }}
      onRemove={(index) => {
        removeTarget(index);
        announce(`Target ${index + 1} removed.`, 0);
      }}
      keys="Tab to a target to move it."
      tools={<KeepButton of={compared} />}
      overlay={
        !hasMoved.value && targets.length > 0 ? (
          <p class="plot-hint" data-hint>
            Drag a ring to move its target; double-click to add or remove one.
          </p>
        ) : null
      }
      axes={{ x: AZIMUTH, y: { label: 'Level (dB re 0 dB target)' } }}
      onDoubleClick={({ x, y }) => {
        if (targets.length < LIMITS.targets) addTarget({ azimuthDeg: x, powerDb: y });
      }}
      readout={({ x, y }) => `Azimuth ${signed(x, 2)}°   Level ${fixed(y, 1)}\u00a0dB`}
      csv={() =>
        toCsv(
          ['azimuth_deg', ...shown.map(({ method }) => `${method.replaceAll('-', '_')}_db`)],
          Array.from(shown[0]?.azimuthDeg ?? [], (azimuth, i) => [
            azimuth,
            ...shown.map(({ valuesDb }) => valuesDb[i]),
          ]),
        )
      }
      fileParts={[state.array.split(':')[0] ?? '', `seed${state.seed}`]}
      remarks={[`${setupOf(state)}, seed ${state.seed}. ${SHIFTED}`]}
      imageRemarks={[SHIFTED]}
    />
  );
}
