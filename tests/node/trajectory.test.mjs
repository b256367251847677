// Where a radar's motion and an angle lead the car, and how far from the truth.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { calibrateDrive, init, initDrives, relativeTrajectoryError, scanMotion, trajectory } from 'boresight';
import { createPool } from 'boresight/worker';
import { throwsTyped } from './lib/assert.mjs';
import { fourRadars } from './lib/drives.mjs';
import { assertShape } from './lib/interfaces.mjs';

let pool;
let four;
before(async () => {
  await Promise.all([init(), initDrives()]);
  pool = createPool({ workers: 1 });
  four = fourRadars();
});
after(() => pool.terminate());

describe('trajectories', () => {
  test('with the angle found follow the truth better than with a wrong one', async () => {
    const { frames, mounting, result } = calibrateDrive(four, { sensor: 2 });
    const truth = { timeS: four.motion.timeS, ...four.motion.pose };
    const path = (angleDeg) => trajectory(frames, { ...mounting, angleDeg });
    const ours = path(result.angleDeg);
    assertShape(ours, 'Trajectory');
    const error = relativeTrajectoryError(ours, truth);
    // An angle off by 3 deg turns the car by 3 deg of its way over x: metres after 50 m.
    assert.ok(error < 0.2 * relativeTrajectoryError(path(result.angleDeg + 3), truth), `${error}`);
    assert.equal(await pool.relativeTrajectoryError(ours, truth), error);
    assert.deepEqual(await pool.trajectory(frames, { ...mounting, angleDeg: 1 }), path(1));
    assert.ok(relativeTrajectoryError(truth, truth, 20) < 1e-9);
    // The heading may jump by a turn.
    const jumping = { ...truth, yawDeg: truth.yawDeg.map((yaw, i) => yaw + (i % 2) * 360) };
    assert.ok(relativeTrajectoryError(truth, jumping, 20) < 1e-6);
  });

  test('turn by a yaw rate where one is given', async () => {
    const { frames, mounting, result } = calibrateDrive(four, { sensor: 2 });
    const truth = { timeS: four.motion.timeS, ...four.motion.pose };
    const motion = scanMotion(four);
    const yawRateDegps = Float64Array.from(frames.scan, (scan) => motion.yawRateDegps[scan] - result.biasDegps);
    const path = (angleDeg, options) => trajectory(frames, { ...mounting, angleDeg }, options);
    const error = (angleDeg, options) => relativeTrajectoryError(path(angleDeg, options), truth);
    // A wrong angle then moves the car sideways, 3 deg of 50 m being 2.6 m, where it bent the way before.
    const off = error(result.angleDeg + 3, { yawRateDegps });
    assert.ok(error(result.angleDeg, { yawRateDegps }) < 0.5 && off > 2 && off < 3.2, `${off}`);
    assert.deepEqual(
      await pool.trajectory(frames, { ...mounting, angleDeg: 1 }, { yawRateDegps }),
      path(1, { yawRateDegps }),
    );
    // What is not known follows from the radar's motion.
    assert.deepEqual(path(1, { yawRateDegps: yawRateDegps.map(() => NaN) }), path(1));
    assert.ok(trajectory(frames, { angleDeg: 0, xM: 0 }, { yawRateDegps: yawRateDegps.fill(0) }));
    throwsTyped(() => path(1, { yawRateDegps: new Float64Array(1) }), 'shape', 'options.yawRateDegps');
    throwsTyped(() => path(1, 3), 'wrong-type', 'options');
  });

  test('that cannot be had are null, and bad input is refused', () => {
    const { frames, mounting } = calibrateDrive(four, { sensor: 2 });
    assert.equal(trajectory(frames, { angleDeg: 0, xM: 0 }), null);
    const path = trajectory(frames, { ...mounting, angleDeg: 0 });
    assert.equal(relativeTrajectoryError(path, path, 1e6), null);
    throwsTyped(() => relativeTrajectoryError(path, path, 0), 'wrong-type', 'segmentM');
    throwsTyped(() => relativeTrajectoryError(path, { ...path, xM: new Float64Array(1) }), 'shape', 'truth.xM');
    throwsTyped(
      () => relativeTrajectoryError(path, { ...path, timeS: path.timeS.slice().reverse() }),
      'time-backwards',
      'truth.timeS',
    );
    throwsTyped(() => trajectory(frames, { angleDeg: NaN, xM: 1 }), 'wrong-type', 'mounting.angleDeg');
    throwsTyped(() => trajectory({ ...frames, vxMps: [] }, mounting), 'wrong-type', 'frames.vxMps');
    throwsTyped(() => trajectory(undefined, mounting), 'wrong-type', 'frames');
  });
});
