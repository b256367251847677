// Values through both ends of the codec: packed by Python, opened and packed by the front end, opened by Python.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { notebookFolder } from '../../scripts/lib/build/notebook.mjs';
import { root } from '../../scripts/lib/paths.mjs';
import { python } from './lib/host.mjs';

const { pack, unpack } = await import(pathToFileURL(join(root, notebookFolder, 'widget.js')).href);

const VALUE = `{
  "kinds": [np.array([0, 1, 100], k) for k in ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")],
  "long": np.array([1, 2]), "complex": np.array([1 + 2j]), "wide": np.array([2**40]), "none": np.array([]),
  "numbers": [float("nan"), float("inf"), float("-inf"), 1.5, 3], "text": "ä", "null": None, "yes": True,
  "records": codec.Records(a=np.array([1, 2]), b=np.array([3.5, 4.5])), "bytes": b"\\x00\\xff",
}`;

function run(code, input) {
  const text = `import sys, numpy as np\nfrom boresight_widget import codec\n${code}`;
  const { status, stdout, stderr } = spawnSync(python, ['-c', text], { input });
  assert.equal(status, 0, String(stderr));
  return stdout;
}

test('both ends of the codec agree', () => {
  const packed = run(`sys.stdout.buffer.write(codec.pack(${VALUE}))`);
  // At an odd place of a larger buffer, as messages come.
  const message = new Uint8Array(packed.length + 3);
  message.set(packed, 3);
  const value = unpack(message.subarray(3));
  const made = [Int8Array, Uint8Array, Int16Array, Uint16Array, Int32Array, Uint32Array, Float32Array, Float64Array];
  assert.deepEqual(
    value.kinds,
    made.map((kind) => kind.of(0, 1, 100)),
  );
  assert.deepEqual(value.long, Int32Array.of(1, 2));
  assert.deepEqual(value.complex, Float64Array.of(1, 2));
  assert.deepEqual(value.wide, Float64Array.of(2 ** 40));
  assert.deepEqual(value.numbers, [Number.NaN, Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY, 1.5, 3]);
  assert.deepEqual(value.records, [
    { a: 1, b: 3.5 },
    { a: 2, b: 4.5 },
  ]);
  assert.deepEqual(value.bytes, Uint8Array.of(0, 255));
  assert.deepEqual([value.text, value.null, value.yes, value.none.length], ['ä', null, true, 0]);
  assert.notEqual(value.bytes.buffer, message.buffer, 'arrays hold on to no message');

  const back = run(
    `a, b = codec.unpack(sys.stdin.buffer.read()), codec.unpack(codec.pack(${VALUE}))
assert repr(a) == repr(b), (a, b)
assert [x.dtype for x in a["kinds"]] == [x.dtype for x in b["kinds"]]
print("same")`,
    pack(value),
  );
  assert.equal(String(back).trim(), 'same');
});
