/** What “Copy as code” of the demo is made of: literals of JavaScript, words of the shell, flags. */
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import fc from 'fast-check';
import { runnerImport } from 'vite';
import { root } from '../../scripts/lib/paths.mjs';

const load = async (name) => {
  const { module } = await runnerImport(join(root, 'web', 'app', 'code', `${name}.ts`), { configFile: false, root });
  return module;
};
const [{ call, expression, literal, numeral, quoted }, { command, fileWord, flagged, heredoc, shellWord }, options] =
  await Promise.all(['literal', 'shell', 'options'].map(load));
const { flags, pairs, withoutDefaults } = options;

const HOSTILE = [
  "it's.bin",
  'two words.bin',
  'a "quoted" name',
  'line\nbreak.cfg',
  '`touch gone`',
  '$(touch gone) $HOME $' + '{x}',
  '-rf',
  '--config',
  'back\\slash\\n',
  '!history!',
  'tab\tand\rreturn',
  '~/home',
  '#comment',
  'a;b&&c|d>e<f',
  '*?[a-z]{b,c}',
  '=equals',
  'ünïcödé 雷达.bin',
  '\u2028\u2029\u0000\u007f\u200e',
  '',
];
/** Those that can be a word of a command. */
const WORDS = HOSTILE.filter((text) => !text.includes('\0'));

const evaluated = (text, names = {}) =>
  new Function(...Object.keys(names), `'use strict'; return (${text});`)(...Object.values(names));

test('code: texts stand in JavaScript as they are', () => {
  for (const text of [...HOSTILE, "\\'", '\ud800', '😀', '</script>']) {
    assert.equal(evaluated(quoted(text)), text);
    assert.ok(/^'[^\n\r\u2028\u2029\0]*'$/.test(quoted(text)), quoted(text));
    assert.deepEqual(evaluated(literal({ [text]: [text] })), { [text]: [text] });
  }
});

test('code: numbers keep every bit', () => {
  const numbers = [0, -0, 1e-9, -1e-9, 0.1 + 0.2, 5e-324, 1.7976931348623157e308, 1e21, NaN, Infinity, -Infinity];
  for (const value of numbers) {
    assert.ok(Object.is(evaluated(numeral(value)), value), numeral(value));
    assert.ok(Object.is(evaluated(literal([value]))[0], value));
  }
  assert.equal(literal(2n ** 64n - 1n), '18446744073709551615n');
  assert.equal(literal({ seed: -1n }), '{ seed: -1n }');
});

test('code: any value is read back, and long ones take lines of at most 100 columns', () => {
  const values = fc.letrec((tie) => ({
    value: fc.oneof(
      { maxDepth: 4 },
      fc.double(),
      fc.string({ unit: 'binary', maxLength: 20 }),
      fc.boolean(),
      fc.bigInt(),
      fc.constant(null),
      fc.float64Array({ maxLength: 30 }),
      fc.array(tie('value'), { maxLength: 6 }),
      fc.dictionary(fc.string({ unit: 'binary', maxLength: 8 }), tie('value'), { maxKeys: 6 }),
    ),
  })).value;
  fc.assert(
    fc.property(values, (value) => {
      const text = literal(value);
      // A dictionary has no prototype.
      assert.deepEqual(evaluated(text), structuredClone(value));
    }),
    { numRuns: 500 },
  );
  const long = { positions: Array.from({ length: 48 }, (_, i) => [0, i / 3, 0]), method: 'iaa', on: true };
  assert.deepEqual(evaluated(literal(long)), long);
  for (const line of literal(long).split('\n')) assert.ok(line.length <= 100, line);
});

test('code: keys go without quotes, what is absent is left out, and code stands as it is', () => {
  assert.equal(literal({ snrDb: 20, gone: undefined, 'a-b': 1, 1: 2 }), "{ 1: 2, snrDb: 20, 'a-b': 1 }");
  assert.equal(literal({ array: expression('array'), more: expression('...options') }), '{ array, ...options }');
  const hostile = JSON.parse('{"__proto__": {"polluted": 1}}');
  assert.deepEqual(Object.entries(evaluated(literal(hostile))), [['__proto__', { polluted: 1 }]]);
  assert.equal(call('f', [1, 'a']), "f(1, 'a');");
  const given = [expression('input'), { text: 'x'.repeat(60), other: 'y'.repeat(40) }];
  assert.equal(call('f', given), `f(input, {\n  text: '${'x'.repeat(60)}',\n  other: '${'y'.repeat(40)}',\n});`);
});

