/** A recording in several files: mmWave Studio splits samples into adc_data_Raw_0.bin, adc_data_Raw_1.bin and so on. */
import { FileProblem } from '../../../data.ts';

/** Files of one recording in the order of their numbers. */
export interface Parts {
  files: readonly File[];
  /** Whether they are of a cascade's chips, with their indices. */
  cascade: boolean;
  /** Names of those that the numbers tell to be missing, or from which to which. */
  missing: readonly string[];
}

/** Numbers further apart are days or times, and of several recordings. */
const MOST_MISSING = 100;

interface Numbered {
  file: File;
  stem: string;
  digits: string;
  number: number;
}

function numbered(file: File): Numbered | null {
  const [, stem = '', digits = ''] = /^(.*?)(\d{1,15})\.bin$/i.exec(file.name) ?? [];
  return digits ? { file, stem, digits, number: Number(digits) } : null;
}

/** As mmWave Studio names the files of a cascade of four chips. */
const OF_CASCADE = /^(master|slave[123])_\d{1,9}_(data|idx)\.bin$/i;

/** Puts files in order; throws where they are not of one recording. */
export function partsOf(files: readonly File[]): Parts {
  const chips = files.filter(({ name }) => OF_CASCADE.test(name));
  if (chips.length) {
    const other = files.find((file) => !chips.includes(file));
    if (other)
      throw new FileProblem(
        'ambiguous',
        other.name,
        `beside “${chips[0]?.name}” the files of a cascade’s other chips are expected. Open one recording at a time`,
      );
    // Which are missing the package says.
    return { files: chips.sort((a, b) => a.name.localeCompare(b.name)), cascade: true, missing: [] };
  }
  if (files.length < 2) return { files, cascade: false, missing: [] };
  const first = numbered(files[0] as File);
  const parts = files.map((file) => {
    const part = numbered(file);
    if (part && part.stem.toLowerCase() === first?.stem.toLowerCase()) return part;
    const other = files.find((one) => one !== file)?.name;
    throw new FileProblem(
      'ambiguous',
      file.name,
      `files of one recording are expected to differ in their number alone, as adc_data_Raw_0.bin and adc_data_Raw_1.bin do; “${other}” is another’s. Open one recording at a time`,
    );
  });
  parts.sort((a, b) => a.number - b.number);
  const missing: string[] = [];
  let lost = 0;
  // Some begin to count at 1.
  let next = parts[0]?.number === 1 ? 1 : 0;
  for (const { file, stem, digits, number } of parts) {
    if (number < next) throw new FileProblem('ambiguous', file.name, `two files are number ${number} of one recording`);
    const named = (n: number): string =>
      `${stem}${String(n).padStart(digits.startsWith('0') ? digits.length : 0, '0')}.bin`;
    if (number > next) missing.push(number === next + 1 ? named(next) : `${named(next)} to ${named(number - 1)}`);
    lost += number - next;
    next = number + 1;
  }
  if (lost > MOST_MISSING) {
    throw new FileProblem(
      'ambiguous',
      files[0]?.name ?? '',
      `by their numbers ${lost} files would be missing, so they are hardly of one recording. Open one at a time`,
    );
  }
  return { files: parts.map(({ file }) => file), cascade: false, missing };
}
