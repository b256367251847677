/** The targets as numbers. */
import { showHelp } from '../../state/settings.ts';
import { NumberCell } from '../../ui/number-field.tsx';
import { addTarget, angleState, freeAzimuth, LIMITS, removeTarget, setTarget } from './state.ts';

/** What is typed counts to this. */
const TYPED = { azimuthDeg: 0.001, powerDb: 0.001 };

export function TargetTable() {
  const { targets } = angleState.value;
  return (
    <div class="targets">
      <table>
        <thead>
          <tr>
            <th scope="col">No.</th>
            <th scope="col">Azimuth, {'°'}</th>
            <th scope="col">Power, dB</th>
            <th>
              <span class="visually-hidden">Remove</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {targets.map((target, i) => (
            <tr key={i}>
              <th scope="row">{i + 1}</th>
              <td>
                <NumberCell
                  label={`Azimuth of target ${i + 1}, degrees`}
                  name={`azimuth-${i}`}
                  value={target.azimuthDeg}
                  step={0.1}
                  min={LIMITS.azimuthDeg[0]}
                  max={LIMITS.azimuthDeg[1]}
                  onChange={(azimuthDeg) => setTarget(i, { azimuthDeg }, TYPED)}
                />
              </td>
              <td>
                <NumberCell
                  label={`Power of target ${i + 1}, dB`}
                  name={`power-${i}`}
                  value={target.powerDb}
                  step={0.5}
                  min={LIMITS.powerDb[0]}
                  max={LIMITS.powerDb[1]}
                  onChange={(powerDb) => setTarget(i, { powerDb }, TYPED)}
                />
              </td>
              <td>
                <button
                  type="button"
                  class="plain"
                  aria-label={`Remove target ${i + 1}`}
                  title="Remove"
                  onClick={() => removeTarget(i)}
                >
                  {'×'}
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <button
        type="button"
        class="plain"
        data-action="add-target"
        disabled={targets.length >= LIMITS.targets}
        onClick={() => addTarget({ azimuthDeg: freeAzimuth(targets), powerDb: 0 })}
      >
        Add target
      </button>
      <p class={showHelp.value ? 'help' : 'visually-hidden'}>
        Drag a target on the plot: sideways its azimuth, up and down its power. Double-click the plot to add one, a
        target to remove it. With the keyboard: arrows move a focused target by 0.1{'°'}, with Shift by 1{'°'}; plus and
        minus change its power; Delete removes it.
      </p>
    </div>
  );
}
