//! Datasets of numbers, listed and read.

use super::number::{Field, Kind, chunks_inside, field, most_bytes, wrong};
use super::{guard, matlab};
use crate::error::FormatError;
use crate::npy::{NpyArray, NpyData};
use boresight_core::{Complex32, Complex64};
use hdf5_pure::{Dataset, Datatype, File, Group};

/// Groups within groups that are looked into, how many of them, and datasets that are listed.
const DEEPEST: usize = 8;
const MOST_GROUPS: usize = 256;
const MOST_LISTED: usize = 1024;
/// Axes of an array.
const MOST_AXES: usize = 32;

/// A dataset of numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ArrayEntry {
    /// Its name, with those of its groups before it and `/` between.
    pub name: String,
    /// Lengths of its axes.
    pub shape: Vec<usize>,
    /// Whether its numbers are complex.
    pub complex: bool,
}

/// How the elements of a dataset are read.
#[derive(Debug, Clone, Copy)]
enum Elements {
    Real(Field),
    Complex([Field; 2]),
}

/// A dataset of numbers, ready to be read.
struct Found {
    entry: ArrayEntry,
    dataset: Dataset,
    elements: Elements,
    element_bytes: usize,
    /// Whether the axes stand backwards in the file.
    backwards: bool,
}

fn open(bytes: Vec<u8>) -> Result<File, FormatError> {
    matlab::refuse_earlier(&bytes)?;
    guard::from_bytes(bytes).map_err(|error| wrong("the file", "a whole HDF5 file", error))
}

/// The datasets of numbers in a file.
///
/// # Errors
/// [`FormatError::Hdf5`] for a file that is none.
pub fn list(bytes: Vec<u8>) -> Result<Vec<ArrayEntry>, FormatError> {
    let file = open(bytes)?;
    Ok(found(&file).into_iter().map(|found| found.entry).collect())
}

/// Reads a dataset by its name, or the only one of numbers there is.
///
/// # Errors
/// [`FormatError::Hdf5`] for a file that is none, with the names and shapes there are where one has to be named, and for a
/// dataset that is damaged, or larger than the file can hold.
pub fn read(bytes: Vec<u8>, name: Option<&str>) -> Result<NpyArray, FormatError> {
    let file = open(bytes)?;
    let mut all = found(&file);
    let at = match name {
        Some(name) => {
            let name = name.trim_start_matches('/');
            all.iter().position(|found| found.entry.name == name)
        }
        None => (all.len() == 1).then_some(0),
    };
    let Some(at) = at else {
        let shown = all
            .iter()
            .take(16)
            .map(|found| format!("{} {:?}", found.entry.name, found.entry.shape));
        let mut shown = shown.collect::<Vec<_>>().join(", ");
        if all.len() > 16 {
            shown += &format!(" and {} more", all.len() - 16);
        }
        let expected = match (all.len(), name) {
            (0, _) => "a dataset of real or complex numbers".into(),
            (_, Some(_)) => format!("one of {shown}"),
            (_, None) => format!("the name of one of {shown}"),
        };
        return Err(wrong("dataset", expected, name.unwrap_or("none named")));
    };
    numbers(&file, &all.swap_remove(at))
}

fn found(file: &File) -> Vec<Found> {
    let mut all = vec![];
    walk(&file.root(), "", (0, &mut 0), &mut all);
    all
}

/// Datasets of numbers in a group and those in it; what cannot be read is none. Groups may hold themselves.
fn walk(group: &Group, path: &str, (depth, groups): (usize, &mut usize), all: &mut Vec<Found>) {
    let sorted = |mut names: Vec<String>| {
        boresight_math::order::sort_by(&mut names, Ord::cmp);
        names
    };
    for name in sorted(group.datasets().unwrap_or_default()) {
        let dataset = group.dataset(&name).ok().filter(|_| all.len() < MOST_LISTED);
        all.extend(dataset.and_then(|dataset| describe(&format!("{path}{name}"), dataset)));
    }
    for name in sorted(group.groups().unwrap_or_default()) {
        *groups += 1;
        // The first two are what MATLAB's cells and objects refer to.
        if ["#refs#", "#subsystem#"].contains(&&*name) || depth == DEEPEST || *groups > MOST_GROUPS
        {
            continue;
        }
        if let Ok(inner) = group.group(&name) {
            walk(&inner, &format!("{path}{name}/"), (depth + 1, groups), all);
        }
    }
}

