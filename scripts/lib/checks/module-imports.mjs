// Imports between the modules of a crate, from the text of its sources.
import { readdirSync, readFileSync } from 'node:fs';
import { join, relative, sep } from 'node:path';

/** Name of the module that a file under `src` defines: its path, '' for the root. */
function moduleOf(file) {
  const path = file.split(sep).join('/').replace(/\.rs$/, '');
  return path.replace(/(^|\/)(mod|lib|main)$/, '');
}

/** A source without comments and without its tests, which end a file. */
function withoutTests(text) {
  const [code] = text.split(/^#\[cfg\(test\)\]\n(?:#\[.*\]\n)*(?:pub(?:\(crate\))? )?mod \w+ \{/m);
  return code.replace(/\/\/.*$/gm, '');
}

/** The paths of a `use` group, written `{a, b::{c, d}}` from `at` on: a, b::c, b::d, each with `before` in front. */
function expanded(text, at, before) {
  const paths = [];
  let name = '';
  let i = at + 1;
  for (; i < text.length && text[i] !== '}'; i++) {
    if (text[i] === '{') {
      const inner = expanded(text, i, `${before}${name}`);
      paths.push(...inner.paths);
      [name, i] = ['', inner.end];
    } else if (text[i] === ',') {
      if (name) paths.push(`${before}${name}`);
      name = '';
    } else if (!/\s/.test(text[i])) name += text[i];
  }
  if (name) paths.push(`${before}${name}`);
  return { paths, end: i };
}

/** Paths from the crate or the module above that a source names, such as `crate::data::Data`. */
function pathsIn(code) {
  return [...code.matchAll(/\b(?:crate|super)(?:::\w+)*(::\{)?/g)].flatMap((match) =>
    match[1] ? expanded(code, match.index + match[0].length - 1, match[0].slice(0, -1)).paths : [match[0]],
  );
}

/** Of each module, by name, the modules of the same crate that it imports from; `sources` are texts by module. */
export function importsOf(sources) {
  const imports = new Map();
  for (const [module, text] of sources) {
    const from = new Set();
    for (const named of pathsIn(withoutTests(text))) {
      const [start, ...names] = named.split('::');
      // Visibility, as in `pub(crate)`, names nothing.
      if (names.length === 0) continue;
      const path = start === 'crate' ? [] : module.split('/').slice(0, -1);
      while (names[0] === 'super') {
        names.shift();
        path.pop();
      }
      path.push(...names);
      while (path.length > 0 && !sources.has(path.join('/'))) path.pop();
      const target = path.join('/');
      if (target !== module && sources.has(target)) from.add(target);
    }
    imports.set(module, from);
  }
  return imports;
}

/** Groups of modules that import from each other, directly or through others (Tarjan 1972); single modules left out. */
export function cycles(imports) {
  const [order, low, stack, open, found] = [new Map(), new Map(), [], new Set(), []];
  function visit(module) {
    order.set(module, order.size);
    low.set(module, order.get(module));
    stack.push(module);
    open.add(module);
    for (const next of imports.get(module) ?? []) {
      if (!order.has(next)) {
        visit(next);
        low.set(module, Math.min(low.get(module), low.get(next)));
      } else if (open.has(next)) low.set(module, Math.min(low.get(module), order.get(next)));
    }
    if (low.get(module) !== order.get(module)) return;
    const group = stack.splice(stack.lastIndexOf(module));
    for (const member of group) open.delete(member);
    if (group.length > 1) found.push(group);
  }
  for (const module of imports.keys()) if (!order.has(module)) visit(module);
  return found;
}

/** Breaches of the rules on modules: none imports from the root, and no more than two import from each other. */
export function moduleProblems(crate, sources) {
  const imports = importsOf(sources);
  const upward = [...imports].filter(([module, from]) => module !== '' && from.has(''));
  return [
    ...upward.map(([module]) => `${crate}: ${module} imports from lib.rs; import from the file that defines the item`),
    ...cycles(imports)
      .filter((group) => group.length > 2)
      .map((group) => `${crate}: ${group.sort().join(', ')} import from each other`),
  ];
}

/** The sources of a crate by module. */
export function sourcesOf(folder) {
  const files = readdirSync(folder, { recursive: true }).filter((file) => file.endsWith('.rs'));
  return new Map(files.map((file) => [moduleOf(relative('.', file)), readFileSync(join(folder, file), 'utf8')]));
}
