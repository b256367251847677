/** Points in space as the demo's 3-D view has them: colours, axes, words, and which comes next. */
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { appBundle } from './lib/app-module.mjs';

const { cloudWords, colourAt, colourScale, gridStep, pointColour, stepped, ticks, widened } =
  await appBundle('app/ui/space/points.ts');

const point = (key, xM, yM = 0, zM = 0, rateMps = 0, powerDb = -20) => ({ key, xM, yM, zM, rateMps, powerDb });

test('grids have four to ten lines, at round metres', () => {
  for (const span of [0.3, 1, 2, 7, 19.9, 20, 24, 180, 1e4]) {
    const step = gridStep(span);
    const lines = span / step;
    assert.ok(lines >= 3.9 && lines <= 10.001, `${lines} lines over ${span} m`);
    assert.ok([1, 2, 5].includes(Number((step / 10 ** Math.floor(Math.log10(step) + 1e-9)).toFixed(6))), `${step} m`);
  }
  assert.deepEqual(ticks([-4, 6], 2), [-4, -2, 0, 2, 4, 6]);
});

test('axes hold all points and what was shown before', () => {
  const first = widened([point('a', 17, -5.4, 4.2)], null);
  const inside = ([low, high], value) => value >= low && value <= high;
  for (const [axis, value] of [
    ['x', 17],
    ['x', 0],
    ['y', -5.4],
    ['z', 4.2],
  ])
    assert.ok(inside(first[axis], value), `${axis} ${first[axis]}`);
  assert.deepEqual(widened([point('b', 3)], first), first);
  assert.deepEqual(widened([point('c', Number.NaN, Number.POSITIVE_INFINITY)], first), first);
});

test('range rates are coloured as far to both sides, and what has none is grey', () => {
  const points = [point('a', 1, 0, 0, -1), point('b', 1, 0, 0, 3), point('c', 1, 0, 0, Number.NaN)];
  const scale = colourScale(points, 'rate');
  assert.deepEqual(scale.limits, [-3, 3]);
  const still = pointColour(point('d', 1), scale, 'light');
  assert.ok(Math.max(...still) - Math.min(...still) < 10, `${still}`);
  assert.deepEqual(pointColour(points[2], scale, 'light'), [128, 128, 128]);
  assert.notDeepEqual(colourAt('rate', 0, 'dark'), colourAt('rate', 1, 'dark'));
  const heights = colourScale([point('a', 1, 0, -1), point('b', 1, 0, 4)], 'height');
  assert.deepEqual(heights.limits, [-1, 4]);
  assert.ok(colourScale([], 'power').limits.every(Number.isFinite));
});

test('the next point is the next in range, round and round', () => {
  const points = [point('far', 9), point('near', 2), point('middle', 3, 3), point('near', 2.1)];
  assert.equal(stepped(points, null, 1), 'near');
  assert.equal(stepped(points, 'near', 1), 'middle');
  assert.equal(stepped(points, 'far', 1), 'near');
  assert.equal(stepped(points, 'near', -1), 'far');
  assert.equal(stepped(points, 'gone', -1), 'far');
  assert.equal(stepped([], null, 1), null);
});

test('words say how many there are and how far they reach', () => {
  assert.equal(cloudWords([]), 'No detections.');
  assert.match(cloudWords([point('a', 2, -1, 0.5), point('b', 9, 4, -1)]), /^2 detections from 2\.0 to 9\.0 m forward/);
});