fn describe(name: &str, dataset: Dataset) -> Option<Found> {
    let datatype = dataset.datatype().ok()?;
    let elements = elements(name, &datatype)?;
    let (backwards, is_numbers) = matlab::variable(&dataset);
    let shape = dataset.shape().ok()?;
    let shape: Option<Vec<usize>> = shape.into_iter().map(|n| usize::try_from(n).ok()).collect();
    let mut shape = shape.filter(|shape| shape.len() <= MOST_AXES && is_numbers)?;
    if backwards {
        shape.reverse();
    }
    let element_bytes = usize::try_from(dataset.element_size().ok()?).ok()?;
    let complex = matches!(elements, Elements::Complex(_));
    let entry = ArrayEntry { name: name.into(), shape, complex };
    Some(Found { entry, dataset, elements, element_bytes, backwards })
}

fn elements(name: &str, datatype: &Datatype) -> Option<Elements> {
    let Datatype::Compound { members, .. } = datatype else {
        return field(name, 0, datatype).ok().map(Elements::Real);
    };
    let [re, im] = &members[..] else { return None };
    if !matches!((re.name.as_str(), im.name.as_str()), ("r", "i") | ("real", "imag")) {
        return None;
    }
    let [re, im] = [re, im].map(|member| field(name, member.byte_offset, &member.datatype).ok());
    Some(Elements::Complex([re?, im?]))
}

fn numbers(file: &File, found: &Found) -> Result<NpyArray, FormatError> {
    let Found { entry, dataset, elements, element_bytes, backwards } = found;
    let name = entry.name.as_str();
    let most = most_bytes(file);
    let chunk = dataset.chunk_shape().ok().flatten().unwrap_or_default();
    for lengths in [entry.shape.iter().map(|n| *n as u64).collect(), chunk] {
        let whole = (*element_bytes).max(8) as u64;
        let bytes = lengths.iter().try_fold(whole, |bytes, n| bytes.checked_mul((*n).max(1)));
        if bytes.is_none_or(|bytes| bytes > most) {
            let given = format!("{lengths:?}");
            return Err(wrong(name, "no more numbers than the file can hold", given));
        }
    }
    chunks_inside(file, name, dataset)?;
    let bytes = dataset.read_raw().map_err(|error| wrong(name, "readable numbers", error))?;
    let count: usize = entry.shape.iter().product();
    if Some(bytes.len()) != count.checked_mul(*element_bytes) {
        let expected = format!("{count} elements of {element_bytes} bytes");
        return Err(wrong(name, expected, format!("{} bytes", bytes.len())));
    }
    let order = Order { shape: &entry.shape, backwards: *backwards && entry.shape.len() > 1 };
    let row = |index: usize| &bytes[element_bytes * index..element_bytes * (index + 1)];
    let data = match *elements {
        Elements::Real(field) => match (field.kind, field.size) {
            (Kind::Float, 4) => NpyData::Float32(order.map(count, |i| field.number(row(i)) as f32)),
            (Kind::Float, _) => NpyData::Float64(order.map(count, |i| field.number(row(i)))),
            _ => {
                let whole = |i: usize| {
                    let given = field.integer(row(i));
                    i64::try_from(given).map_err(|_| wrong(name, "integers below 2^63", given))
                };
                (0..count).try_for_each(|i| whole(i).map(|_| ()))?;
                NpyData::Integer(order.map(count, |i| whole(i).unwrap_or_default()))
            }
        },
        Elements::Complex([re, im]) => {
            let single =
                [re, im].iter().all(|part| matches!((part.kind, part.size), (Kind::Float, 4)));
            let at = |i: usize| Complex64::new(re.number(row(i)), im.number(row(i)));
            if single {
                NpyData::Complex32(order.map(count, |i| {
                    let z = at(i);
                    Complex32::new(z.re as f32, z.im as f32)
                }))
            } else {
                NpyData::Complex64(order.map(count, at))
            }
        }
    };
    Ok(NpyArray { shape: entry.shape.clone(), data })
}

/// Where the elements of an array lie.
struct Order<'a> {
    shape: &'a [usize],
    backwards: bool,
}

impl Order<'_> {
    /// All elements in C order, each from its place in the file.
    fn map<T>(&self, count: usize, element: impl Fn(usize) -> T) -> Vec<T> {
        (0..count).map(|index| element(self.place(index))).collect()
    }

    fn place(&self, index: usize) -> usize {
        if self.backwards { crate::npy::first_index_first(self.shape, index) } else { index }
    }
}
