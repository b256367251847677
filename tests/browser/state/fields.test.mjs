/** Every field of numbers of every page takes what is typed, and nothing that was not. */
import assert from 'node:assert/strict';
import { button, spinbutton } from '../lib/controls.mjs';
import { parametersWith, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';
import { leave, typeNumber } from '../lib/type.mjs';

/** The first two that fit a field are typed into it. */
const TEXTS = ['-7.25', '0.5', '-0.05', '1.5', '12', '7', '100', '1024'];

/** Pages in states that show all their fields, with one quick method: the typing is work enough. */
const states = {
  'angle lab': ['?methods=bartlett'],
  capture: ['?methods=bartlett', '?methods=bartlett&axes=both&cfar=ordered-statistic'],
  'mounting angle': ['?source=simulated&duration=10&methods=weighted-mean'],
  'birds-eye view': ['?methods=bartlett'],
  networks: [''],
  live: ['', '?source=raw'],
  elements: ['?element=boresight-spectrum', '?element=boresight-mounting-angle'],
};
const tried = pages.flatMap(({ name, path }) =>
  states[name].map((state) => ({ name: `${name}${state}`, path: path.split('?')[0] + state })),
);

/** Fields that were tried, by page: another state of a page shows most of them again. */
const done = new Map();

for (const { name, path } of tried) {
  browserTest(`${name}: numbers are typed key by key`, { path }, async ({ page }) => {
    const fields = page.getByRole('spinbutton', { disabled: false });
    await fields.first().waitFor();
    // What a radar of the drive brings comes with the drive.
    if (path.startsWith('#/mounting')) await spinbutton(page, 'Ahead of rear axle').waitFor();
    const shut = page.locator('details.group:not([open]) > summary');
    while ((await shut.count()) > 0) await shut.first().click();
    const names = await fields.evaluateAll((list) => list.map((input) => input.name));
    const native = await page.locator('input[type="number"]').count();
    assert.equal(native, 0, 'the browser’s own fields of numbers hide what is wrong with a text');
    assert.ok(names.length > 0 && new Set(names).size === names.length, `each field has a name: ${names}`);
    // Elements have options of their own, whatever their names.
    const of = path.startsWith('#/elements') ? path : path.split('?')[0];
    const known = done.get(of) ?? done.set(of, new Set()).get(of);
    for (const field of names) {
      if (known.has(field)) continue;
      // All of them, whatever their labels: those come and go as others change.
      await tryField(page.locator(`input[name="${field}"]`));
      known.add(field);
    }
  });
}

async function tryField(field) {
  const { name, min, max, integer } = await field.evaluate((input) => ({
    name: input.name,
    min: Number(input.ariaValueMin),
    max: Number(input.ariaValueMax ?? Number.POSITIVE_INFINITY),
    integer: input.dataset.integer !== undefined,
  }));
  const before = await field.inputValue();
  const fits = (text) => Number(text) >= min && Number(text) <= max && (!integer || Number.isInteger(Number(text)));
  const valid = TEXTS.filter(fits).slice(0, 2);
  assert.ok(valid.length > 0, `${name} from ${min} to ${max} can be tried`);
  for (const text of valid) {
    await typeNumber(field, text);
    const { now, invalid } = await stateOf(field);
    assert.ok(Math.abs(now - Number(text)) < 1e-9 && invalid === null, `${text} counts in ${name}, not ${now}`);
  }
  await leave(field);
  const { now: value } = await stateOf(field);
  for (const text of [Number.isFinite(max) ? `${max}1` : '-1', '1,5']) {
    await typeNumber(field, text);
    await leave(field);
    const state = await stateOf(field);
    assert.equal(await field.inputValue(), text, `${name} keeps what is wrong as it was typed`);
    assert.equal(state.invalid, 'true', `${text} in ${name}`);
    assert.match(state.reason, /^A (whole )?number (from|above) /, `${name} says why`);
    assert.equal(state.now, value, `the beginning of ${text} does not count in ${name}`);
  }
  await typeNumber(field, '');
  if (before === '') return;
  await typeNumber(field, before);
  await leave(field);
  const state = await stateOf(field);
  assert.deepEqual([await field.inputValue(), state.invalid], [before, null], `${name} is emptied and typed again`);
}

/** What a field says of itself. */
const stateOf = (field) =>
  field.evaluate((input) => ({
    now: Number(input.ariaValueNow),
    invalid: input.getAttribute('aria-invalid'),
    reason: document.getElementById(input.getAttribute('aria-describedby').split(' ').at(-1)).textContent,
  }));

browserTest(
  'angle lab: a typed target is the one that is estimated',
  { path: '#/angle?targets=-5:0&methods=music' },
  async ({ page }) => {
    const azimuth = spinbutton(page, 'Azimuth of target 1, degrees');
    for (const text of ['1.5', '-7.25', '0.5']) {
      await typeNumber(azimuth, text);
      await parametersWith(page, (params) => params.get('targets') === `${text}:0`);
    }
    await typeNumber(spinbutton(page, 'Power of target 1, dB'), '-0.05');
    await parametersWith(page, (params) => params.get('targets') === '0.5:-0.05');
    await leave(azimuth);
    await page.waitForFunction(() => Number(document.querySelector('[data-field="truth"]')?.dataset.value) === 0.5);
    assert.equal((await values(page, '[data-row="music"] [data-field="azimuth"]')).length, 1);
    // In the middle of a number, too.
    await azimuth.click();
    await azimuth.press('Home');
    await page.keyboard.press('-');
    await page.keyboard.press('1');
    assert.equal(await azimuth.inputValue(), '-10.5');
    assert.equal(await azimuth.evaluate((input) => input.selectionStart), 2);
    await azimuth.press('ArrowUp');
    assert.equal(await azimuth.inputValue(), '-10.4');
    await typeNumber(azimuth, '95');
    await azimuth.press('Escape');
    assert.equal(await azimuth.inputValue(), '-10.4');
  },
);

browserTest('angle lab: a group stays open while its error is typed', { path: '#/angle?gain=2' }, async ({ page }) => {
  await typeNumber(spinbutton(page, 'Gain error'), '0.5');
  await parametersWith(page, (params) => params.get('gain') === '0.5');
});

browserTest('angle lab: another state is not hidden by what was typed', { path: '#/angle?snr=7' }, async ({ page }) => {
  const snr = spinbutton(page, 'SNR');
  await typeNumber(snr, '999');
  assert.equal(await snr.getAttribute('aria-invalid'), 'true');
  await button(page, 'Defaults').click();
  await parametersWith(page, (params) => params.get('snr') === '20');
  assert.equal(await snr.inputValue(), '20');
  assert.equal(await snr.getAttribute('aria-invalid'), null);
});
