/** The extension for Foxglove and Lichtblick: its file and its conversions. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { files, near, source } from '../viewers/extension.mjs';

/** Runs the script in Node, as the applications do in their pages, and gives what it registers. */
function registered() {
  const found = { converters: [], panels: [], aliases: [] };
  const module = { exports: {} };
  new Function('module', 'require', source)(module, () => undefined, {});
  module.exports.activate({
    mode: 'production',
    registerPanel: (panel) => found.panels.push(panel),
    registerMessageConverter: (converter) => found.converters.push(converter),
    registerTopicAliases: (aliases) => found.aliases.push(aliases),
  });
  const convert = (fromSchemaName, toSchemaName, message, ...more) =>
    found.converters
      .find((one) => one.fromSchemaName === fromSchemaName && one.toSchemaName === toSchemaName)
      .converter(
        message,
        { topic: '/t', schemaName: fromSchemaName, receiveTime: { sec: 9, nsec: 8 }, message },
        ...more,
      );
  return { ...found, convert };
}

/** Fields of a foxglove.PointCloud, point by point; float32, which is all that is sent. */
function points({ fields, point_stride, data }) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  return Array.from({ length: data.byteLength / point_stride }, (_, i) =>
    Object.fromEntries(
      fields.map(({ name, offset, type }) => {
        assert.equal(type, 7, `${name} is float32`);
        return [name, view.getFloat32(i * point_stride + offset, true)];
      }),
    ),
  );
}

/** A turned vector: the axis of a pose. */
function axis({ x, y, z, w }) {
  return [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)];
}

const HEADER = { stamp: { sec: 1_700_000_000, nanosec: 123_456_789 }, frame_id: 'radar_front' };
const RETURN = { range: 10, azimuth: Math.PI / 6, elevation: Math.PI / 18, doppler_velocity: -2, amplitude: 7 };
const SCAN = { header: HEADER, returns: [RETURN, { ...RETURN, azimuth: Number.NaN }] };

