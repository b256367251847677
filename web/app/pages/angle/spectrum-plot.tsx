/** Spectra of all chosen methods over each other, with truth, estimates and bounds; targets can be dragged. */
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../elements/base/define.ts';
import { type NamedEstimate, SpectrumElement } from '../../../elements/kinds/spectrum.ts';
import { closes } from '../../../plots/spectra.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { announce } from '../../state/announce.ts';
import { hasMoved, rememberMoved } from '../../state/settings.ts';
import { KeepButton } from '../../ui/comparison.tsx';
import { ElementFrame } from '../../ui/plot-frame.tsx';
import { compared, kept } from './compare.ts';
import type { Answers } from './compute.ts';
import { addTarget, LIMITS, removeTarget, setTarget, setupOf } from './state.ts';

defineElement('boresight-spectrum', SpectrumElement);

/** What each method found, also of those that have found nothing yet. */
function estimatesOf({ scene: { geometry }, results }: Answers): NamedEstimate[] {
  const closed = closes(geometry.positions);
  return api.methods().flatMap(({ name, title, spectrum }) => {
    const result = results.get(name);
    return result ? [{ estimate: result.estimate ?? null, id: name, label: title, line: spectrum, closed }] : [];
  });
}

/** A's estimates by the side of B's. */
const ofA = ({ id, label, ...rest }: NamedEstimate): NamedEstimate => ({
  ...rest,
  id: `${id}-a`,
  label: `A: ${label}`,
  style: methodStyle(id),
  behind: true,
});

const SHIFTED = 'Pseudo-spectra (MUSIC, min-norm) are shifted to the strongest estimated power.';

export function SpectrumPlot(present: Answers) {
  const { scene } = present;
  const { state, geometry, bound } = scene;
  const { targets, snr } = state;
  const a = kept.value;
  const estimates = useMemo(
    () => [...estimatesOf(present), ...(a ? estimatesOf(a).map(ofA) : [])],
    [present.scene, present.results, a],
  );
  return (
    <ElementFrame
      tag="boresight-spectrum"
      own={{
        estimates,
        targets,
        boundsDeg: bound ?? null,
        levels: 'absolute',
        'floor-db': 64,
        'high-db': 14,
        'noise-db': -snr,
        'unambiguous-deg': geometry.unambiguousDeg,
        sector: 90,
        'y-label': 'Level (dB re 0 dB target)',
        movable: true,
      }}
      title="Angle spectrum"
      name="spectrum"
      height="tall"
      keys="Tab to a target to move it."
      tools={<KeepButton of={compared} />}
      overlay={
        !hasMoved.value && targets.length > 0 ? (
          <p class="plot-hint" data-hint>
            Drag a ring to move its target; double-click to add or remove one.
          </p>
        ) : null
      }
      onDrag={(index, azimuthDeg, powerDb) => {
        rememberMoved();
        setTarget(index, { azimuthDeg, powerDb });
      }}
      onRemove={(index) => {
        removeTarget(index);
        announce(`Target ${index + 1} removed.`, 0);
      }}
      onDoubleClick={({ x, y }) => {
        if (targets.length < LIMITS.targets) addTarget({ azimuthDeg: x, powerDb: y });
      }}
      fileParts={[state.array.split(':')[0] ?? '', `seed${state.seed}`]}
      remarks={[`${setupOf(state)}, seed ${state.seed}. ${SHIFTED}`]}
      imageRemarks={[SHIFTED]}
    />
  );
}
