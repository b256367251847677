//! Where radars sit, from the fixed transforms of a recording (`tf2_msgs/TFMessage` on `/tf_static`).

use crate::ros::{Definitions, Field, Kind, Many, Value};
use boresight_core::drive::Mounting;
use std::collections::BTreeMap;

/// Most transforms between a radar and the car.
const MAX_CHAIN: usize = 64;
/// Most frames that are kept.
const MAX_FRAMES: usize = 1 << 16;

/// From a frame to the one above it: rows of the rotation, and the shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Transform {
    pub rotation: [[f64; 3]; 3],
    pub shift: [f64; 3],
}

impl Transform {
    const NONE: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], shift: [0.0; 3] };

    /// By a shift and a quaternion (x, y, z, w) of any length; `None` where these are no finite numbers.
    pub fn new(shift: [f64; 3], quaternion: [f64; 4]) -> Option<Self> {
        let length = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        if !(length > 1e-9 && length.is_finite() && shift.iter().all(|part| part.is_finite())) {
            return None;
        }
        let [x, y, z, w] = quaternion.map(|part| part / length);
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Some(Self { rotation, shift })
    }

    /// A direction in the frame above.
    pub fn turned(&self, direction: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|row| row.iter().zip(direction).map(|(a, b)| a * b).sum())
    }

    /// This one after another.
    fn after(&self, inner: &Self) -> Self {
        let column = |k: usize| self.turned(inner.rotation.map(|row| row[k]));
        let [a, b, c] = [column(0), column(1), column(2)];
        let moved = self.turned(inner.shift);
        Self {
            rotation: std::array::from_fn(|i| [a[i], b[i], c[i]]),
            shift: std::array::from_fn(|i| moved[i] + self.shift[i]),
        }
    }

    /// Place and direction of a radar's x, and whether the radar is upside down.
    pub fn mounting(&self) -> (Mounting, bool) {
        let [x_m, y_m, _] = self.shift;
        let yaw_rad = self.rotation[1][0].atan2(self.rotation[0][0]);
        (Mounting { x_m, y_m, yaw_rad }, self.rotation[2][2] < 0.0)
    }
}

/// Frames by their names.
#[derive(Default)]
pub(super) struct Frames {
    above: BTreeMap<String, (String, Transform)>,
}

impl Frames {
    /// From a frame to one that it hangs on.
    pub fn between(&self, frame: &str, base: &str) -> Option<Transform> {
        let mut at = plain(frame);
        let mut whole = Transform::NONE;
        for _ in 0..MAX_CHAIN {
            if at == plain(base) {
                return Some(whole);
            }
            let (parent, transform) = self.above.get(at)?;
            whole = transform.after(&whole);
            at = parent;
        }
        None
    }

    /// Takes what a message says; later ones replace earlier ones.
    pub fn take(&mut self, paths: &TransformPaths, message: &Value<'_>) {
        for one in message.list(&paths.list) {
            let numbers = |paths: &[Vec<usize>]| {
                paths.iter().map(|path| one.number(path)).collect::<Option<Vec<_>>>()
            };
            let text = |path: &[usize]| one.text(path).map(|name| plain(name).to_owned());
            let whole = (|| {
                let [x, y, z] = numbers(&paths.shift)?.try_into().ok()?;
                let [a, b, c, d] = numbers(&paths.rotation)?.try_into().ok()?;
                let transform = Transform::new([x, y, z], [a, b, c, d])?;
                Some((text(&paths.child)?, (text(&paths.parent)?, transform)))
            })();
            if let Some((child, above)) = whole
                && self.above.len() < MAX_FRAMES
            {
                self.above.insert(child, above);
            }
        }
    }
}

/// ROS 1 begins names with a slash.
fn plain(frame: &str) -> &str {
    frame.strip_prefix('/').unwrap_or(frame)
}

/// Where the parts of transforms stand in their message.
pub(super) struct TransformPaths {
    list: Vec<usize>,
    parent: Vec<usize>,
    child: Vec<usize>,
    shift: [Vec<usize>; 3],
    rotation: [Vec<usize>; 4],
}

impl TransformPaths {
    /// Of a message that has them.
    pub fn of(definitions: &Definitions) -> Option<Self> {
        let list = definitions.path(0, "transforms")?;
        let Field { kind: Kind::Struct(one), many: Many::Sequence, .. } =
            definitions.root().fields.get(*list.first()?)?
        else {
            return None;
        };
        let path = |name: &str| definitions.path(*one, name);
        let shift = |name: &str| path(&format!("transform.translation.{name}"));
        let turn = |name: &str| path(&format!("transform.rotation.{name}"));
        Some(Self {
            parent: path("header.frame_id")?,
            child: path("child_frame_id")?,
            shift: [shift("x")?, shift("y")?, shift("z")?],
            rotation: [turn("x")?, turn("y")?, turn("z")?, turn("w")?],
            list,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    fn yaw(angle: f64) -> [f64; 4] {
        [0.0, 0.0, (angle / 2.0).sin(), (angle / 2.0).cos()]
    }

    fn frames(all: &[(&str, &str, [f64; 3], [f64; 4])]) -> Frames {
        let mut frames = Frames::default();
        for (parent, child, shift, turn) in all {
            let transform = Transform::new(*shift, *turn).unwrap();
            frames.above.insert((*child).into(), ((*parent).into(), transform));
        }
        frames
    }

    #[test]
    fn transforms_along_a_chain_are_joined() {
        let frames = frames(&[
            ("base_link", "bumper", [3.0, 1.0, 0.5], yaw(FRAC_PI_2)),
            ("bumper", "radar", [1.0, 2.0, 0.0], yaw(-FRAC_PI_4)),
        ]);
        let (mounting, is_down) = frames.between("/radar", "base_link").unwrap().mounting();
        assert!((mounting.x_m - 1.0).abs() < 1e-12 && (mounting.y_m - 2.0).abs() < 1e-12);
        assert!((mounting.yaw_rad - FRAC_PI_4).abs() < 1e-12 && !is_down);
        assert!(
            frames.between("radar", "map").is_none() && frames.between("x", "bumper").is_none()
        );
        assert_eq!(frames.between("map", "map"), Some(Transform::NONE));
    }

    #[test]
    fn a_radar_upside_down_is_told_and_rings_end() {
        let turned = [(PI / 2.0).sin(), 0.0, 0.0, (PI / 2.0).cos()];
        let down = frames(&[("base_link", "radar", [1.0, 0.0, 0.0], turned)]);
        let (mounting, is_down) = down.between("radar", "base_link").unwrap().mounting();
        assert!(is_down && mounting.yaw_rad.abs() < 1e-12);
        let ring = frames(&[("b", "a", [0.0; 3], yaw(0.0)), ("a", "b", [0.0; 3], yaw(0.0))]);
        assert!(ring.between("a", "base_link").is_none());
        assert!(Transform::new([0.0; 3], [0.0; 4]).is_none());
        assert!(Transform::new([f64::NAN, 0.0, 0.0], yaw(0.0)).is_none());
    }
}
