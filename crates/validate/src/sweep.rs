//! Scenes by number, over threads, with records that survive a stop.

use crate::error::ValidateError;
use boresight_core::InputError;
use boresight_core::Progress;
use boresight_fleet::Part;
use boresight_fleet::lines::LineFile;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::Read;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

/// What to run, and where its records are.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep<'a> {
    /// All that a record depends on but the scene's number; heads the file of records.
    pub setup: Value,
    /// Numbers of the scenes.
    pub scenes: Range<u64>,
    /// Which of them to run.
    pub part: Part,
    /// Threads to work with, at least one.
    pub threads: usize,
    /// File of records, one JSON value a line; `None` keeps none. Scenes found there are not run
    /// again.
    pub records: Option<&'a Path>,
}

const PART: &str = "part";

/// The head of a part's records.
fn head(part: Part, setup: &Value) -> Value {
    let mut head = setup.clone();
    if let (false, Some(head)) = (part == Part::WHOLE, head.as_object_mut()) {
        head.insert(PART.into(), format!("{part}").into());
    }
    head
}

/// Takes from a head what tells its part.
pub(crate) fn without_part(head: &mut Value) {
    if let Some(head) = head.as_object_mut() {
        head.remove(PART);
    }
}

/// A line of a file of records.
#[derive(Serialize, serde::Deserialize)]
pub(crate) struct Line<R> {
    pub scene: u64,
    pub record: R,
}

/// Runs the scenes not yet recorded and returns all of those asked for, by number. `progress` breaks the run;
/// what was done is recorded.
///
/// # Errors
/// The first error of `work`; [`ValidateError::OtherRun`] where the file belongs to another run;
/// [`ValidateError::Cancelled`]; those of the file.
pub fn run<R: Serialize + DeserializeOwned + Send, E: From<ValidateError> + Send>(
    sweep: &Sweep,
    work: impl Fn(u64) -> Result<R, E> + Sync,
    mut progress: impl FnMut(Progress) -> ControlFlow<()>,
) -> Result<BTreeMap<u64, R>, E> {
    if sweep.threads == 0 {
        let (what, expected) = ("threads".into(), "at least 1".into());
        return Err(
            ValidateError::from(InputError::OutOfRange { what, expected, given: 0.0 }).into()
        );
    }
    let (mut done, mut file) = match sweep.records {
        Some(path) => open(path, sweep)?,
        None => (BTreeMap::new(), None),
    };
    let wanted = sweep.scenes.clone().filter(|&scene| sweep.part.contains(scene));
    let missing: Vec<u64> = wanted.filter(|scene| !done.contains_key(scene)).collect();
    let total = done.len() + missing.len();
    if progress(Progress { done: done.len(), total }).is_break() {
        return Err(ValidateError::Cancelled { done: done.len(), total }.into());
    }
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    std::thread::scope(|scope| -> Result<(), E> {
        let (sender, results) = mpsc::channel();
        for _ in 0..sweep.threads.min(missing.len()) {
            let (sender, next, stop, missing, work) =
                (sender.clone(), &next, &stop, &missing, &work);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let Some(&scene) = missing.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        break;
                    };
                    if sender.send((scene, work(scene))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let mut collect = || {
            loop {
                let wait = std::time::Duration::from_millis(200);
                match results.recv_timeout(wait) {
                    Ok((scene, record)) => {
                        let line = Line { scene, record: record? };
                        if let Some((file, path)) = &mut file {
                            append(file, path, &line)?;
                        }
                        done.insert(scene, line.record);
                    }
                    Err(mpsc::RecvTimeoutError::Timeout) => {}
                    Err(mpsc::RecvTimeoutError::Disconnected) => return Ok(()),
                }
                // Ctrl-C is looked at while scenes run, too.
                if progress(Progress { done: done.len(), total }).is_break() {
                    return Err(ValidateError::Cancelled { done: done.len(), total }.into());
                }
            }
        };
        let finished = collect();
        stop.store(true, Ordering::Relaxed);
        finished
    })?;
    Ok(done)
}

/// Bytes of an unfinished first line that are compared; a head is shorter.
const MOST_HEAD: u64 = 1 << 16;

type Opened<R> = (BTreeMap<u64, R>, Option<(LineFile, PathBuf)>);

/// Reads what is recorded and opens the file for more.
fn open<R: DeserializeOwned>(path: &Path, sweep: &Sweep) -> Result<Opened<R>, ValidateError> {
    let failed = |action| move |error| ValidateError::File { action, path: path.to_owned(), error };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed("write"))?;
    }
    if path.metadata().is_ok_and(|there| !there.is_file()) {
        let why = "it is not a regular file, which records need";
        return Err(failed("write")(std::io::Error::other(why)));
    }
    // Two runs would overwrite each other's records.
    let mut file = LineFile::open(path).map_err(failed("write"))?;
    let mut text = String::new();
    let read = file.reader().and_then(|mut reader| reader.read_to_string(&mut text));
    read.map_err(failed("read"))?;
    let mut lines = text.lines().enumerate();
    let mut done = BTreeMap::new();
    let malformed =
        |line| move |error| ValidateError::Record { path: path.to_owned(), line: line + 1, error };
    let expected = head(sweep.part, &sweep.setup);
    let mut rest = vec![];
    let tail = file.unfinished().and_then(|tail| tail.take(MOST_HEAD).read_to_end(&mut rest));
    tail.map_err(failed("read"))?;
    match lines.next() {
        // The beginning of a head is what a run leaves that was killed at once; anything else is another's file.
        None if !line(path, &expected)?.as_bytes().starts_with(&rest) => {
            return Err(ValidateError::OtherRun {
                path: path.to_owned(),
                expected: expected.to_string(),
                given: String::from_utf8_lossy(&rest).into_owned(),
            });
        }
        None => append(&mut file, path, &expected)?,
        Some((line, head)) => {
            let found: Value = serde_json::from_str(head).map_err(malformed(line))?;
            if found != expected {
                return Err(ValidateError::OtherRun {
                    path: path.to_owned(),
                    expected: expected.to_string(),
                    given: head.to_owned(),
                });
            }
        }
    }
    for (line, text) in lines {
        let found: Line<R> = serde_json::from_str(text).map_err(malformed(line))?;
        if sweep.scenes.contains(&found.scene) && sweep.part.contains(found.scene) {
            done.insert(found.scene, found.record);
        }
    }
    Ok((done, Some((file, path.to_owned()))))
}

