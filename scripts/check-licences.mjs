// What the project stands on is under a licence on the list of deny.toml: crates, whose sources and versions cargo-deny
// checks too, and npm packages. With --advisories, known weaknesses of crates are looked up as well.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { parse } from 'smol-toml';
import { cargoTool } from './lib/cargo-tool.mjs';
import { licenceAllowed, npmLicences } from './lib/checks/licences.mjs';
import { root } from './lib/paths.mjs';
import { main, run } from './lib/run.mjs';

await main(async () => {
  await cargoTool('cargo-deny', 'cargo-deny', '0.20.2');
  const checks = ['licenses', 'bans', 'sources'];
  if (process.argv.includes('--advisories')) checks.push('advisories');
  else console.log('advisories: not looked up, which needs GitHub; `npm run check:licences -- --advisories` does');
  await run('cargo-deny', ['--locked', 'check', '--hide-inclusion-graph', ...checks]);

  const { licenses } = parse(readFileSync(join(root, 'deny.toml'), 'utf8'));
  const packages = npmLicences(JSON.parse(readFileSync(join(root, 'package-lock.json'), 'utf8')));
  const bad = packages.filter(({ licence }) => !licenceAllowed(licence, licenses.allow));
  console.log(`${packages.length} npm packages, ${bad.length} with a licence outside the list`);
  if (bad.length > 0)
    throw new Error(bad.map(({ name, licence }) => `${name}: ${licence ?? 'no licence named'}`).join('\n'));
});
