import assert from 'node:assert/strict';
import { test } from 'node:test';
import { cycles, importsOf, moduleProblems } from '../../scripts/lib/checks/module-imports.mjs';

const imports = (sources) => importsOf(new Map(Object.entries(sources)));

test('imports are found in groups, above, and inline, and not in comments and tests', () => {
  const found = imports({
    '': 'mod data;',
    data: 'use crate::estimators::{self, iaa::{Iaa, fourier}, missing::X};\nfn f() { crate::error::wrong() }',
    error:
      '//! See [`crate::data`].\npub(crate) fn wrong() {}\n#[cfg(test)]\n#[allow(x)]\nmod tests {\n    use crate::data;\n}\n',
    estimators: '',
    'estimators/iaa': 'use super::Plan;',
    'estimators/iaa/fourier': 'use super::super::music;\nuse super::Iaa;',
    'estimators/music': 'use crate::AoaError;',
  });
  const of = (module) => [...found.get(module)].sort();
  assert.deepEqual(of('data'), ['error', 'estimators', 'estimators/iaa', 'estimators/iaa/fourier']);
  assert.deepEqual(of('error'), []);
  assert.deepEqual(of('estimators/iaa'), ['estimators']);
  assert.deepEqual(of('estimators/iaa/fourier'), ['estimators/iaa', 'estimators/music']);
  assert.deepEqual(of('estimators/music'), ['']);
});

test('modules that import from each other are one group, whatever the way around', () => {
  const found = imports({ a: 'use crate::b;', b: 'use crate::c;', c: 'use crate::a;', d: 'use crate::a;' });
  assert.deepEqual(
    cycles(found).map((group) => group.sort()),
    [['a', 'b', 'c']],
  );
  assert.deepEqual(cycles(imports({ a: 'use crate::b;', b: '' })), []);
});

test('a cycle of two files passes; a longer one and an import from lib.rs do not', () => {
  const check = (sources) => moduleProblems('aoa', new Map(Object.entries(sources)));
  assert.deepEqual(check({ '': '', a: 'use crate::b;', b: 'use crate::a;' }), []);
  assert.deepEqual(check({ '': '', a: 'use crate::b;', b: 'use crate::c;', c: 'use crate::a;' }), [
    'aoa: a, b, c import from each other',
  ]);
  assert.match(check({ '': '', a: 'use crate::Array;' })[0], /^aoa: a imports from lib\.rs/);
});
