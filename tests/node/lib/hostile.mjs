// Values that lie: what no honest caller passes, and what a page with broken or malicious scripts may.
import { runInNewContext } from 'node:vm';

const thrower = () => {
  throw new Error('a property that throws');
};
const traps = Object.fromEntries(
  Object.getOwnPropertyNames(Reflect)
    .filter((name) => typeof Reflect[name] === 'function')
    .map((name) => [name, thrower]),
);
const lengths = [-1, 0.5, Number.NaN, Infinity, 2 ** 32, 2 ** 53, '3', null, undefined, {}, Symbol('length'), 7n];
const primitives = [
  ...[Number.NaN, -0, 1e308, -1, 0.5, 2 ** 53, Infinity, 7n, 2n ** 70n],
  ...['', '\ud800', 'x'.repeat(1e5), '__proto__', null, undefined, true, Symbol('value')],
];

function revoked(target) {
  const { proxy, revoke } = Proxy.revocable(target, {});
  revoke();
  return proxy;
}

function detached(array) {
  structuredClone(array.buffer, { transfer: [array.buffer] });
  return array;
}

/** The object of a value, or one of its kind, to build a lie on. */
const objectOf = (value) => (typeof value === 'object' && value !== null ? value : { value });
const sliced = (array) => Object.getPrototypeOf(array.constructor).prototype.slice.call(array);
const copyOf = (value) =>
  ArrayBuffer.isView(value) ? sliced(value) : Array.isArray(value) ? [...value] : { ...value };

/** A copy of a value of which a property is asked by `get`, which is given what a good one would answer. */
function withProperty(value, { pick }, get) {
  const copy = copyOf(objectOf(value));
  const keys = ArrayBuffer.isView(copy)
    ? ['length', 'byteLength', 'byteOffset', 'buffer', 'constructor']
    : [...Object.keys(copy).slice(0, 20), ...(Array.isArray(copy) ? [] : ['length', 'data', 'shape'])];
  if (keys.length === 0) return copy;
  const key = pick(keys);
  const good = copy[key];
  return Object.defineProperty(copy, key, { enumerable: true, get: () => get(good) });
}

