/** Words of the command line, quoted for bash and other POSIX shells. */

const COLUMNS = 100;
/** What no shell takes for anything but itself. */
const PLAIN = /^[\w@%+:,./-][\w@%+=:,./-]*$/;

/** A word as a shell has to be given it. */
export const shellWord = (word: string): string =>
  PLAIN.test(word) ? word : `'${word.replaceAll("'", String.raw`'\''`)}'`;

/** A file's name, which must not be taken for a flag. */
export const fileWord = (name: string): string => (name.startsWith('-') ? `./${name}` : name);

/** A flag with its value, in one word where the value could be taken for a flag. */
export const flagged = (flag: string, value: string): string[] =>
  value.startsWith('-') ? [`--${flag}=${value}`] : [`--${flag}`, value];

/** A command, each flag with its value, on as many lines as it takes. */
export function command(words: readonly string[], after = ''): string {
  const lines = [''];
  for (const [i, word] of words.entries()) {
    const text = shellWord(word);
    const line = lines[lines.length - 1] as string;
    const value = words[i + 1];
    // A value stays beside its flag.
    const along =
      word.startsWith('--') && value !== undefined && !value.startsWith('-') ? shellWord(value).length + 1 : 0;
    const joined = line === '' ? text : `${line} ${text}`;
    if (line !== '' && joined.length + along + 2 > COLUMNS && !isValue(words, i)) lines.push(`  ${text}`);
    else lines[lines.length - 1] = joined;
  }
  return lines.join(' \\\n') + after;
}

const isValue = (words: readonly string[], i: number): boolean =>
  Boolean(words[i - 1]?.startsWith('--')) && !words[i - 1]?.includes('=') && !words[i]?.startsWith('-');

/** Writes a text to a file; no line of it may be `EOF`. */
export const heredoc = (file: string, text: string): string =>
  `cat > ${shellWord(fileWord(file))} <<'EOF'\n${text.replace(/\n?$/, '\n')}EOF`;
