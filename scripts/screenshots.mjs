// Pictures of every page of the demo, at both widths and in both schemes, in tests/.output.
import { buildDemo, buildPackage } from './build.mjs';
import { main } from './lib/run.mjs';
import { setup } from './setup.mjs';

await main(async () => {
  await setup();
  await buildPackage();
  await buildDemo();
  const { launch, openPage, schemes, serve, viewports } = await import('../tests/browser/lib/session.mjs');
  const { pages } = await import('../tests/browser/lib/pages.mjs');
  const server = await serve();
  const browser = await launch();
  let problems = 0;
  for (const { name, path, ready } of pages) {
    for (const viewport of Object.keys(viewports)) {
      for (const scheme of schemes) {
        const opened = await openPage(browser, server.url, { path, viewport, scheme });
        await opened.page.waitForSelector(ready);
        console.log(await opened.screenshot(name, { fullPage: true }));
        for (const problem of opened.problems) console.error(`  ${problem}`);
        problems += opened.problems.length;
        await opened.close();
      }
    }
  }
  await browser.close();
  await server.close();
  if (problems > 0) throw new Error(`${problems} problems on the pages`);
});
