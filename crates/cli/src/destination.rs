//! Where output goes: through links, into devices and pipes, and never by halves onto a file.

use crate::error::CliError;
use boresight_fleet::lines::sync_folder;
use std::fs::{Metadata, OpenOptions, Permissions};
use std::io::{Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Links followed before they are taken for a circle, as on Linux.
const MOST_LINKS: usize = 40;
/// Folders of the descriptors of this process, by number.
const DESCRIPTORS: [&str; 2] = ["/dev/fd", "/proc/self/fd"];
/// Names of the standard output.
const STANDARD_OUTPUT: [&str; 3] = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// Where one output goes, checked before anything is computed.
#[derive(Debug)]
pub struct Destination {
    /// As the user named it.
    named: PathBuf,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// The standard output, whatever it leads to.
    StandardOutput,
    /// A device, a pipe or another descriptor.
    Direct { path: PathBuf, descriptor: bool },
    /// A file, and the one that is there already.
    File { path: PathBuf, there: Option<Metadata> },
}

impl Destination {
    /// The place a path leads to. A folder is none.
    pub fn new(named: &Path) -> Result<Self> {
        let path = followed(named)?;
        let place = if STANDARD_OUTPUT.iter().any(|name| path == Path::new(name)) {
            Place::StandardOutput
        } else if is_descriptor(&path) {
            Place::Direct { path, descriptor: true }
        } else {
            match path.metadata() {
                Ok(there) if there.is_dir() => return Err(ErrorKind::IsADirectory.into()),
                Ok(there) if !there.is_file() => Place::Direct { path, descriptor: false },
                Ok(there) => Place::File { path: path.canonicalize()?, there: Some(there) },
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    Place::File { path: in_its_folder(path), there: None }
                }
                Err(error) => return Err(error),
            }
        };
        Ok(Self { named: named.into(), place })
    }

    /// As the user named it.
    pub fn named(&self) -> &Path {
        &self.named
    }

    /// The file behind all links; `None` for what is no file.
    pub fn file(&self) -> Option<&Path> {
        match &self.place {
            Place::File { path, .. } => Some(path),
            _ => None,
        }
    }

    /// Whether a file is there that would be replaced.
    pub fn replaces(&self) -> bool {
        matches!(self.place, Place::File { there: Some(_), .. })
    }

    /// Whether it is the standard output.
    pub fn is_standard_output(&self) -> bool {
        matches!(self.place, Place::StandardOutput)
    }

    /// Writes a file whole or not at all, with what `fill` puts into it. A file that has come to be there since
    /// is left as it is.
    pub fn write_with<T>(
        self,
        fill: impl FnOnce(&mut dyn Write) -> std::result::Result<T, CliError>,
    ) -> std::result::Result<T, CliError> {
        let Self { named, place } = self;
        let failed = |error| CliError::File { action: "write", path: named.clone(), error };
        match place {
            Place::StandardOutput => {
                let mut out = std::io::stdout().lock();
                let value = fill(&mut out)?;
                out.flush().map_err(failed)?;
                Ok(value)
            }
            Place::Direct { path, descriptor } => {
                let mut options = OpenOptions::new();
                let options = options.write(true).append(descriptor);
                fill(&mut options.open(path).map_err(failed)?)
            }
            Place::File { path, there } => {
                let file = beside(&path).map_err(failed)?;
                let permissions = there.as_ref().map(Metadata::permissions);
                write_whole(file, &path, permissions, fill, failed).map_err(|error| match error {
                    CliError::File { error, .. } if error.kind() == ErrorKind::AlreadyExists => {
                        CliError::Exists { path: named.clone() }
                    }
                    error => error,
                })
            }
        }
    }
}

/// A new file next to the one that it is to become, removed unless it takes that name.
trait NewFile: Write + Sized {
    /// Gives it the permissions of the file that it replaces.
    fn set_permissions(&mut self, permissions: Permissions) -> Result<()>;
    /// Waits until its bytes are on the disk.
    fn sync(&mut self) -> Result<()>;
    /// Gives it its name; a file of that name is replaced or an error.
    fn take_name(self, path: &Path, replace: bool) -> Result<()>;
    /// Waits until its name is on the disk.
    fn sync_name(path: &Path) -> Result<()>;
}

