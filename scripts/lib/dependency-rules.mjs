/** Crates of the workspace that each crate may name; `null` for any but a binding crate. */
const allowed = {
  derive: [],
  core: ['derive'],
  signal: ['core'],
  simulate: ['core', 'signal'],
  aoa: ['core', 'signal'],
  image: ['core', 'signal'],
  calibrate: ['core'],
  'array-calibration': ['core', 'signal'],
  formats: ['core'],
  live: ['core', 'calibrate', 'formats'],
  report: ['calibrate'],
  fleet: ['core', 'calibrate', 'formats', 'report'],
  neural: ['core', 'signal', 'aoa'],
  pipeline: ['core', 'signal', 'aoa', 'array-calibration', 'image'],
  validate: ['core', 'calibrate', 'fleet'],
  generate: [
    'core',
    'aoa',
    'array-calibration',
    'calibrate',
    'fleet',
    'formats',
    'image',
    'neural',
    'pipeline',
    'simulate',
    'wasm',
    'wasm-neural',
  ],
  'fuzz-targets': ['core', 'aoa', 'calibrate', 'fleet', 'formats', 'neural', 'pipeline'],
  cli: null,
  experiments: null,
  wasm: null,
  'wasm-neural': null,
};
const research = 'experiments';
const bindings = ['wasm', 'wasm-neural'];
/** The module of networks holds part of the other bindings; what the bindings describe is written out too. */
const buildsOn = { 'wasm-neural': ['wasm'], generate: bindings };

/** Outside crates that only some crates may name, as a pattern and those crates. */
const confined = [
  { pattern: /^(wasm-bindgen|js-sys|web-sys|serde-wasm-bindgen)/, to: bindings },
  { pattern: /^tract(-|$)/, to: ['neural'] },
];

const prefix = 'boresight-';
const short = (name) => (name.startsWith(prefix) ? name.slice(prefix.length) : name);

/**
 * From `cargo metadata`: crate -> its dependencies as { name, kind } without the prefix. Crates
 * that tests and benches name count for the bindings and tract, but a crate may test itself with
 * any other crate of the workspace.
 */
export function workspaceGraph(metadata) {
  return new Map(
    metadata.packages.map(({ name, dependencies }) => [
      name === 'boresight' ? 'cli' : short(name),
      dependencies.map((dependency) => ({
        name: dependency.name,
        kind: dependency.kind ?? 'normal',
        ours: dependency.path !== undefined && dependency.path !== null,
      })),
    ]),
  );
}

/** Every breach of the rules, as text. */
export function problems(graph) {
  return [...graph].flatMap(([crate, dependencies]) => {
    if (!(crate in allowed)) return [`${crate}: no rule says what it may depend on (scripts/lib/dependency-rules.mjs)`];
    return dependencies.flatMap(({ name, kind, ours }) => {
      if (!ours) {
        return confined
          .filter(({ pattern, to }) => pattern.test(name) && !to.includes(crate))
          .map(({ to }) => `${crate} names ${name}, which only ${to.join(' and ')} may`);
      }
      const target = short(name);
      if (target === research) return [`${crate} depends on ${research}, which is research`];
      if (bindings.includes(target) && !buildsOn[crate]?.includes(target))
        return [`${crate} depends on the binding crate ${target}`];
      const list = allowed[crate];
      if (kind === 'dev' || list === null || list.includes(target)) return [];
      return [`${crate} depends on ${target}; it may depend on ${list.join(', ') || 'no other crate'}`];
    });
  });
}