/// The records of a whole run as the lines of a file.
pub(crate) fn text<R: Serialize>(
    path: &Path,
    setup: &Value,
    records: &BTreeMap<u64, R>,
) -> Result<String, ValidateError> {
    let mut text = line(path, setup)?;
    for (&scene, record) in records {
        text += &line(path, &Line { scene, record })?;
    }
    Ok(text)
}

/// A value as a line of a file of records.
fn line(path: &Path, value: &impl Serialize) -> Result<String, ValidateError> {
    let failed = |error: serde_json::Error| ValidateError::File {
        action: "write",
        path: path.to_owned(),
        error: error.into(),
    };
    Ok(serde_json::to_string(value).map_err(failed)? + "\n")
}

fn append(file: &mut LineFile, path: &Path, value: &impl Serialize) -> Result<(), ValidateError> {
    let failed = |error| ValidateError::File { action: "write", path: path.to_owned(), error };
    let line = line(path, value)?;
    file.append(&line).map_err(failed)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A scene whose record is its number.
    fn own_number(scene: u64) -> Result<u64, ValidateError> {
        Ok(scene)
    }
    use std::fs::OpenOptions;
    use std::io::Write;
    use std::sync::Mutex;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("boresight-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        path
    }

    fn sweep(path: &Path, scenes: Range<u64>) -> Sweep<'_> {
        Sweep {
            setup: serde_json::json!({ "seed": 1 }),
            scenes,
            part: Part::WHOLE,
            threads: 2,
            records: Some(path),
        }
    }

    #[test]
    fn a_stopped_run_goes_on_where_it_was_and_half_a_line_is_run_again() {
        let folder = folder("sweep");
        let path = folder.join("records.jsonl");
        let ran = Mutex::new(vec![]);
        let work = |scene| {
            ran.lock().unwrap().push(scene);
            Ok(scene * 10)
        };
        let halted = run(&sweep(&path, 0..40), work, |p| {
            if p.done < 5 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        assert!(matches!(halted, Err(ValidateError::Cancelled { done: 5.., total: 40 })));
        let mut file = OpenOptions::new().append(true).open(&path).unwrap();
        file.write_all(b"{\"scene\":39,\"rec").unwrap();
        let recorded = std::fs::read_to_string(&path).unwrap().lines().count() - 2;
        ran.lock().unwrap().clear();
        let all = run(&sweep(&path, 0..40), work, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(all.len(), 40);
        assert!(all.iter().all(|(scene, record)| *record == scene * 10));
        assert_eq!(ran.lock().unwrap().len(), 40 - recorded);
        // Asking for fewer gives fewer, asking for others adds them.
        let part = run(&sweep(&path, 38..42), work, |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(part.into_keys().collect::<Vec<_>>(), [38, 39, 40, 41]);
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn records_of_another_run_and_broken_ones_are_refused() {
        let folder = folder("records");
        let path = folder.join("records.jsonl");
        let go = |_| ControlFlow::Continue(());
        run(&sweep(&path, 0..2), own_number, go).unwrap();
        let other = Sweep { setup: serde_json::json!({ "seed": 2 }), ..sweep(&path, 0..2) };
        assert!(matches!(run(&other, Ok, go), Err(ValidateError::OtherRun { .. })));
        // Other files are left unchanged, those of one unfinished line included.
        let whole = std::fs::read(&path).unwrap();
        for (content, accepted) in
            [(&b"one line"[..], false), (b"{\"seed\":2", false), (&whole[..5], true)]
        {
            std::fs::write(&path, content).unwrap();
            let ended = run(&sweep(&path, 0..2), own_number, go);
            assert_eq!(ended.is_ok(), accepted, "{ended:?}");
            assert!(accepted || std::fs::read(&path).unwrap() == content);
        }
        std::fs::write(&path, "{\"seed\":1}\n{\"scene\":\"x\"}\n").unwrap();
        let broken = run(&sweep(&path, 0..2), own_number, go);
        assert!(matches!(broken, Err(ValidateError::Record { line: 2, .. })), "{broken:?}");
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_path_that_cannot_be_written_is_named() {
        let path = folder("unwritable");
        std::fs::write(&path, "a file").unwrap();
        let within = path.join("records.jsonl");
        let error = run(&sweep(&within, 0..1), own_number, |_| ControlFlow::Continue(()));
        let message = error.unwrap_err().to_string();
        assert!(message.starts_with(&format!("cannot write {}: ", within.display())), "{message}");
        let device =
            run(&sweep(Path::new("/dev"), 0..1), own_number, |_| ControlFlow::Continue(()));
        let message = device.unwrap_err().to_string();
        assert!(message.contains("not a regular file"), "{message}");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn a_file_that_a_run_writes_to_is_not_taken_by_another() {
        let folder = folder("locked");
        let path = folder.join("records.jsonl");
        let go = |_| ControlFlow::Continue(());
        let within = |scene| match run(&sweep(&path, 0..2), own_number, go) {
            Err(ValidateError::File { .. }) => own_number(scene),
            other => panic!("{other:?}"),
        };
        assert_eq!(run(&sweep(&path, 0..2), within, go).unwrap().len(), 2);
        assert_eq!(run(&sweep(&path, 0..2), own_number, go).unwrap().len(), 2);
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn parts_hold_every_scene_once() {
        let go = |_| ControlFlow::Continue(());
        let mut all = BTreeMap::new();
        for number in 1..=3 {
            let part = Part::new(number, 3).unwrap();
            let sweep = Sweep { part, records: None, ..sweep(Path::new(""), 0..10) };
            all.extend(
                run(&sweep, own_number, go).unwrap().into_keys().map(|scene| (scene, number)),
            );
        }
        assert_eq!(all.into_values().collect::<Vec<_>>(), [1, 2, 3, 1, 2, 3, 1, 2, 3, 1]);
    }

    #[test]
    fn the_error_of_a_scene_ends_the_run_and_no_threads_is_an_error() {
        let wrong = |_| -> Result<u64, ValidateError> {
            Err(ValidateError::Cancelled { done: 1, total: 9 })
        };
        let mut sweep = Sweep {
            setup: Value::Null,
            scenes: 0..9,
            part: Part::WHOLE,
            threads: 2,
            records: None,
        };
        assert!(matches!(
            run(&sweep, wrong, |_| ControlFlow::Continue(())),
            Err(ValidateError::Cancelled { done: 1, .. })
        ));
        sweep.threads = 0;
        assert!(matches!(
            run(&sweep, Ok, |_| ControlFlow::Continue(())),
            Err(ValidateError::Core(_))
        ));
    }
}
