// Sets up, builds and serves the demo, and then builds the module of networks, with which the page reloads.
// `--dev` serves the demo's sources with reloading; other arguments go to Vite (`npm start -- --port 8000 --open`).
import { buildDemo, buildLibrary, buildQuickly } from './build.mjs';
import { buildNetworks, networksMissing, withoutNetworks } from './lib/build/networks-later.mjs';
import { environment } from './lib/paths.mjs';
import { main, run } from './lib/run.mjs';
import { javascriptPackages, rust, wasmBindgen } from './setup.mjs';

await main(async () => {
  const args = process.argv.slice(2);
  const dev = args.includes('--dev');
  const passed = args.filter((argument) => argument !== '--dev');
  await rust();
  // Packages come over the network while crates are compiled.
  const tools = Promise.all([javascriptPackages(), wasmBindgen()]);
  await Promise.all([tools, buildQuickly(tools)]);
  const missing = networksMissing();
  const variables = missing ? withoutNetworks : {};
  await buildLibrary();
  if (!dev) await buildDemo(variables);
  console.log('start: serving the demo; press Ctrl+C to stop');
  const serving = run('vite', dev ? passed : ['preview', ...passed], { env: { ...environment, ...variables } });
  if (missing) void buildNetworks(dev);
  await serving;
});
