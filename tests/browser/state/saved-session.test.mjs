/** All pages' settings and one's own files as one file: saved, opened, dropped, and refused. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { strFromU8, strToU8, unzipSync, zipSync } from 'fflate';
import { frameSlider, opened, ready } from '../capture/page.mjs';
import { button, choose, combobox, spinbutton } from '../lib/controls.mjs';
import { drop, parameters, parametersWith, recording, recordings, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { leave, typeNumber } from '../lib/type.mjs';
import { later } from './undo.mjs';

const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');
const own = [
  { name: 'mine.bin', bytes: bin },
  { name: 'mine.cfg', bytes: cfg },
];
/** A button of sessions; phones leave the second word out. */
const session = (page, name) =>
  page.getByRole('group', { name: 'Session', exact: true }).getByRole('button', { name: new RegExp(`^${name}`) });
const save = (page) => saved(page, session(page, 'Save'));
const calculated = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const go = (page, name) => page.getByRole('navigation').getByRole('link', { name }).click();
const hasNetwork = (page) => page.locator('[data-card="own:mine.onnx"]').waitFor({ timeout: 90_000 });
const index = (bytes) => JSON.parse(strFromU8(unzipSync(bytes)['session.json']));

async function withSnr(page, text) {
  await typeNumber(spinbutton(page, 'SNR'), text);
  await leave(spinbutton(page, 'SNR'));
  await parametersWith(page, (params) => params.get('snr') === text);
}

/** A session with the angle lab at 13.5 dB and one's own capture at one frame. */
async function sessionOf(page) {
  await calculated(page);
  await withSnr(page, '13.5');
  await drop(page, own);
  await opened(page, 'mine.bin');
  await ready(page);
  await frameSlider(page).press('ArrowRight');
  await parametersWith(page, (params) => params.get('frame') !== 'all');
  return save(page);
}

