/** What a page shows, as code. */

/** For one of the ways to run it. */
export interface Part {
  /** Empty where this way cannot do it. */
  text: string;
  /** What it needs beside itself. */
  needs: string;
  /** What the page shows and this does not, or otherwise, in sentences. */
  lacks: readonly string[];
}

export interface Code {
  javascript: Part;
  commandLine: Part;
}

/** Of a page that has nothing to show. */
export function nothing(why: string): Code {
  const part: Part = { text: '', needs: '', lacks: [why] };
  return { javascript: part, commandLine: part };
}

/** What code may need, in sentences. */
export const NEEDS = {
  package: 'Node 20 or newer and the package: npm install boresight.',
  program: 'The command line of Boresight (boresight), in bash.',
  root: 'Run it in the root of the Boresight repository',
  own: (names: readonly string[]): string =>
    `Your ${names.length > 1 ? 'files' : 'file'} ${names.join(', ')} in the folder you run it in.`,
} as const;

/** What is in a folder of the repository. */
export const inRepository = (what: string, folder: string): string => `${NEEDS.root}, for ${what} in ${folder}.`;

/** Sentences as one paragraph, each once. */
export const sentences = (...all: readonly string[]): string => [...new Set(all.filter(Boolean))].join(' ');

/** A script or commands. */
export const textOf = (lines: readonly string[]): string => (lines.length ? `${lines.join('\n')}\n` : '');
