const permitted = new Set([
  'MIT',
  'MIT-0',
  'Apache-2.0',
  'Apache-2.0 WITH LLVM-exception',
  'BSD-2-Clause',
  'BSD-3-Clause',
  'ISC',
  'MPL-2.0',
  'Zlib',
  'Unicode-3.0',
  'Unicode-DFS-2016',
  '0BSD',
  'CC0-1.0',
  'BSL-1.0',
  'Unlicense',
]);

/** Whether an SPDX expression can be met with permitted licences only: OR needs one side, AND both. */
export function licenceAllowed(expression) {
  if (!expression) return false;
  const tokens = expression.replaceAll('/', ' OR ').match(/\(|\)|[^\s()]+/g) ?? [];
  let at = 0;
  const atom = () => {
    if (tokens[at] === '(') {
      at += 1;
      const inside = either();
      if (tokens[at] !== ')') return false;
      at += 1;
      return inside;
    }
    let name = tokens[at];
    at += 1;
    if (tokens[at] === 'WITH') {
      name = `${name} WITH ${tokens[at + 1]}`;
      at += 2;
    }
    return permitted.has(name);
  };
  const both = () => {
    let good = atom();
    while (tokens[at] === 'AND') {
      at += 1;
      good = atom() && good;
    }
    return good;
  };
  const either = () => {
    let good = both();
    while (tokens[at] === 'OR') {
      at += 1;
      good = both() || good;
    }
    return good;
  };
  const result = either();
  return result && at === tokens.length;
}

/** Name and licence of every crate in the resolved graph that is not of the workspace. */
export function crateLicences({ packages, workspace_members: members }) {
  const own = new Set(members);
  return packages
    .filter(({ id }) => !own.has(id))
    .map(({ name, version, license }) => ({ name: `${name} ${version} (crate)`, licence: license }));
}

/** Name and licence of every package in a package-lock, the project itself left out. */
export function npmLicences({ packages }) {
  return Object.entries(packages)
    .filter(([path]) => path !== '')
    .map(([path, { version, license }]) => ({
      name: `${path.slice(path.lastIndexOf('node_modules/') + 'node_modules/'.length)} ${version} (npm)`,
      licence: license,
    }));
}
