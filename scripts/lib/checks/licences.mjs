/**
 * Whether an SPDX expression is a licence of a list, or a choice (`A OR B`) one side of which is. Parentheses are not
 * read: what has them is not on the list.
 */
export const licenceAllowed = (expression, permitted) =>
  (expression ?? '').split(' OR ').some((side) => permitted.includes(side));

/** Name and licence of every package in a package-lock, the project itself left out. */
export function npmLicences({ packages }) {
  return Object.entries(packages)
    .filter(([path]) => path !== '')
    .map(([path, { version, license }]) => ({
      name: `${path.slice(path.lastIndexOf('node_modules/') + 'node_modules/'.length)} ${version} (npm)`,
      licence: license,
    }));
}
