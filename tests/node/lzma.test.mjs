// What scripts/lib/lzma.mjs packs is LZMA, and the package opens it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as lzma from '../../dist/lib/runtime/lzma.js';
import { generator } from '../../scripts/lib/generator.mjs';
import { pack } from '../../scripts/lib/lzma.mjs';

const opened = (packed, length) => {
  const out = new Uint8Array(length);
  lzma.unpacker(packed, out)(length);
  return Buffer.from(out);
};

const sentence = Array.from({ length: 300 }, (_, k) => `${(k * k) % 97} frames of ${k % 7} radars; `).join('');
/** Of XZ Utils, by Python: lzma.compress(sentence, FORMAT_RAW, [{'id': FILTER_LZMA1, 'preset': 9, 'lc': 4, 'lp': 0, 'pb': 0}]). */
const theirs = `
ABgISf2aLajI3zKDO4RUueGQCldRzaAzRsIM/vMjWqIFZsnV5uRJtDo6UXBMgaafnW1kiATbkSgpfxiNEQ34Qk4+uJDUfSZexlIm
5cZK4QCXGTY0Pp/VP1S2LsJIw3umtLn++wGKABH6Ie5Cbj6qUEYZ9LWYeVZIyaHZV58vnKaDHvaQMFsKxaLiDlmtislNv11cLyhM
yxuWq0HW5FP2BPrM3gajOLlGggc1BbNn8rXyDhCq97tAKVIuJ0X3gGQLiZBp8wG74xI1RXMuJY958YanndWMPKLO34WcAo8/w1EH
MCbvb7qgcggUXi3JZ2rIRmXMQUvEBYpST4ryhZ2QUWfF0GYUNn/PHuQRzqm177zmmhBwAWGwOIOOIYR+nw4MnNDeknFcRo+Wx0fK
lwBh2KVp+5KRBVYAwebjaz+gBj+o39MX9w58yanaV4lfQfM9GZVNrNkNQc3B2ybzck3iPWuT6x6zNztctptPJG8iUHACBLwNfTyP
c31sHj/Bz8HNzJW/5fOvAVAx4dZENNiMmJ4n0XHZcuM8DxbjydoQBknxWaQfHN8+BNTrLeiQ1JhX8UBe4sTpqCQK6mXKenY6mC6a
XnbW9u1wlgC1dtxN8BQamtzJMDFLXa6kgorOlIFxf2djVvOu7o38geAwO2s/9qjN2UCI7uHm5RXAmMAejp4TbZOxMPuSHb39B1m7
BquJi6v+NXY/iOPKYOafEfaiqQcRXaPYphOHXAM6Fnjhs8IsWI/qM809fw/Yabm3lw/LCPcOiHGcTAGejdOqh+dE8rha///zanaF`;

test('what another program packed is opened', () => {
  assert.equal(opened(Buffer.from(theirs, 'base64'), sentence.length).toString(), sentence);
});

test('what is packed comes back, in one go or by steps', () => {
  const random = generator(5);
  const noise = Uint8Array.from({ length: 20_000 }, () => 256 * random());
  /** Runs, repeats near and far, and what has neither. */
  const mixed = Buffer.concat([
    noise,
    Buffer.alloc(9000, 7),
    Buffer.from(sentence),
    noise.subarray(300, 15_000),
    noise,
  ]);
  for (const bytes of [Buffer.alloc(0), Buffer.from('a'), Buffer.from('abab'), Buffer.from(sentence), mixed]) {
    const packed = pack(bytes, lzma);
    assert.deepEqual(opened(packed, bytes.length), bytes);
    const out = new Uint8Array(bytes.length);
    const unpack = lzma.unpacker(packed, out);
    for (let until = 0; until < bytes.length + 1000; until += 1000) unpack(until);
    assert.deepEqual(Buffer.from(out), bytes);
  }
  // Theirs prices anew as it goes, ours once a stretch, which such a short text feels most.
  assert.ok(pack(Buffer.from(sentence), lzma).length < 1.3 * Buffer.from(theirs, 'base64').length);
  assert.ok(pack(mixed, lzma).length < 22_000, 'repeats cost next to nothing');
});

test('what is cut short or spoilt comes to an end', () => {
  const random = generator(9);
  const packed = Buffer.from(theirs, 'base64');
  for (let trial = 0; trial < 200; trial++) {
    const spoilt = Buffer.from(packed.subarray(0, packed.length * random()));
    for (let k = 0; k < 5; k++) spoilt[Math.floor(spoilt.length * random())] = 256 * random();
    assert.equal(opened(spoilt, sentence.length).length, sentence.length);
  }
});
