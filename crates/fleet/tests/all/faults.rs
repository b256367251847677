//! A file of records whose system calls fail, each in turn: every record that was acknowledged is there afterwards, and no other line is.

use boresight_fleet::job::{LogFile, Settings};
use boresight_fleet::lines::{LineFile, LineStorage};
use boresight_fleet::record::Failure;
use boresight_fleet::schema::SCHEMA;
use boresight_fleet::store::{Store, each_line, keys_of, line};
use boresight_fleet::{Job, Record};
use std::cell::Cell;
use std::fs::{File, OpenOptions};
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom, Write};
use std::path::Path;
use std::rc::Rc;

const RECORDS: usize = 6;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    NoSpace,
    /// After half of what was to be written.
    InputOutput,
    Interrupted,
    /// Fewer bytes than asked for, without an error.
    Short,
}

/// Which call fails, and whether all later ones do, as those of a process that is gone.
#[derive(Debug, Clone)]
struct Plan {
    fault: Fault,
    at: u64,
    lasting: bool,
    calls: Rc<Cell<u64>>,
    injected: Rc<Cell<u64>>,
}

impl Plan {
    fn fails(&self) -> bool {
        let call = self.calls.get();
        self.calls.set(call + 1);
        let fails = call == self.at || (self.lasting && call > self.at);
        self.injected.set(self.injected.get() + u64::from(call == self.at));
        fails
    }

    fn call(&self) -> Result<()> {
        match (self.fails(), self.fault) {
            (false, _) => Ok(()),
            (true, Fault::NoSpace) => Err(ErrorKind::StorageFull.into()),
            (true, Fault::Interrupted) => Err(ErrorKind::Interrupted.into()),
            (true, Fault::InputOutput | Fault::Short) => Err(Error::other("input/output")),
        }
    }
}

struct Faulty {
    file: File,
    plan: Plan,
}

impl Read for Faulty {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        self.plan.call()?;
        self.file.read(buffer)
    }
}

impl Seek for Faulty {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.plan.call()?;
        self.file.seek(to)
    }
}

impl Write for Faulty {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let half = &bytes[..bytes.len() / 2];
        match (self.plan.fails(), self.plan.fault) {
            (false, _) => self.file.write(bytes),
            (true, Fault::NoSpace) => Err(ErrorKind::StorageFull.into()),
            (true, Fault::Interrupted) => Err(ErrorKind::Interrupted.into()),
            (true, Fault::InputOutput) => {
                self.file.write_all(half)?;
                Err(Error::other("input/output"))
            }
            (true, Fault::Short) => self.file.write(half),
        }
    }

    fn flush(&mut self) -> Result<()> {
        self.file.flush()
    }
}

impl LineStorage for Faulty {
    fn set_len(&mut self, length: u64) -> Result<()> {
        self.plan.call()?;
        self.file.set_len(length)
    }

    fn sync_data(&mut self) -> Result<()> {
        self.plan.call()
    }
}

/// A record whose line is the shorter the larger its number.
fn record(number: usize) -> Record {
    let files = vec![LogFile { name: number.to_string(), bytes: 1, sha256: "00".repeat(32) }];
    let settings = Settings::default();
    let key = Job::key_of(&files, &settings);
    let text = String::from;
    let [path, vehicle, drive] = [number.to_string(), text("v"), text("d")];
    let job = Job { key, path, vehicle, drive, time_s: None, files, settings, schema: SCHEMA };
    let message = "m".repeat(1000 - 100 * number);
    let [code, what, expected, given] = ["c", "w", "e", "g"].map(text);
    Record::failure(&job, Failure { code, message, what, expected, given })
}

/// Runs with one fault: whether the fault was reached.
fn run(path: &Path, before: &[u8], earlier: &[usize], plan: &Plan) -> bool {
    std::fs::write(path, before).unwrap();
    let mut acknowledged: Vec<usize> = earlier.to_vec();
    let file = OpenOptions::new().read(true).write(true).open(path).unwrap();
    let store = LineFile::of(Faulty { file, plan: plan.clone() });
    if let Ok(mut store) = store
        .map(|lines| Store::of(lines, path, false))
        .unwrap_or_else(|_| Err(boresight_fleet::FleetError::Busy { path: path.into() }))
    {
        for number in 1..=RECORDS {
            match store.append(&record(number)) {
                Ok(()) => acknowledged.push(number),
                // A run ends with its first error; one that went on would lose nothing either.
                Err(_) if plan.lasting => break,
                Err(_) => {}
            }
        }
        let _ = store.sync();
    } else {
        assert_eq!(std::fs::read(path).unwrap(), before, "opening changes nothing: {plan:?}");
    }
    let reached = plan.injected.get() > 0;
    // The next run.
    let mut store = Store::open(path, false).unwrap();
    store.append(&record(8)).unwrap();
    store.sync().unwrap();
    drop(store);
    acknowledged.push(8);
    let mut found: Vec<String> = vec![];
    each_line(path, |_, text| {
        let record: Record = serde_json::from_slice(text).unwrap();
        found.push(record.path);
        Ok(())
    })
    .unwrap();
    let expected: Vec<String> = acknowledged.iter().map(ToString::to_string).collect();
    assert_eq!(found, expected, "{plan:?}");
    assert_eq!(keys_of(path.parent().unwrap(), false).unwrap().len(), expected.len());
    reached
}

#[test]
fn no_fault_loses_a_record_or_leaves_half_of_one() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("faults");
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("records.jsonl");
    let whole = |number| line(&record(number)).unwrap().into_bytes();
    let zeros = vec![0; 3000];
    let states: [(Vec<u8>, &[usize]); 6] = [
        (vec![], &[]),
        (whole(9), &[9]),
        ([whole(9), whole(7)[..50].to_vec()].concat(), &[9]),
        ([whole(9), zeros.clone()].concat(), &[9]),
        ([whole(9), zeros.clone(), b"\n".to_vec(), whole(7)].concat(), &[9, 7]),
        (zeros, &[]),
    ];
    let mut injected = 0;
    for (before, earlier) in states {
        for fault in [Fault::NoSpace, Fault::InputOutput, Fault::Interrupted, Fault::Short] {
            // Interrupted calls are made again: they cannot be interrupted forever.
            for lasting in [false, true].into_iter().filter(|l| !l || fault != Fault::Interrupted) {
                for at in 0.. {
                    let [calls, count] = [0; 2].map(|zero| Rc::new(Cell::new(zero)));
                    let plan = Plan { fault, at, lasting, calls, injected: count };
                    if !run(&path, &before, earlier, &plan) {
                        break;
                    }
                    injected += 1;
                }
            }
        }
    }
    println!("{injected} faults injected");
    assert!(injected >= 500, "{injected}");
}
