// The fields of results by the generated JSON Schemas, so that tests can hold results against them.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';

const folder = new URL('../../../web/lib/generated/', import.meta.url);
const definitions = ['schema.json', 'results-schema.json'].map(
  (name) => JSON.parse(readFileSync(new URL(name, folder), 'utf8')).$defs,
);

/** The JSON Schema of each type, by name. */
export const schemas = Object.assign({}, ...definitions);

/** Fields of types that are written in TypeScript and not generated: required, then optional ones. */
const written = {
  AngleHistory: [['timeS', 'angleDeg', 'sigmaDeg']],
  CalibratedFrames: [
    ['scan', 'timeS', 'verdict', 'vxMps', 'vyMps', 'angleDeg', 'angleSigmaDeg', 'weight', 'inliers'],
    ['weights'],
  ],
  ComplexData: [['data', 'shape']],
  DriveCalibration: [['sensor', 'method', 'mounting', 'result', 'outlook', 'history', 'frames']],
  DriveFrame: [
    ['sensor', 'timeS', 'azimuthDeg', 'rangeRateMps', 'yawRateDegps'],
    ['speedMps', 'rangeM', 'rcsDbsm', 'label'],
  ],
  ImageFrame: [['map', 'cells', 'estimates']],
  ImagePlan: [['chain', 'estimator', 'from', 'grid']],
  NetworkInfo: [['id', 'kind', 'name', 'method', 'inputs', 'outputs', 'card', 'readyMs']],
  ScanMotion: [['yawRateDegps', 'speedMps']],
};

/** Required and optional fields of a type. */
function fieldsOf(name) {
  if (written[name]) return written[name];
  const { properties, required = [] } = schemas[name] ?? assert.fail(`no type ${name}`);
  return [required, Object.keys(properties)];
}

/** Asserts that an object has the fields of a type, all required ones and no others. */
export function assertShape(value, name) {
  const [required, optional = []] = fieldsOf(name);
  const keys = Object.keys(value);
  for (const field of required) assert.ok(keys.includes(field), `${name} lacks ${field}`);
  for (const key of keys)
    assert.ok(required.includes(key) || optional.includes(key), `${name} has ${key}, which is not declared`);
  for (const key of keys) assert.notEqual(value[key], undefined, `${name}.${key} is undefined`);
}
