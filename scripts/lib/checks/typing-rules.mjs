/**
 * Tests of pages fill in fields as a person does: key by key (tests/browser/lib/type.mjs). What sets a value in one go hides
 * what a re-render does to half a number.
 */
const RULES = [
  [/\bfill\s*\(|\[\s*['"`]fill['"`]\s*\]/, 'fill() types no keys'],
  [
    /\.(value|valueAsNumber|valueAsDate|checked|selectedIndex)\s*(\?\?|\|\||&&|[-+*/])?=(?![=>])/,
    'sets what a control holds',
  ],
  [/\b(Object\.assign|Reflect\.set)\s*\([^;]*\bvalue\b/, 'sets what a control holds'],
  [/\b(insertText|setRangeText|stepUp|stepDown|setInputValue)\s*\(/, 'types no keys'],
  [
    /new (Input|Keyboard)?Event\s*\(\s*['"`](input|change|beforeinput|keydown|keyup|keypress)['"`]/,
    'no person sends events',
  ],
];

/** What of a test's text types otherwise, with its line. */
export function typingProblems(text) {
  return text.split('\n').flatMap((line, i) => {
    const code = line.replace(/^\s*(\/\/|\*|\/\*).*$/, '').replace(/\s\/\/ .*$/, '');
    return RULES.filter(([pattern]) => pattern.test(code)).map(([, why]) => `${i + 1}: ${why}: ${line.trim()}`);
  });
}
