/** Crates by layer, lowest first, without their prefix: a crate depends on crates of lower layers only. */
export const layers = [
  ['math', 'derive'],
  ['options'],
  ['core'],
  ['signal', 'formats'],
  ['simulate', 'aoa', 'array-calibration', 'mounting', 'image'],
  ['pipeline', 'neural', 'report'],
  ['fleet', 'live'],
  ['validate'],
  ['wasm'],
  ['wasm-neural'],
  ['cli', 'generate', 'fuzz-targets'],
  // Research is on top: nothing depends on it.
  ['experiments'],
];
const layerOf = (crate) => layers.findIndex((layer) => layer.includes(crate));

const bindings = ['wasm', 'wasm-neural'];
/** The module of networks holds part of the other bindings; what the bindings describe is written out too. */
const buildsOn = { 'wasm-neural': ['wasm'], generate: bindings };

/** Outside crates that only some crates may name, as a pattern and those crates. */
const confined = [
  { pattern: /^(wasm-bindgen|js-sys|web-sys|serde-wasm-bindgen)/, to: bindings },
  { pattern: /^tract(-|$)/, to: ['neural'] },
];

const prefix = 'boresight-';
export const short = (name) => (name.startsWith(prefix) ? name.slice(prefix.length) : name);

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
    if (layerOf(crate) < 0) return [`${crate}: no layer has it (scripts/lib/checks/dependency-rules.mjs)`];
    return dependencies.flatMap(({ name, kind, ours }) => {
      if (!ours) {
        return confined
          .filter(({ pattern, to }) => pattern.test(name) && !to.includes(crate))
          .map(({ to }) => `${crate} names ${name}, which only ${to.join(' and ')} may`);
      }
      const target = short(name);
      if (bindings.includes(target) && !buildsOn[crate]?.includes(target))
        return [`${crate} depends on the binding crate ${target}`];
      if (kind === 'dev' || layerOf(target) < layerOf(crate)) return [];
      return [`${crate} depends on ${target}, which is not in a lower layer`];
    });
  });
}