test('the file holds what the applications read of an extension, and the licences of what is in it', () => {
  const { version } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
  const manifest = JSON.parse(files['package.json']);
  assert.deepEqual([manifest.name, manifest.publisher, manifest.version], ['boresight', 'boresight', version]);
  assert.equal(manifest.main, './dist/extension.js');
  for (const name of ['README.md', 'CHANGELOG.md', 'LICENSE', 'NOTICE']) assert.ok(files[name].length > 100, name);
  assert.match(files['LICENSES.md'], /## uplot/);
  assert.doesNotMatch(source, /\bimport\(/, 'one script that loads no other');
});

test('conversions and panels are registered in the form that both applications take', () => {
  const { converters, panels } = registered();
  const pairs = converters.map(({ fromSchemaName, toSchemaName }) => `${fromSchemaName} > ${toSchemaName}`);
  assert.equal(new Set(pairs).size, pairs.length);
  assert.ok(converters.every((one) => !('type' in one)));
  for (const form of [
    'radar_msgs/RadarScan',
    'radar_msgs/msg/RadarScan',
    'radar_msgs/RadarTracks',
    'radar_msgs/msg/RadarTracks',
  ])
    for (const to of ['foxglove.PointCloud', 'foxglove.SceneUpdate'])
      assert.ok(pairs.includes(`${form} > ${to}`), form);
  assert.ok(pairs.includes('boresight.MountingAngle > foxglove.Log'));
  assert.deepEqual(
    panels.map(({ name }) => name),
    ['Mounting angle', 'Doppler over azimuth', 'Detections from above'],
  );
});

test('a scan becomes points where its returns are', () => {
  for (const form of ['radar_msgs/RadarScan', 'radar_msgs/msg/RadarScan']) {
    const cloud = registered().convert(form, 'foxglove.PointCloud', SCAN);
    assert.deepEqual([cloud.timestamp, cloud.frame_id], [{ sec: 1_700_000_000, nsec: 123_456_789 }, 'radar_front']);
    const [point, ...none] = points(cloud);
    assert.equal(none.length, 0, 'a return without an azimuth has no place');
    near(point.x, 10 * Math.cos(Math.PI / 18) * Math.cos(Math.PI / 6));
    near(point.y, 10 * Math.cos(Math.PI / 18) * 0.5);
    near(point.z, 10 * Math.sin(Math.PI / 18));
    near(Math.hypot(point.x, point.y, point.z), point.range_m);
    near(point.azimuth_rad, Math.PI / 6);
    near(point.range_rate_mps, -2);
    near(point.amplitude_db, 7);
  }
});

test('a variable of the layout turns azimuths, as aliases are told of it and as messages come with it', () => {
  const { convert, aliases } = registered();
  const side = (...more) => points(convert('radar_msgs/RadarScan', 'foxglove.PointCloud', SCAN, ...more))[0];
  const mirrored = { boresight_azimuth_sign: -1, boresight_range_rate_sign: '-1' };
  near(side().y, -side(mirrored).y);
  near(side(mirrored).range_rate_mps, 2);
  assert.ok(side().y > 0);
  for (const one of aliases) assert.deepEqual(one({ topics: [], globalVariables: mirrored }), []);
  assert.ok(side().y < 0);
  assert.ok(side({}).y > 0, 'variables that come with a message go before');
});

test('range rates become lines as long as the range changes in a second', () => {
  const { entities } = registered().convert('radar_msgs/RadarScan', 'foxglove.SceneUpdate', SCAN);
  const [from, to] = entities[0].lines[0].points;
  near(Math.hypot(from.x, from.y, from.z), 10);
  near(Math.hypot(to.x, to.y, to.z), 8);
  near(to.y / to.x, Math.tan(Math.PI / 6));
  const past = { ...SCAN, returns: [{ ...RETURN, doppler_velocity: -50 }] };
  const [, end] = registered().convert('radar_msgs/RadarScan', 'foxglove.SceneUpdate', past).entities[0].lines[0]
    .points;
  near(Math.hypot(end.x, end.y, end.z), 0);
});

test('tracks become boxes along their velocity, with arrows of its length', () => {
  const track = {
    uuid: { uuid: Uint8Array.from({ length: 16 }, (_, i) => i) },
    position: { x: 20, y: -3, z: 0.5 },
    velocity: { x: 3, y: 4, z: 0 },
    size: { x: 4.5, y: 1.8, z: 1.5 },
    classification: 2,
  };
  const message = { header: HEADER, tracks: [track, { ...track, velocity: { x: 0, y: 0, z: 0 } }] };
  const { deletions, entities } = registered().convert('radar_msgs/msg/RadarTracks', 'foxglove.SceneUpdate', message);
  assert.deepEqual(deletions[0].type, 1);
  const [moving, standing] = entities;
  assert.equal(moving.id, 'track 000102030405060708090a0b0c0d0e0f');
  assert.deepEqual(moving.cubes[0].size, track.size);
  const [x, y, z] = axis(moving.cubes[0].pose.orientation);
  near(x, 0.6);
  near(y, 0.8);
  near(z, 0);
  const [arrow] = moving.arrows;
  near(arrow.shaft_length + arrow.head_length, 5);
  assert.deepEqual(moving.texts[0].text, '5.0 m/s');
  assert.deepEqual(standing.arrows, []);
  const [point] = points(registered().convert('radar_msgs/RadarTracks', 'foxglove.PointCloud', message));
  near(point.vx_mps, 3);
  near(point.y, -3);
});

test('a mounting angle becomes a line of a log, a warning where the radar is misaligned', () => {
  const angle = {
    sensor: 2,
    angleDeg: 31.234,
    sigmaDeg: 0.0567,
    converged: true,
    nominalDeg: 30,
    timestamp: { sec: 0, nsec: 0 },
  };
  const log = (more) => registered().convert('boresight.MountingAngle', 'foxglove.Log', { ...angle, ...more });
  assert.equal(
    log({ alignment: 'misaligned' }).message,
    'Radar 2, mounting angle +31.23° ± 0.06°, misaligned (nominal +30.00°)',
  );
  assert.equal(log({ alignment: 'misaligned' }).level, 3);
  assert.equal(log({ alignment: 'aligned' }).level, 2);
  assert.match(log({ sigmaDeg: undefined }).message, /no angle yet/);
  assert.deepEqual(log({}).timestamp, { sec: 9, nsec: 8 }, 'a time of zero is none');
});

test('messages that are none give nothing, and say why', (context) => {
  const said = context.mock.method(console, 'warn', () => {});
  const { converters } = registered();
  const hostile = [
    null,
    7,
    'text',
    {},
    { header: null, returns: 1, tracks: 1 },
    { returns: [null, 3], tracks: [null, {}] },
    { returns: { length: 1e9 }, tracks: { length: 1e9 } },
    { header: { stamp: 'x' }, returns: new Array(70_000), tracks: new Array(70_000) },
  ];
  for (const { converter } of converters) {
    for (const message of hostile)
      assert.doesNotThrow(() => converter(message, { message, topic: '/t', receiveTime: { sec: 0, nsec: 0 } }));
  }
  assert.ok(said.mock.callCount() > 0);
});
