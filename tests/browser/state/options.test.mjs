/** The demo's controls of the package's options have the units, ranges, choices and defaults of the schema. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';
import { checkbox, spinbutton } from '../lib/controls.mjs';
import { browserTest } from '../lib/harness.mjs';

const { $defs } = JSON.parse(readFileSync(join(root, 'web', 'lib', 'generated', 'schema.json'), 'utf8'));

/** What a page has otherwise than the package. */
const DIFFERENCES = {
  angle: ['sources: default'],
  capture: [
    // Of an array that is not calibrated; networks were trained on exact ones.
    'countLoading: default, range',
    'regionWindow: default',
    'elevation: default, range',
    'guardDoppler: range',
    'guardRange: range',
    'sector: default, range',
    'trainDoppler: range',
    'trainRange: range',
    // The package names no default, and no range, of a region.
    'farthest: default, range',
    'nearest: default, range',
  ],
  mounting: [
    'duration: range',
    'misalignment: default, range',
    // Left to the method, and to the drive.
    'motion: default',
    'nominal: default',
    'xM: default',
    'yM: default',
  ],
  birdseye: ['grouping: default', 'sources: default'],
  networks: [],
};

/** Pages in states that show all their options. */
const STATES = {
  angle: '',
  capture: '?axes=both&cfar=ordered-statistic&methods=bartlett&reflectors=1:0:0',
  mounting: '?source=simulated&methods=weighted-mean',
  birdseye: '?methods=bartlett',
  networks: '',
};

function described(name) {
  const [record, ...path] = name.split('.');
  let at = $defs[record];
  for (const key of path) {
    const list = at.default;
    const entry = at.items ?? at.additionalProperties;
    at = at.properties?.[key] ?? { ...at, ...entry, default: Array.isArray(list) ? list[Number(key)] : undefined };
  }
  return at;
}

for (const page of Object.keys(DIFFERENCES)) {
  browserTest(
    `${page}: controls of options have unit, range, choices and default of the schema`,
    { path: `#/${page}${STATES[page]}` },
    async ({ page: tab }) => {
      await tab.locator('[data-option]').first().waitFor();
      if (page === 'capture') await checkbox(tab, 'Ranges are exact').waitFor();
      if (page === 'mounting') await spinbutton(tab, 'Ahead of rear axle').waitFor();
      const controls = await tab.locator('[data-option]').evaluateAll((list) =>
        list.map((one) => {
          const control = one.querySelector('input, select');
          return {
            key: control.name,
            option: one.dataset.option,
            unit: one.querySelector('.unit')?.textContent ?? '',
            value: control.type === 'checkbox' ? control.checked : control.value,
            choices: control.options && [...control.options].map(({ value }) => value),
            range: control.role === 'spinbutton' && [
              Number(control.ariaValueMin ?? '-Infinity'),
              Number(control.ariaValueMax ?? 'Infinity'),
            ],
            integer: control.dataset.integer !== undefined,
            help: one.querySelector('p:last-of-type').textContent,
          };
        }),
      );
      assert.deepEqual(
        controls.filter(({ option }) => !described(option)).map(({ option }) => option),
        [],
        'every option is one of the schema',
      );
      const asked = new URLSearchParams(STATES[page]);
      const different = controls
        .filter(({ key }) => !asked.has(key))
        .map((control) => [control.key, differences(control)]);
      assert.deepEqual(
        different
          .filter(([, what]) => what.length > 0)
          .map(([key, what]) => `${key}: ${what.join(', ')}`)
          .sort(),
        [...DIFFERENCES[page]].sort(),
      );
    },
  );
}

/** What a control has otherwise than the schema, where a page may have it so; fails where it may not. */
function differences({ key, option, unit, value, choices, range, integer, help }) {
  const schema = described(option);
  assert.ok(help.length > 0, `${key} is explained`);
  const [least, most] = limits(schema.anyOf?.[0] ?? schema);
  const found = [];
  if (range) {
    const scale = unit === '%' ? 100 : 1;
    if (scale === 1) assert.equal(unit, (schema['x-unit'] ?? '').replace('deg', '°'), `unit of ${key}`);
    assert.equal(integer, schema.type === 'integer', `whether ${key} is a whole number`);
    assert.ok(range[0] >= least * scale && range[1] <= most * scale, `${range} of ${key} is in the range of ${option}`);
    if (range[0] > least * scale || range[1] < most * scale) found.push('range');
  } else if (choices) {
    const known = schema.oneOf?.map((one) => one.const) ?? choices;
    assert.deepEqual(
      choices.filter((choice) => choice !== 'auto' && !known.includes(choice)),
      [],
      `choices of ${key} that ${option} has not`,
    );
    for (const number of choices.map(Number).filter((choice) => !Number.isNaN(choice))) {
      assert.ok(number >= least && number <= most, `${number} of ${key} is in the range of ${option}`);
    }
  }
  const usual = schema.default ?? '';
  const same = typeof usual === 'number' ? value !== '' && Number(value) === usual : value === usual;
  return same ? found : ['default', ...found];
}

const limits = ({ minimum, exclusiveMinimum, maximum }) => [
  minimum ?? exclusiveMinimum ?? Number.NEGATIVE_INFINITY,
  maximum ?? Number.POSITIVE_INFINITY,
];
