/** What a page shows, as code. */

/** For one of the ways to run it. */
export interface Part {
  /** Empty where this way cannot do it. */
  text: string;
  /** What it needs beside itself. */
  needs: string;
  /** What the page shows and this does not, in sentences. */
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

/** Sentences of what is needed. */
export const NEEDS = {
  package: 'Node 20 or newer and the package: npm install boresight.',
  program: 'The command line of Boresight (boresight), in bash.',
  repository: (files: string): string => `${files} from the Boresight repository; run it in the repository’s root.`,
  own: (names: readonly string[]): string =>
    `Your ${names.length > 1 ? 'files' : 'file'} ${names.join(', ')} in the folder you run it in.`,
} as const;
