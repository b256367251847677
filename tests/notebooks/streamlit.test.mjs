// The snippet of docs/notebooks.md that is of Streamlit, as an application.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { clickPlot, of, open, says, start, story, workFolder } from './lib/host.mjs';

let server;
let view;
before(async () => {
  const folder = workFolder();
  const more = `
files = ["front_radar.csv.gz", "pose_10hz.csv.gz"]
drive = radar.drive(files=files, sensor=1, method="least-squares", x_m=3, key="drive")
if drive.result:
    st.write(f"Angle: {drive.result['result']['angle_deg']:.2f} deg of {drive.result['history']['time_s'].size}")
when = "after a selection" if shown.selection else "before"
runs = st.session_state[when] = st.session_state.get(when, 0) + 1
st.write(f"Runs: {runs} {when}")
`;
  writeFileSync(join(folder, 'app.py'), of.streamlit.join('\n') + more);
  server = await start(folder, '_stcore/health', (port) => [
    'streamlit',
    'run',
    'app.py',
    '--server.headless=true',
    '--server.address=127.0.0.1',
    `--server.port=${port}`,
    '--theme.base=dark',
    '--browser.gatherUsageStats=false',
  ]);
  view = await open(server, '', { viewport: { width: 1280, height: 1600 } });
});
after(async () => {
  await view?.close();
  await server?.close();
});

const test = story(() => view);

test('an element shows the numbers of NumPy, dark as Streamlit is', async () => {
  const { page } = view;
  await says(page.locator('boresight-spectrum'), 'bartlett: no angle found.');
  await page.getByText('Selected:').waitFor();
  assert.equal(await page.locator('boresight-spectrum').getAttribute('theme'), 'dark');
  assert.equal(await page.locator('iframe').count(), 0);
});

test('a drive is calibrated once, and its arrays come back', async () => {
  const { page } = view;
  const told = page.getByText(/^Angle: /);
  await told.waitFor();
  assert.match(await told.textContent(), /^Angle: -[12]\.\d\d deg of [1-9]\d+$/);
  // Had the files been read again with each run, each result would run the script again.
  const runs = await page.getByText(/^Runs: /).textContent();
  assert.ok(Number(runs.split(' ')[1]) <= 6, runs);
});

test('a click runs the script again, and elements stay as they are', async () => {
  const { page } = view;
  const element = await page.locator('boresight-spectrum').elementHandle();
  await clickPlot(page, page.locator('boresight-spectrum'));
  await page.getByText('"index"').waitFor();
  // The last that the script writes, and what it changed is drawn.
  await page.getByText('Runs: 1 after a selection').waitFor();
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  // The drive told its element the nominal angle, which the runs since have not taken away.
  assert.equal(await page.locator('boresight-drive [part="verdict"]').textContent(), 'out of tolerance');
  await view.screenshot('streamlit-dark');
  assert.ok(await element.evaluate((made) => made.isConnected));
});

test('nothing left the machine, and nothing failed in the page', () => {
  assert.deepEqual(view.outside, []);
  assert.deepEqual(view.problems, []);
});