browserTest(
  'saved session: settings of all pages and one’s own files come back in another browser',
  { path: '#/angle' },
  async ({ page, browser, url }) => {
    const { name, bytes } = await sessionOf(page);
    const frame = parameters(page).get('frame');
    assert.match(name, /^boresight-session-capture-\d{4}-\d\d-\d\d\.boresight$/);
    const archive = unzipSync(bytes);
    assert.deepEqual(Object.keys(archive).sort(), ['capture/mine.bin', 'capture/mine.cfg', 'session.json']);
    assert.deepEqual(Buffer.from(archive['capture/mine.bin']), bin);
    assert.match(index(bytes).settings.angle, /snr=13\.5/);
    assert.ok(bytes.length < bin.length + cfg.length + 4000, 'settings take little');

    const context = await browser.newContext();
    const other = await context.newPage();
    await other.goto(`${url}#/networks`);
    await choose(other, session(other, 'Open'), [{ name, bytes }]);
    await other.waitForURL(/#\/capture/);
    await opened(other, 'mine.bin');
    await ready(other);
    await parametersWith(other, (params) => params.get('frame') === frame && params.get('source') === 'files');
    assert.equal(await other.locator('[data-notice]').count(), 0);
    await go(other, 'Angle lab');
    await parametersWith(other, (params) => params.get('snr') === '13.5');
    await context.close();
  },
);

browserTest(
  'saved session: it is dropped anywhere, asks before it closes one’s own files, and is undone',
  { path: '#/angle', viewport: 'phone' },
  async ({ page }) => {
    await calculated(page);
    const { bytes } = await save(page);
    await page.evaluate(() => {
      location.hash = '#/angle?snr=3';
    });
    // With the other parameters, which the page writes behind it.
    await parametersWith(page, (params) => params.get('snr') === '3' && params.has('seed'));
    await later(page);
    // No file would be lost: it opens at once, and Undo takes it back.
    await drop(page, [{ name: 'lab.boresight', bytes }]);
    await parametersWith(page, (params) => params.get('snr') === '20');
    await page.keyboard.press('Control+z');
    await parametersWith(page, (params) => params.get('snr') === '3');

    await drop(page, own);
    await opened(page, 'mine.bin');
    await ready(page);
    await drop(page, [{ name: 'lab.boresight', bytes }]);
    const question = page.getByRole('dialog', { name: 'Replace your own files?' });
    await question.waitFor();
    assert.match(await question.innerText(), /lab\.boresight.*mine\.bin, mine\.cfg/s);
    assert.equal(await page.locator(':focus').innerText(), 'Open the session', 'the keyboard is in it');
    await page.keyboard.press('Escape');
    await question.waitFor({ state: 'hidden' });
    assert.match(page.url(), /#\/capture/);
    await opened(page, 'mine.bin');

    await drop(page, [{ name: 'lab.boresight', bytes }]);
    await question.waitFor();
    await page.keyboard.press('Enter');
    await page.waitForURL(/#\/angle/);
    await parametersWith(page, (params) => params.get('snr') === '20');
    await go(page, 'Capture');
    await opened(page, 'xwr16xx');
    await parametersWith(page, (params) => (params.get('source') ?? 'bundled') === 'bundled');
  },
);

browserTest(
  'saved session: a drive and a network of one’s own are in it',
  { path: '#/mounting', timeout: 200_000 },
  async ({ page, browser, url }) => {
    const drive = ['front_radar.csv.gz', 'pose_10hz.csv.gz'].map((name) => ({
      name,
      bytes: readFileSync(join(recordings('delphi'), name)),
    }));
    await session(page, 'Save').and(page.locator(':enabled')).waitFor();
    await drop(page, drive);
    await opened(page, 'front_radar.csv.gz');
    await combobox(page, 'Drive').locator('option:checked', { hasText: 'own files' }).waitFor({ state: 'attached' });
    const model = readFileSync(new URL('../../../models/learned-pursuit.onnx', import.meta.url));
    await drop(page, [{ name: 'mine.onnx', bytes: model }]);
    await hasNetwork(page);
    const { bytes } = await save(page);
    assert.deepEqual(
      index(bytes).files.map(({ page, name, bytes }) => [page, name, bytes]),
      [...drive.map(({ name, bytes }) => ['mounting', name, bytes.length]), ['networks', 'mine.onnx', model.length]],
    );
    const context = await browser.newContext();
    const other = await context.newPage();
    await other.goto(`${url}#/angle`);
    await calculated(other);
    await drop(other, [{ name: 'all.boresight', bytes }]);
    await hasNetwork(other);
    await go(other, 'Mounting angle');
    await opened(other, 'front_radar.csv.gz');
    await parametersWith(other, (params) => params.get('source') === 'files');
    await context.close();
  },
);

browserTest(
  'saved session: what is no session, damaged, too new or too large is refused, and nothing changes',
  { path: '#/angle' },
  async ({ page }) => {
    const { bytes } = await sessionOf(page);
    const archive = unzipSync(bytes);
    const before = parameters(page).toString();
    const notice = page.locator('[data-notice="session"]');
    const changed = (patch) => ({
      ...archive,
      'session.json': strToU8(JSON.stringify({ ...index(bytes), ...patch })),
    });
    const flipped = Uint8Array.from(archive['capture/mine.bin']);
    flipped[1000] ^= 1;
    const { 'capture/mine.cfg': _, ...cut } = archive;
    for (const [name, content, says] of [
      ['holiday.boresight', Buffer.from('\x89PNG no archive'), /holiday\.boresight.*no session/],
      ['cut.boresight', bytes.subarray(0, bytes.length / 2), /cut off/],
      ['other.boresight', zipSync({ 'readme.txt': strToU8('hello') }), /another archive/],
      ['foreign.boresight', zipSync(changed({ format: 'other' })), /another archive/],
      ['new.boresight', zipSync(changed({ version: 2, made: 'Boresight 9.9.9' })), /Boresight 9\.9\.9.*reload/],
      ['pages.boresight', zipSync(changed({ settings: { kitchen: 'sink' } })), /damaged/],
      ['text.boresight', zipSync({ ...archive, 'session.json': strToU8('{') }), /session\.json cannot be read/],
      ['missing.boresight', zipSync(cut), /mine\.cfg is not in it/],
      ['flipped.boresight', zipSync({ ...archive, 'capture/mine.bin': flipped }), /mine\.bin is not what was saved/],
      ['bomb.boresight', lying(zipSync(archive)), /MiB; at most 1024 MiB/],
      ['index.boresight', zipSync({ 'session.json': new Uint8Array(2 * 1024 * 1024) }), /damaged: session\.json has/],
    ]) {
      await drop(page, [{ name, bytes: content }]);
      const text = await notice.innerText();
      assert.match(text, /^The session was not opened\./, name);
      assert.match(text, says, name);
      await button(notice, 'Put this message away').click();
      await notice.waitFor({ state: 'detached' });
      assert.equal(await page.getByRole('dialog').count(), 0, name);
      assert.equal(parameters(page).toString(), before, name);
      await opened(page, 'mine.bin');
    }
    await drop(page, [
      { name: 'a.boresight', bytes },
      { name: 'b.boresight', bytes },
    ]);
    assert.match(await notice.innerText(), /alone/);
  },
);

/** An archive whose directory says that its first entry unpacks to 4 GB. */
function lying(archive) {
  const bytes = Buffer.from(archive);
  const directory = bytes.indexOf(Buffer.from([0x50, 0x4b, 1, 2]));
  bytes.writeUInt32LE(0xfffffff0, directory + 24);
  return bytes;
}
