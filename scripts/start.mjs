// Sets up, builds and serves the demo. `--dev` serves its sources with reloading; other arguments
// go to Vite (for example `npm start -- --port 8000 --open`).
import { buildDemo, buildPackage } from './build.mjs';
import { main, run } from './lib/run.mjs';
import { setup } from './setup.mjs';

await main(async () => {
  const args = process.argv.slice(2);
  const dev = args.includes('--dev');
  const passed = args.filter((argument) => argument !== '--dev');
  await setup({ wasmPack: false });
  await buildPackage();
  if (!dev) await buildDemo();
  console.log('start: serving the demo; press Ctrl+C to stop');
  await run('vite', dev ? passed : ['preview', ...passed]);
});
