//! Messages that hold detections as structs: `radar_msgs/RadarScan` and `RadarTracks`, and vendors' own,
//! with one detection or a list of them.

use super::quantity::{Layout, Quantity};
use crate::ros::{Definitions, Field, Kind, Many, Value};
use boresight_core::drive::Detection;

/// How deep the numbers of a detection lie in it, as `position.x` does.
const MAX_DEPTH: usize = 3;
/// Most numbers of a detection.
const MAX_NUMBERS: usize = 1024;

/// Where detections stand in a message.
pub(super) struct ListPaths {
    /// The list; nothing for a message that is one detection.
    list: Option<Vec<usize>>,
    /// To each number of a detection.
    numbers: Vec<Vec<usize>>,
    layout: Layout,
    /// In a message that is one detection, the number that begins anew with each scan.
    point: Option<Vec<usize>>,
    mirrored: bool,
}

impl ListPaths {
    /// Of a message with a list of detections, or that is one; otherwise what the nearest to one lacks.
    /// `text` is that of the definition, which may say that azimuths are positive to the right.
    pub fn of(definitions: &Definitions, text: &[u8]) -> Result<Self, &'static str> {
        let mut lacks = None;
        let mut candidates = vec![(None, 0)];
        for (place, field) in definitions.root().fields.iter().enumerate() {
            match *field {
                Field {
                    kind: Kind::Struct(one), many: Many::Sequence | Many::Fixed(_), ..
                } => {
                    candidates.insert(0, (Some(vec![place]), one));
                }
                Field { kind: Kind::Struct(one), many: Many::One, .. } => {
                    for (inner, field) in definitions.get(one).fields.iter().enumerate() {
                        if let Kind::Struct(of) = field.kind
                            && field.many != Many::One
                        {
                            candidates.push((Some(vec![place, inner]), of));
                        }
                    }
                }
                _ => {}
            }
        }
        for (list, one) in candidates {
            let mut numbers = vec![];
            leaves(definitions, one, &mut vec![], &mut String::new(), &mut numbers);
            let layout = Layout::of_names(numbers.iter().map(|(name, _)| &**name));
            match layout.lacks() {
                None => {
                    return Ok(Self {
                        point: list.is_none().then(|| definitions.path(0, "point_id")).flatten(),
                        list,
                        numbers: numbers.into_iter().map(|(_, path)| path).collect(),
                        layout,
                        mirrored: says_clockwise(text),
                    });
                }
                Some(lack) if list.is_some() => lacks = lacks.or(Some(lack)),
                Some(_) => {}
            }
        }
        Err(lacks.unwrap_or("no detections are known in messages of its type"))
    }

    /// The detections of a message, nothing for those whose azimuth or range rate is no finite number.
    pub fn detections<'m>(
        &'m self,
        message: &'m Value<'m>,
    ) -> impl Iterator<Item = Option<Detection>> + 'm {
        let one = self.list.is_none().then_some(message).into_iter();
        let many = self.list.as_ref().map_or(&[][..], |list| message.list(list)).iter();
        one.chain(many).map(|detection| {
            let number = |place: usize| detection.number(self.numbers.get(place)?);
            self.layout.detection(number, self.mirrored)
        })
    }

    /// Whether a detection lacks a number that the message's type has.
    pub fn is_incomplete(&self, detection: &Detection) -> bool {
        self.layout.is_incomplete(detection)
    }

    /// The number of a detection in its scan, where messages hold one each.
    pub fn point(&self, message: &Value<'_>) -> Option<f64> {
        message.number(self.point.as_ref()?)
    }

    /// Whether messages hold one detection each.
    pub fn is_single(&self) -> bool {
        self.list.is_none()
    }

    /// Whether azimuths were taken as positive to the right.
    pub fn is_mirrored(&self) -> bool {
        self.mirrored && self.layout.place(Quantity::X).is_none()
    }
}

/// Whether the text of `radar_msgs/RadarReturn` is that of its first version, in which "Negative angles
/// are anticlockwise"; later ones follow REP 103.
fn says_clockwise(text: &[u8]) -> bool {
    let text = String::from_utf8_lossy(text).to_ascii_lowercase();
    text.contains("negative angles are anticlockwise")
        || text.contains("positive angles are clockwise")
}

/// The numbers of a type, with their names from the type down.
fn leaves(
    definitions: &Definitions,
    of: usize,
    path: &mut Vec<usize>,
    name: &mut String,
    into: &mut Vec<(String, Vec<usize>)>,
) {
    for (place, field) in definitions.get(of).fields.iter().enumerate() {
        if field.many != Many::One || into.len() >= MAX_NUMBERS {
            continue;
        }
        let length = name.len();
        path.push(place);
        name.push_str(if length > 0 { "." } else { "" });
        name.push_str(&field.name);
        match field.kind {
            Kind::Number(_) => into.push((name.clone(), path.clone())),
            Kind::Struct(of) if path.len() < MAX_DEPTH => {
                leaves(definitions, of, path, name, into);
            }
            _ => {}
        }
        name.truncate(length);
        path.pop();
    }
}