impl NewFile for NamedTempFile {
    fn set_permissions(&mut self, permissions: Permissions) -> Result<()> {
        self.as_file().set_permissions(permissions)
    }

    fn sync(&mut self) -> Result<()> {
        self.as_file().sync_all()
    }

    fn take_name(self, path: &Path, replace: bool) -> Result<()> {
        let taken = if replace { self.persist(path) } else { self.persist_noclobber(path) };
        Ok(taken.map(drop)?)
    }

    fn sync_name(path: &Path) -> Result<()> {
        sync_folder(path)
    }
}

/// Fills a new file and gives it its name once all of it is on the disk: a loss of power leaves the old file or the new one. `permissions` are
/// those of the file that it replaces.
fn write_whole<F: NewFile, T>(
    mut file: F,
    path: &Path,
    permissions: Option<Permissions>,
    fill: impl FnOnce(&mut dyn Write) -> std::result::Result<T, CliError>,
    failed: impl Fn(Error) -> CliError,
) -> std::result::Result<T, CliError> {
    let value = fill(&mut file)?;
    let replace = permissions.is_some();
    if let Some(permissions) = permissions {
        file.set_permissions(permissions).map_err(&failed)?;
    }
    file.sync().map_err(&failed)?;
    file.take_name(path, replace).map_err(&failed)?;
    F::sync_name(path).map_err(failed)?;
    Ok(value)
}

/// The file behind a path and its links, there or not yet.
pub fn file_behind(path: &Path) -> Result<PathBuf> {
    path.canonicalize().or_else(|_| followed(path).map(in_its_folder))
}

