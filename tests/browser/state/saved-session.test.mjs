/** All pages' settings and one's own files as one file: saved, opened, dropped, and refused. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { strFromU8, strToU8, unzipSync, zipSync } from 'fflate';
import { drop, parameters, parametersWith, recording, recordings, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { leave, typeNumber } from '../lib/type.mjs';

const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');
const own = [
  { name: 'mine.bin', bytes: bin },
  { name: 'mine.cfg', bytes: cfg },
];
const SAVE = '[data-action="save-session"]';
const NOTICE = '[data-notice="session"]';
const calculated = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const processed = (page) => page.waitForSelector('[aria-busy="false"] [data-table="detections"]');
const open = (page, name) =>
  page.waitForFunction((wanted) => document.querySelector('.files')?.textContent.includes(wanted), name);
const go = (page, title) => page.locator('nav a', { hasText: title }).click();
const index = (bytes) => JSON.parse(strFromU8(unzipSync(bytes)['session.json']));

async function choose(page, name, bytes) {
  const [chooser] = await Promise.all([
    page.waitForEvent('filechooser'),
    page.locator('[data-action="open-session"]').click(),
  ]);
  await chooser.setFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });
}

async function withSnr(page, text) {
  await typeNumber(page.locator('input[name="snr"]'), text);
  await leave(page.locator('input[name="snr"]'));
  await parametersWith(page, (params) => params.get('snr') === text);
}

/** A session with the angle lab at 13.5 dB and one's own capture at one frame. */
async function sessionOf(page) {
  await calculated(page);
  await withSnr(page, '13.5');
  await drop(page, own);
  await open(page, 'mine.bin');
  await processed(page);
  await page.locator('input[name="frame"]').press('ArrowRight');
  await parametersWith(page, (params) => params.get('frame') !== 'all');
  return saved(page, SAVE);
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
    await other.waitForSelector('[data-action="open-session"]:enabled');
    await choose(other, name, bytes);
    await other.waitForFunction(() => location.hash.startsWith('#/capture'));
    await open(other, 'mine.bin');
    await processed(other);
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
    const { bytes } = await saved(page, SAVE);
    await page.evaluate(() => {
      location.hash = '#/angle?snr=3';
    });
    await parametersWith(page, (params) => params.get('snr') === '3');
    await page.waitForTimeout(900);
    // No file would be lost: it opens at once, and Undo takes it back.
    await drop(page, [{ name: 'lab.boresight', bytes }]);
    await parametersWith(page, (params) => params.get('snr') === '20');
    await page.keyboard.press('Control+z');
    await parametersWith(page, (params) => params.get('snr') === '3');

    await drop(page, own);
    await open(page, 'mine.bin');
    await processed(page);
    await drop(page, [{ name: 'lab.boresight', bytes }]);
    const question = page.locator('dialog[open]');
    await question.waitFor();
    assert.match(await question.innerText(), /lab\.boresight.*mine\.bin, mine\.cfg/s);
    assert.equal(await page.evaluate(() => document.activeElement.dataset.action), 'replace', 'the keyboard is in it');
    await page.keyboard.press('Escape');
    await question.waitFor({ state: 'hidden' });
    assert.match(page.url(), /#\/capture/);
    await open(page, 'mine.bin');

    await drop(page, [{ name: 'lab.boresight', bytes }]);
    await question.waitFor();
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => location.hash.startsWith('#/angle'));
    await parametersWith(page, (params) => params.get('snr') === '20');
    await go(page, 'Capture');
    await open(page, 'xwr16xx');
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
    await page.waitForSelector('[data-action="save-session"]:enabled');
    await drop(page, drive);
    await open(page, 'front_radar.csv.gz');
    await page.waitForFunction(() => document.querySelector('select[name="source"]')?.value === 'files');
    const model = readFileSync(new URL('../../../models/learned-pursuit.onnx', import.meta.url));
    await drop(page, [{ name: 'mine.onnx', bytes: model }]);
    await page.waitForSelector('[data-card="own:mine.onnx"]', { timeout: 90_000 });
    const { bytes } = await saved(page, SAVE);
    assert.deepEqual(
      index(bytes).files.map(({ page, name, bytes }) => [page, name, bytes]),
      [...drive.map(({ name, bytes }) => ['mounting', name, bytes.length]), ['networks', 'mine.onnx', model.length]],
    );
    const context = await browser.newContext();
    const other = await context.newPage();
    await other.goto(`${url}#/angle`);
    await calculated(other);
    await drop(other, [{ name: 'all.boresight', bytes }]);
    await other.waitForSelector('[data-card="own:mine.onnx"]', { timeout: 90_000 });
    await go(other, 'Mounting angle');
    await open(other, 'front_radar.csv.gz');
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
      await page.waitForSelector(NOTICE);
      const text = await page.locator(NOTICE).innerText();
      assert.match(text, /^The session was not opened\./, name);
      assert.match(text, says, name);
      await page.locator(`${NOTICE} button`).click();
      assert.equal(await page.locator('dialog[open]').count(), 0, name);
      assert.equal(parameters(page).toString(), before, name);
      await open(page, 'mine.bin');
    }
    await drop(page, [
      { name: 'a.boresight', bytes },
      { name: 'b.boresight', bytes },
    ]);
    await page.waitForSelector(NOTICE);
    assert.match(await page.locator(NOTICE).innerText(), /alone/);
  },
);

/** An archive whose directory says that its first entry unpacks to 4 GB. */
function lying(archive) {
  const bytes = Buffer.from(archive);
  const directory = bytes.indexOf(Buffer.from([0x50, 0x4b, 1, 2]));
  bytes.writeUInt32LE(0xfffffff0, directory + 24);
  return bytes;
}
