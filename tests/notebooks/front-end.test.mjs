// The front end's module with a model of anywidget and a component of Streamlit that are played, on an empty page.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { notebookFolder } from '../../scripts/lib/build/notebook.mjs';
import { root } from '../../scripts/lib/paths.mjs';
import { launch } from '../browser/lib/session.mjs';

let browser;
let page;
before(async () => {
  browser = await launch();
  page = await browser.newPage();
  await page.evaluate(
    async (text) => {
      const module = URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
      window.frontEnd = await import(module);
      window.frames_ = (count) =>
        count === 0 ? Promise.resolve() : new Promise(requestAnimationFrame).then(() => window.frames_(count - 1));
      const history = {
        timeS: Float64Array.of(0, 1),
        angleDeg: Float64Array.of(2, 2),
        sigmaDeg: Float64Array.of(0, 0),
      };
      window.history_ = frontEnd.pack(history);
      window.description = {
        tag: 'boresight-mounting-angle',
        attributes: { nominal_deg: 'nominal-deg', theme: 'theme' },
        properties: { history: 'history' },
        events: { 'boresight-alarm': 'alarm', 'boresight-cursor': 'cursor' },
      };
    },
    readFileSync(join(root, notebookFolder, 'widget.js'), 'utf8'),
  );
});
after(() => browser?.close());

test('a view of anywidget follows its model, tells it of events, and leaves nothing behind', async () => {
  const found = await page.evaluate(async () => {
    const values = new Map([
      ['_description', description],
      ['history', new DataView(history_.buffer)],
      ['theme', 'auto'],
    ]);
    const callbacks = new Map();
    let saves = 0;
    const model = {
      get: (name) => values.get(name) ?? null,
      set: (name, value) => values.set(name, value),
      save_changes: () => (saves += 1),
      on: (name, callback) => callbacks.set(name, (callbacks.get(name) ?? new Set()).add(callback)),
      off: (name, callback) => callbacks.get(name).delete(callback),
    };
    const change = (name, value) => {
      values.set(name, value);
      for (const callback of callbacks.get(`change:${name}`) ?? []) callback();
    };
    const el = document.body.appendChild(document.createElement('div'));
    const clear = (await frontEnd.default()).render({ model, el });
    const element = el.firstElementChild;
    await frames_(3);
    const said = element.shadowRoot.querySelector('.alternative').textContent;
    change('nominal_deg', 0);
    await frames_(3);
    const alarm = values.get('alarm');
    const before = saves;
    for (let x = 0; x < 5; x++) element.dispatchEvent(new CustomEvent('boresight-cursor', { detail: { x } }));
    await frames_(2);
    const cursor = { saves: saves - before, last: values.get('cursor') };
    change('nominal_deg', null);
    const without = element.hasAttribute('nominal-deg');
    el.style.background = 'rgb(20, 20, 20)';
    document.body.setAttribute('class', 'dark');
    await frames_(2);
    const theme = element.getAttribute('theme');
    clear();
    const left = [...callbacks.values()].reduce((sum, { size }) => sum + size, 0);
    return { said, alarm, cursor, without, theme, left, children: el.children.length };
  });
  assert.match(found.said, /After 1 s: \+2\.00°/);
  assert.deepEqual(found.alarm, { alarm: 'fail', angleDeg: 2, sigmaDeg: 0 });
  assert.deepEqual(found.cursor, { saves: 1, last: { x: 4 } });
  assert.equal(found.without, false);
  assert.equal(found.theme, 'dark');
  assert.deepEqual([found.left, found.children], [0, 0]);
});

test('runs of a Streamlit script change what they give otherwise, and nothing else', async () => {
  const found = await page.evaluate(async () => {
    const parentElement = document.body.appendChild(document.createElement('div')).attachShadow({ mode: 'open' });
    const states = {};
    const run = (attributes, history) =>
      frontEnd.default({
        data: frontEnd.pack({ ...description, attributes, properties: { history } }),
        parentElement,
        setStateValue: (name, value) => {
          states[name] = value;
        },
      });
    run({ 'nominal-deg': null }, history_);
    const element = parentElement.firstElementChild;
    let sets = 0;
    const { set, get } = Object.getOwnPropertyDescriptor(Object.getPrototypeOf(element), 'history');
    const counted = (value) => {
      sets += 1;
      set.call(element, value);
    };
    Object.defineProperty(element, 'history', { get, set: counted });
    element.setAttribute('nominal-deg', '1');
    run({ 'nominal-deg': null }, history_);
    const kept = [element.getAttribute('nominal-deg'), sets];
    const end = run({ 'nominal-deg': 3 }, frontEnd.pack({ timeS: [0], angleDeg: [3], sigmaDeg: [0] }));
    const changed = [element.getAttribute('nominal-deg'), sets];
    await frames_(3);
    element.dispatchEvent(new CustomEvent('boresight-cursor', { detail: { at: Float32Array.of(1.5) } }));
    await frames_(2);
    const bytes = Uint8Array.from(atob(states.cursor), (letter) => letter.charCodeAt(0));
    const { at } = frontEnd.unpack(bytes);
    const count = parentElement.children.length;
    end();
    return { kept, changed, alarm: states.alarm?.alarm, at: [...at], count, after: parentElement.children.length };
  });
  assert.deepEqual(found.kept, ['1', 0]);
  assert.deepEqual(found.changed, ['3', 1]);
  assert.equal(found.alarm, 'pass');
  assert.deepEqual([found.at, found.count, found.after], [[1.5], 1, 0]);
});
