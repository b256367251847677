// What ships is under permissive licences (or MPL): crates that the wasm and the command line
// link, and npm packages that the published package or the demo needs.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { crateLicences, licenceAllowed, npmLicences } from './lib/licences.mjs';
import { root } from './lib/paths.mjs';
import { main, output } from './lib/run.mjs';

await main(async () => {
  const metadata = output('cargo', ['metadata', '--format-version', '1', '--locked']);
  if (metadata === null) throw new Error('cargo metadata --locked failed: does Cargo.lock fit the manifests?');
  const lock = JSON.parse(readFileSync(join(root, 'package-lock.json'), 'utf8'));
  const all = [...crateLicences(JSON.parse(metadata)), ...npmLicences(lock)];
  const bad = all.filter(({ licence }) => !licenceAllowed(licence));
  console.log(`${all.length} packages, ${bad.length} with a licence outside the list`);
  if (bad.length > 0)
    throw new Error(bad.map(({ name, licence }) => `${name}: ${licence ?? 'no licence named'}`).join('\n'));
});
