import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { frameVerdicts, init, trajectory } from 'boresight';

before(() => init());

/** Frames 0.1 s apart of a radar at (3, 0), not turned, of a car that goes straight. */
const straight = (frames) => ({
  timeS: Float64Array.from(frames, (_, i) => i * 0.1),
  verdict: Uint8Array.from(frames, ({ verdict = 'used' }) => frameVerdicts.indexOf(verdict)),
  vxMps: Float32Array.from(frames, ({ speed }) => speed),
  vyMps: Float32Array.from(frames, ({ speed }) => speed * 0),
});

test('a car that stands stays where it is, whether its frames tell a motion or not', () => {
  for (const speed of [Number.NaN, 0.3]) {
    const drives = Array.from({ length: 21 }, () => ({ speed: 5 }));
    const stands = Array.from({ length: 100 }, () => ({ verdict: 'standing', speed }));
    const path = trajectory(straight([...drives, ...stands, ...drives]), { angleDeg: 0, xM: 3 });
    // 2 s at 5 m/s on each side; half a step at half the speed where it stops and where it starts.
    assert.equal(path.xM.length, 142);
    assert.ok(Math.abs(path.xM.at(-1) - (10 + 0.25 + 0.25 + 10)) < 1e-6, `${path.xM.at(-1)} m`);
    assert.equal(path.xM[30], path.xM[110]);
  }
});

test('sparse frames, and those without a motion, are left out', () => {
  const path = trajectory(straight([{ speed: 5 }, { speed: 80, verdict: 'sparse' }, { speed: Number.NaN, verdict: 'slow' }, { speed: 5 }]), { angleDeg: 0, xM: 3 });
  assert.equal(path.xM.length, 2);
  assert.ok(Math.abs(path.xM[1] - 1.5) < 1e-6);
});
