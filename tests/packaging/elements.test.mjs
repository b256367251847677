// boresight/elements in an empty project: bundled by Vite, read by a server, and typed.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch, openPage, serve } from '../browser/lib/session.mjs';
import { consumer } from './consumer.mjs';

let project;
before(async () => {
  project = await consumer({
    tools: ['vite', 'typescript'],
    files: {
      'index.html': `<!doctype html><link rel="icon" href="data:,"><title>dashboard</title>
        <boresight-spectrum heading="Two targets"></boresight-spectrum><script type="module" src="./page.js"></script>`,
      'page.js': `
        import 'boresight/elements';
        import { estimate, init, simulateSnapshots } from 'boresight';
        await init();
        const targets = [{ azimuthDeg: -12 }, { azimuthDeg: 20 }];
        const { data, shape } = simulateSnapshots({ array: 'ula8', targets, snapshots: 50, snrDb: 20, seed: 1 });
        const snapshots = { data, shape: shape.slice(-2) };
        const element = document.querySelector('boresight-spectrum');
        element.estimates = estimate({ snapshots }, { array: 'ula8', method: 'music', sources: 2 });
      `,
      'typed.ts': `
        import { define, type JsxElements, type MountingAngleElement, type OwnDrawing } from 'boresight/elements';
        define();
        const made = document.createElement('boresight-mounting-angle');
        const angle: MountingAngleElement = made;
        angle.add(1, { angleDeg: 2, sigmaDeg: 0.1 });
        const attributes: JsxElements['boresight-spectrum'] = { heading: 'A', truthDeg: [1], 'floor-db': 40 };
        const own: OwnDrawing = {
          axes: { x: { label: 'Time (s)' }, y: { label: 'Level (dB)' } },
          content: { x: [0, 1], series: [], extent: { x: [0, 1], y: [0, 1] }, above: [({ ctx, x }) => ctx.lineTo(x(0), 1)] },
          readout: ({ x }) => String(x),
        };
        document.createElement('boresight-plot').drawing = own;
        // @ts-expect-error an axis has a label
        own.axes.x = {};
        made.setAttribute('heading', String(attributes['heading']));
        // @ts-expect-error the angle is missing
        angle.add(1, { sigmaDeg: 0.1 });
        // @ts-expect-error what draws is the element's own
        angle.draw();
      `,
      'tsconfig.json': JSON.stringify({
        compilerOptions: {
          target: 'es2022',
          lib: ['esnext', 'dom', 'dom.iterable'],
          module: 'esnext',
          moduleResolution: 'bundler',
          strict: true,
          noEmit: true,
          types: [],
        },
        include: ['typed.ts'],
      }),
    },
  });
});
after(() => project?.remove());

test('a page bundled by Vite draws a spectrum', { skip: skipWithoutBrowser }, async () => {
  await project.run(project.bin('vite'), ['build', '--logLevel', 'error']);
  const browser = await launch();
  const server = await serve(project.folder, { build: { outDir: join(project.folder, 'dist') } });
  try {
    const { page, problems } = await openPage(browser, server.url);
    await page.waitForFunction(() => {
      const alternative = document.querySelector('boresight-spectrum').shadowRoot?.querySelector('.alternative');
      return /music: .*°, .*°/.test(alternative?.textContent ?? '');
    });
    assert.deepEqual(problems, []);
  } finally {
    await browser.close();
    await server.close();
  }
});

test('a server reads it and defines nothing', async () => {
  const { stdout } = await project.run(process.execPath, [
    '--input-type=module',
    '--eval',
    "const { define, elements } = await import('boresight/elements'); define(); console.log(Object.keys(elements).length)",
  ]);
  assert.equal(stdout.trim(), '10');
});

test('its types fit into a strict project', async () => {
  await project.run(project.bin('tsc'), []);
});