const inShell = (text) => execFileSync('bash', ['-c', text], { encoding: 'utf8' });

test('code: words stand in the shell as they are, on however many lines', () => {
  for (const word of WORDS) assert.equal(inShell(`printf %s ${shellWord(word)}`), word, shellWord(word));
  const words = ['printf', '%s\\0', ...WORDS, ...Array.from({ length: 40 }, (_, i) => `--flag-${i}`)];
  const text = command(words);
  assert.ok(text.split('\n').length > 5);
  assert.deepEqual(inShell(text).split('\0').slice(0, -1), words.slice(2));
  fc.assert(
    fc.property(
      fc.array(
        fc.string({ unit: 'grapheme' }).filter((word) => !word.includes('\0')),
        { minLength: 1 },
      ),
      (given) => {
        assert.deepEqual(
          inShell(command(['printf', '%s\\0', ...given]))
            .split('\0')
            .slice(0, -1),
          given,
        );
      },
    ),
    { numRuns: 60 },
  );
});

test('code: no file is taken for a flag, and no value either', () => {
  assert.equal(fileWord('-rf'), './-rf');
  assert.equal(fileWord('a-b.bin'), 'a-b.bin');
  assert.deepEqual(flagged('azimuth', '-5'), ['--azimuth=-5']);
  assert.deepEqual(flagged('azimuth', '5'), ['--azimuth', '5']);
  const text = 'a $HOME `b`\nc \\ d';
  assert.equal(inShell(`cd "$(mktemp -d)" && ${heredoc("it's -a.cfg", text)}\ncat *`), `${text}\n`);
});

test('code: what is so by default is left out, but what means something else', () => {
  const chain = {
    rangeWindow: 'hann',
    cfar: { kind: 'excision', falseAlarm: 1e-6, guardCells: [4, 2] },
    peakGrouping: true,
    angle: { method: 'bartlett', nomp: { oversampling: 4 } },
  };
  assert.deepEqual(withoutDefaults('DetectionOptions', chain), {});
  const other = { ...chain, cfar: { ...chain.cfar, guardCells: [4, 3] }, peakGrouping: false };
  assert.deepEqual(withoutDefaults('DetectionOptions', other), { cfar: { guardCells: [4, 3] }, peakGrouping: false });
  // Required.
  assert.deepEqual(withoutDefaults('BoundRequest', { snapshots: 1, kind: 'deterministic' }), { snapshots: 1 });
  assert.deepEqual(withoutDefaults('CalibrationOptions', { yM: 0, alarmDeg: 1 }, ['yM']), { yM: 0 });
});

test('code: flags are those of the schema', () => {
  const chain = {
    rangeWindow: 'hamming',
    cfar: { falseAlarm: 1e-9, trainingCells: [8, 5] },
    peakGrouping: false,
    staticClutterRemoval: true,
    region: { azimuthDeg: [-60, 60], rangeM: [0, 1e6] },
  };
  assert.deepEqual(flags('DetectionOptions', chain), [
    '--range-window',
    'hamming',
    '--cfar-false-alarm',
    '1e-9',
    '--cfar-training-cells',
    '8,5',
    '--no-peak-grouping',
    '--static-clutter-removal',
    '--region-azimuth=-60,60',
    '--region-range',
    '0,1000000',
  ]);
  assert.deepEqual(flags('SharedEstimatorOptions', { iaa: { thresholdDb: 30 }, sources: 'aic' }), [
    '--iaa-threshold',
    '30',
    '--sources',
    'aic',
  ]);
  assert.deepEqual(flags('DetectionOptions.angle', { method: 'music' }), ['--method', 'music']);
  assert.deepEqual(flags('SceneSampling', { count: [2, 2] }, [], 'random-'), ['--random-count', '2,2']);
  assert.deepEqual(flags('SnapshotRequest', { seed: 18446744073709551615n }), ['--seed', '18446744073709551615']);
  assert.deepEqual(flags('SnapshotRequest', { seed: 0, imperfections: { couplingDb: -0 } }), [
    '--seed',
    '0',
    '--imperfections-coupling=-0',
  ]);
  assert.equal(pairs('SnapshotTarget', { azimuthDeg: 0, powerDb: -3 }, ['azimuthDeg']), 'azimuth=0,power=-3');
  assert.throws(() => flags('DetectionOptions', { unknown: 1 }), /have no unknown/);
});