/** By name, what makes a lie out of a good value; `reenter` calls the package. */
export const lies = {
  primitive: (_, { pick }) => pick(primitives),
  'revoked proxy': (value) => revoked(objectOf(value)),
  'revoked array': () => revoked([]),
  'revoked typed array': () => revoked(new Float64Array(4)),
  'proxy that throws': (value) => new Proxy(objectOf(value), traps),
  'proxy of the value': (value) => new Proxy(objectOf(value), {}),
  'proxy that answers otherwise': (value, { draw, pick }) =>
    new Proxy(objectOf(value), {
      get: (target, key) => (draw() < 0.5 ? Reflect.get(target, key) : pick(primitives)),
      has: () => true,
    }),
  'proxy of an array with a false length': (value, { pick }) => {
    const length = pick(lengths);
    const target = Array.isArray(value) ? value : [value];
    return new Proxy(target, { get: (of, key) => (key === 'length' ? length : Reflect.get(of, key)) });
  },
  'keys that throw': (value) => new Proxy(objectOf(value), { ownKeys: thrower }),
  'keys that are not there': (value) =>
    new Proxy(objectOf(value), {
      ownKeys: () => ['a', 'b'],
      getOwnPropertyDescriptor: () => ({ configurable: true, enumerable: true, value: 1 }),
    }),
  'prototype that throws': (value) => new Proxy(objectOf(value), { getPrototypeOf: thrower }),
  'property that throws': (value, tools) => withProperty(value, tools, thrower),
  'property that calls back': (value, tools) =>
    withProperty(value, tools, (good) => {
      tools.reenter();
      return good;
    }),
  'property that changes': (value, tools) => {
    let answers = 0;
    return withProperty(value, tools, (good) => (answers++ === 0 ? good : tools.pick(primitives)));
  },
  'fake typed array': (_, { pick }) =>
    Object.create(pick([Float64Array, Float32Array, Uint8Array, Uint32Array]).prototype),
  'fake buffer': () => Object.create(ArrayBuffer.prototype),
  'fake array': (_, { pick }) => Object.assign(Object.create(Array.prototype), { length: pick(lengths) }),
  'typed array with a false length': (value, { pick }) => {
    const array = ArrayBuffer.isView(value) ? sliced(value) : Float64Array.of(1, 2, 3, 4);
    return Object.defineProperty(array, 'length', { value: pick([...lengths, 1, 3, 1000]) });
  },
  'typed array whose length changes': (value) => {
    const array = ArrayBuffer.isView(value) ? sliced(value) : Float64Array.of(1, 2, 3, 4);
    let reads = 0;
    return Object.defineProperty(array, 'length', { get: () => array.byteLength + reads++ });
  },
  'typed array of another kind': (value, { pick }) => {
    const kind = pick([Float32Array, Float64Array, Uint8Array, BigInt64Array, Int16Array]);
    return Object.setPrototypeOf(new kind(8), Object.getPrototypeOf(objectOf(value)) ?? Object.prototype);
  },
  'detached array': (value) => detached(ArrayBuffer.isView(value) ? sliced(value) : new Float64Array(4)),
  'array that shrinks': (_value, { pick }) => {
    const buffer = new ArrayBuffer(64, { maxByteLength: 64 });
    const array = new (pick([Float64Array, Float32Array, Uint8Array]))(buffer);
    const get = () => {
      buffer.resize(8);
      return 8;
    };
    return pick([array, Object.defineProperty(array, 'length', { get })]);
  },
  'shared array': (_value, { pick }) => new (pick([Float64Array, Float32Array, Uint8Array]))(new SharedArrayBuffer(64)),
  'long array': (_, { pick }) => pick([new Array(2 ** 32 - 1), new Array(1e6)]),
  'array with items that throw': (_value) => Object.defineProperty([1, 2, 3], 1, { get: thrower }),
  'array that grows': (value) => {
    const array = Array.isArray(value) ? [...value] : [1, 2];
    const get = () => {
      if (array.length < 1000) array.push(1, 2);
      return 1;
    };
    return Object.defineProperty(array, 0, { get });
  },
  'value of another realm': (_, { pick }) =>
    runInNewContext(pick(['[1, 2, 3]', '({ a: 1 })', 'new Float64Array(4)', 'new Uint8Array(4)', 'Object(1)'])),
  'boxed value': (value) => (typeof value === 'symbol' ? {} : Object(value)),
  'value that converts to another': () => ({ valueOf: thrower, toString: thrower, [Symbol.toPrimitive]: thrower }),
  'function or class': (_, { pick }) => pick([thrower, class {}, async () => 1, Object.assign(() => 1, { data: 1 })]),
  'itself inside': (value) => {
    const copy = copyOf(objectOf(value));
    if (!ArrayBuffer.isView(copy)) for (const key of Object.keys(copy).slice(0, 4)) copy[key] = copy;
    return copy;
  },
  'no prototype': (value) => Object.assign(Object.create(null), objectOf(value)),
  'another object': (_, { pick }) =>
    pick([new Map([[1, 2]]), new Date(), /x/, new Error('x'), Promise.resolve(), globalThis]),
};

/** A list of arguments with one value, anywhere in them, replaced by what `lie` makes of it. */
export function spoilt(args, lie, { draw, ...tools }) {
  const pick = (list) => list[Math.floor(draw() * list.length)];
  const into = (value, depth) => {
    const keys = typeof value === 'object' && value !== null && !ArrayBuffer.isView(value) ? Object.keys(value) : [];
    if (depth > 0 && (keys.length === 0 || draw() < 0.3)) return lie(value, { draw, pick, ...tools });
    const copy = Array.isArray(value) ? [...value] : { ...value };
    const key = pick(keys);
    copy[key] = into(value[key], depth + 1);
    return copy;
  };
  return into(args, 0);
}
