//! Recordings in several files. mmWave Studio splits long ones into `adc_data_Raw_0.bin`,
//! `adc_data_Raw_1.bin` and so on; the files of a cascade are joined by [`super::cascade`].

use super::cascade;
use crate::error::FormatError;
use std::ops::Range;

/// With more files missing than this, numbers are dates or times of separate recordings.
const MOST_MISSING: u64 = 100;

/// Numbers have fewer digits than this.
const MOST_DIGITS: usize = 16;

/// Files of one recording.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Parts {
    /// Indices of the files in order of time. For a cascade, in order of name.
    pub order: Vec<usize>,
    /// Whether they are those of a cascade's chips, which [`cascade::join`] joins.
    pub is_cascade: bool,
    /// Names of the files that are missing between those given, or the first and last of them.
    pub missing: Vec<String>,
}

/// A numbered file name.
struct Numbered<'a> {
    file: usize,
    stem: &'a str,
    digits: &'a str,
    number: u64,
}

impl<'a> Numbered<'a> {
    fn of(file: usize, name: &'a str) -> Option<Self> {
        let length = name.len().checked_sub(".bin".len())?;
        let (base, extension) = name.split_at_checked(length)?;
        let stem = base.trim_end_matches(|letter: char| letter.is_ascii_digit());
        let digits = &base[stem.len()..];
        let is_numbered = extension.eq_ignore_ascii_case(".bin") && digits.len() < MOST_DIGITS;
        let number = digits.parse().ok().filter(|_| is_numbered)?;
        Some(Self { file, stem, digits, number })
    }

    /// The file name with other numbers.
    fn others(&self, numbers: &Range<u64>) -> String {
        let width = if self.digits.starts_with('0') { self.digits.len() } else { 0 };
        let named = |number: u64| format!("{}{number:0width$}.bin", self.stem);
        match numbers.end - numbers.start {
            1 => named(numbers.start),
            _ => format!("{} to {}", named(numbers.start), named(numbers.end - 1)),
        }
    }
}

/// The folder-less name of a file.
fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// Puts the files of a recording in order, by their names.
///
/// # Errors
/// [`FormatError::Parts`] for files that are not of one recording: names that differ in more than
/// their number, two files of the same number, more than 100 missing between them.
pub fn parts(names: &[&str]) -> Result<Parts, FormatError> {
    let names: Vec<&str> = names.iter().map(|path| base_name(path)).collect();
    if let Some(chip) = names.iter().find(|name| cascade::is_part(name)) {
        if let Some(other) = names.iter().find(|name| !cascade::is_part(name)) {
            return Err(error(other, format!("the other files of the cascade of {chip}")));
        }
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by_key(|&file| names[file]);
        return Ok(Parts { order, is_cascade: true, missing: vec![] });
    }
    if names.len() < 2 {
        return Ok(Parts { order: (0..names.len()).collect(), ..Parts::default() });
    }
    let stem = Numbered::of(0, names[0]).map(|first| first.stem);
    let mut numbered = vec![];
    for (file, name) in names.iter().enumerate() {
        let part = Numbered::of(file, name)
            .filter(|part| stem.is_some_and(|stem| stem.eq_ignore_ascii_case(part.stem)));
        numbered.push(part.ok_or_else(|| {
            let other = names[usize::from(file == 0)];
            let numbers = "adc_data_Raw_0.bin and adc_data_Raw_1.bin";
            error(name, format!("a name that differs from {other} in its number, as {numbers} do"))
        })?);
    }
    numbered.sort_by_key(|part| part.number);
    Ok(Parts {
        missing: missing(&numbered, &names)?,
        order: numbered.iter().map(|part| part.file).collect(),
        is_cascade: false,
    })
}

/// Names of the files missing between those of a recording in order.
fn missing(parts: &[Numbered<'_>], names: &[&str]) -> Result<Vec<String>, FormatError> {
    let mut missing = vec![];
    let mut count = 0_u64;
    // Numbers begin at 0 or 1.
    let mut next = u64::from(parts.first().is_some_and(|first| first.number == 1));
    for part in parts {
        if part.number < next {
            return Err(error(names[part.file], "one file of each number"));
        }
        if part.number > next {
            missing.push(part.others(&(next..part.number)));
        }
        count = count.saturating_add(part.number - next);
        next = part.number + 1;
    }
    if count > MOST_MISSING {
        let expected = format!("files of one recording, of which {count} would be missing");
        return Err(error(names[parts[0].file], expected));
    }
    Ok(missing)
}

fn error(given: &str, expected: impl Into<String>) -> FormatError {
    FormatError::Parts {
        what: "files of the recording".into(),
        expected: expected.into(),
        given: given.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missing(names: &[&str]) -> Vec<String> {
        parts(names).unwrap().missing
    }

    #[test]
    fn files_are_put_in_order_of_their_numbers() {
        let found = parts(&["d/adc_data_Raw_10.bin", "d/adc_data_Raw_9.bin"]).unwrap();
        assert_eq!(found.order, [1, 0]);
        assert!(!found.is_cascade);
        let found = parts(&["slave1_0000_data.bin", "master_0000_data.bin"]).unwrap();
        assert_eq!((found.order, found.is_cascade), (vec![1, 0], true));
        // The name of a single file is free.
        assert_eq!(parts(&["any name"]).unwrap().order, [0]);
        assert_eq!(parts(&[]).unwrap(), Parts::default());
    }

    #[test]
    fn missing_files_are_named() {
        assert!(missing(&["a_0.bin", "A_1.BIN"]).is_empty());
        assert!(missing(&["a_1.bin", "a_2.bin"]).is_empty());
        assert_eq!(missing(&["a_0.bin", "a_2.bin"]), ["a_1.bin"]);
        assert_eq!(
            missing(&["a_2.bin", "a_3.bin", "a_7.bin"]),
            ["a_0.bin to a_1.bin", "a_4.bin to a_6.bin"]
        );
        assert_eq!(missing(&["a_000.bin", "a_002.bin"]), ["a_001.bin"]);
    }

    #[test]
    fn files_of_several_recordings_are_refused() {
        for (names, wrong) in [
            (&["a_0.bin", "b_1.bin"][..], "b_1.bin"),
            (&["a.bin", "a_1.bin"], "a.bin"),
            (&["a_0.bin", "a_1.dat"], "a_1.dat"),
            (&["a_1.bin", "a_01.bin"], "a_01.bin"),
            (&["a_20250101.bin", "a_20250102.bin"], "a_20250101.bin"),
            (&["a_0.bin", "a_1234567890123456.bin"], "a_1234567890123456.bin"),
            (&["master_0000_data.bin", "a_0.bin"], "a_0.bin"),
            (&["ä.bin", "bin"], "ä.bin"),
        ] {
            match parts(names) {
                Err(FormatError::Parts { given, .. }) => assert_eq!(given, wrong, "{names:?}"),
                other => panic!("{names:?}: {other:?}"),
            }
        }
    }
}
