/** Version that a Cargo.lock names for a package; throws where it names none or several. */
export function lockedVersion(lock, name) {
  const found = lock
    .split(/^\[\[package\]\]$/m)
    .filter((entry) => new RegExp(`^name = "${name}"$`, 'm').test(entry))
    .map((entry) => /^version = "([^"]+)"$/m.exec(entry)?.[1]);
  if (found.length !== 1) {
    throw new Error(`Cargo.lock names ${found.length} versions of ${name}, expected one`);
  }
  return found[0];
}

/** Whether version `a` is at least `b`, both as in "20.19.0". */
export function atLeast(a, b) {
  const [left, right] = [a, b].map((version) => version.split('.').map((part) => Number.parseInt(part, 10)));
  for (let k = 0; k < 3; k += 1) {
    if ((left[k] ?? 0) !== (right[k] ?? 0)) return (left[k] ?? 0) > (right[k] ?? 0);
  }
  return true;
}