/// What links lead to, there or not yet. A descriptor is not followed: what it is open on need have no name.
fn followed(path: &Path) -> Result<PathBuf> {
    let mut path = std::path::absolute(path)?;
    for _ in 0..MOST_LINKS {
        if is_descriptor(&path) || STANDARD_OUTPUT.iter().any(|name| path == Path::new(name)) {
            return Ok(path);
        }
        match path.read_link() {
            Ok(target) => path = path.parent().unwrap_or(Path::new("/")).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(Error::other("links lead in a circle"))
}

fn is_descriptor(path: &Path) -> bool {
    path.parent().is_some_and(|folder| DESCRIPTORS.iter().any(|name| folder == Path::new(name)))
}

/// The path without links to its folder, if that is there.
fn in_its_folder(path: PathBuf) -> PathBuf {
    match (path.parent().map(Path::canonicalize), path.file_name()) {
        (Some(Ok(folder)), Some(name)) => folder.join(name),
        _ => path,
    }
}

/// A new file under a name of its own in the folder of another, gone unless it takes the other's name.
fn beside(path: &Path) -> Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".boresight-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Those of any new file: the process's mask is taken off.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(path.parent().unwrap_or(Path::new(".")))
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::cell::Cell;
    use std::rc::Rc;

    #[derive(Debug, Clone, Copy, PartialEq)]
    enum Fault {
        NoSpace,
        /// After half of what was to be written.
        InputOutput,
        Interrupted,
        /// Fewer bytes than asked for, without an error.
        Short,
    }

    thread_local! {
        /// The call that fails, whether all later ones do, and the calls so far.
        static PLAN: Cell<(Fault, u64, bool, u64)> = const { Cell::new((Fault::NoSpace, 0, false, 0)) };
    }

    fn fails() -> Option<Fault> {
        let (fault, at, lasting, calls) = PLAN.get();
        PLAN.set((fault, at, lasting, calls + 1));
        (calls == at || (lasting && calls > at)).then_some(fault)
    }

    fn call() -> Result<()> {
        match fails() {
            None => Ok(()),
            Some(Fault::NoSpace) => Err(ErrorKind::StorageFull.into()),
            Some(Fault::Interrupted) => Err(ErrorKind::Interrupted.into()),
            Some(Fault::InputOutput | Fault::Short) => Err(Error::other("input/output")),
        }
    }

    /// A new file whose calls fail as planned. `named` becomes true with its name.
    struct Faulty {
        file: NamedTempFile,
        synced: bool,
        named: Rc<Cell<bool>>,
    }

    impl Write for Faulty {
        fn write(&mut self, bytes: &[u8]) -> Result<usize> {
            let half = &bytes[..bytes.len() / 2];
            match fails() {
                None => self.file.write(bytes),
                Some(Fault::NoSpace) => Err(ErrorKind::StorageFull.into()),
                Some(Fault::Interrupted) => Err(ErrorKind::Interrupted.into()),
                Some(Fault::InputOutput) => {
                    self.file.write_all(half)?;
                    Err(Error::other("input/output"))
                }
                Some(Fault::Short) => self.file.write(half),
            }
        }

        fn flush(&mut self) -> Result<()> {
            self.file.flush()
        }
    }

    impl NewFile for Faulty {
        fn set_permissions(&mut self, permissions: Permissions) -> Result<()> {
            call()?;
            NewFile::set_permissions(&mut self.file, permissions)
        }

        fn sync(&mut self) -> Result<()> {
            call()?;
            self.synced = true;
            NewFile::sync(&mut self.file)
        }

        fn take_name(self, path: &Path, replace: bool) -> Result<()> {
            assert!(self.synced, "a name before the bytes are on the disk");
            call()?;
            self.file.take_name(path, replace)?;
            self.named.set(true);
            Ok(())
        }

        fn sync_name(path: &Path) -> Result<()> {
            call()?;
            NamedTempFile::sync_name(path)
        }
    }

    /// Each call in turn fails, once or from then on: the file has its old content or all of its new one, and the new one where there was no error.
    #[test]
    fn no_fault_leaves_part_of_a_file_under_its_name() {
        let folder = tempfile::Builder::new().prefix("boresight-faults").tempdir().unwrap();
        let path = folder.path().join("out.json");
        let new: Vec<u8> = (0..8000_u32).flat_map(u32::to_le_bytes).collect();
        let mut injected = 0;
        for old in [None, Some(b"old".to_vec())] {
            for fault in [Fault::NoSpace, Fault::InputOutput, Fault::Interrupted, Fault::Short] {
                // Interrupted calls are made again: they cannot be interrupted forever.
                for lasting in
                    [false, true].into_iter().filter(|l| !l || fault != Fault::Interrupted)
                {
                    for at in 0.. {
                        let _ = std::fs::remove_file(&path);
                        let permissions = old.as_ref().map(|old| {
                            std::fs::write(&path, old).unwrap();
                            path.metadata().unwrap().permissions()
                        });
                        PLAN.set((fault, at, lasting, 0));
                        let named = Rc::new(Cell::new(false));
                        let file = Faulty {
                            file: beside(&path).unwrap(),
                            synced: false,
                            named: named.clone(),
                        };
                        let failed =
                            |error| CliError::File { action: "write", path: path.clone(), error };
                        let fill = |out: &mut dyn Write| {
                            // As much at once as tables and plans are written in.
                            new.chunks(1000)
                                .try_for_each(|bytes| out.write_all(bytes))
                                .map_err(failed)
                        };
                        let ended = write_whole(file, &path, permissions, fill, failed);
                        let found = std::fs::read(&path).ok();
                        let expected = if named.get() { Some(new.clone()) } else { old.clone() };
                        assert!(found == expected, "{fault:?} at {at}, lasting: {lasting}");
                        assert!(named.get() || ended.is_err());
                        let names = std::fs::read_dir(folder.path()).unwrap().count();
                        assert_eq!(names, usize::from(found.is_some()), "parts are removed");
                        if PLAN.get().3 <= at {
                            assert!(ended.is_ok());
                            break;
                        }
                        injected += 1;
                    }
                }
            }
        }
        println!("{injected} faults injected");
        assert!(injected >= 400, "{injected}");
    }

    // Nothing is written here: a fault would cost the machine its devices.
    #[test]
    fn devices_are_no_files() {
        for (name, standard_output) in [
            ("/dev/null", false),
            ("/dev/fd/2", false),
            ("/dev/stdout", true),
            ("/dev/fd/1", true),
            ("/proc/self/fd/1", true),
        ] {
            let destination = Destination::new(Path::new(name)).unwrap();
            assert!(destination.file().is_none() && !destination.replaces(), "{name}");
            assert_eq!(destination.is_standard_output(), standard_output, "{name}");
        }
        assert!(
            Destination::new(Path::new("/dev")).is_err_and(|e| e.kind() == ErrorKind::IsADirectory)
        );
    }
}
