/**
 * Counts the SIMD instructions of a module by name, from Binaryen's text of its function bodies.
 * Names of functions, imports and data are left out: only the opcode after an opening parenthesis
 * counts.
 */
export async function vectorInstructions(content) {
  const { default: binaryen } = await import('binaryen');
  const module = binaryen.readBinaryWithFeatures
    ? binaryen.readBinaryWithFeatures(content, binaryen.Features.All)
    : binaryen.readBinary(content);
  try {
    return countVectorOpcodes(module.emitText());
  } finally {
    module.dispose();
  }
}

const opcode = /\(((?:v128|i8x16|i16x8|i32x4|i64x2|f32x4|f64x2)\.[a-z0-9_]+)/g;

/** Counts vector opcodes in WebAssembly text, strings and comments apart. */
export function countVectorOpcodes(text) {
  const code = text.replaceAll(/"(?:[^"\\]|\\.)*"/g, '""').replaceAll(/;;[^\n]*/g, '');
  const counts = new Map();
  for (const [, name] of code.matchAll(opcode)) counts.set(name, (counts.get(name) ?? 0) + 1);
  return counts;
}
