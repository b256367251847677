//! Which fields of two structs differ, for tests that change one at a time.

use std::collections::BTreeMap;
use std::fmt::Debug;

/// The fields in which two structs differ by their `Debug`, as paths such as `iaa.threshold_db`; lists
/// and options count as one field.
#[must_use]
pub fn differing_fields<T: Debug>(a: &T, b: &T) -> Vec<String> {
    let (a, b) = (fields(&format!("{a:#?}")), fields(&format!("{b:#?}")));
    let mut names: Vec<String> = a.keys().chain(b.keys()).cloned().collect();
    boresight_math::order::sort_by(&mut names, Ord::cmp);
    names.dedup();
    names.retain(|name| a.get(name) != b.get(name));
    names
}

/// Whether a field, such as [`differing_fields`] names it, is `own` or lies inside it.
#[must_use]
pub fn lies_in(field: &str, own: &str) -> bool {
    field.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The text of each field of a struct, and of the structs in it.
fn fields(debug: &str) -> BTreeMap<String, String> {
    let mut values = BTreeMap::<String, String>::new();
    let mut path: Vec<&str> = vec![];
    // The depth at which a list or an option ends, and its field.
    let mut inside: Option<(usize, String)> = None;
    for line in debug.lines().skip(1) {
        let text = line.trim_start();
        let depth = line.len() - text.len();
        if let Some((end, name)) = &inside {
            values.entry(name.clone()).or_default().push_str(text);
            if depth == *end {
                inside = None;
            }
            continue;
        }
        let Some((name, value)) = text.split_once(": ") else {
            path.pop();
            continue;
        };
        let full = [&path[..], &[name]].concat().join(".");
        let opens = value.ends_with(['[', '(', '{']);
        if value.ends_with(" {") {
            path.push(name);
        } else {
            values.insert(full.clone(), value.into());
            inside = opens.then_some((depth, full));
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::differing_fields;

    #[test]
    fn each_changed_field_is_named() {
        #[derive(Debug, Clone, Default)]
        #[allow(dead_code)]
        struct Inner {
            a: f64,
            b: Option<[f64; 2]>,
        }
        #[derive(Debug, Clone, Default)]
        #[allow(dead_code)]
        struct Outer {
            inner: Inner,
            list: Vec<Inner>,
            last: u8,
        }
        let plain = Outer::default();
        let mut changed = plain.clone();
        assert!(differing_fields(&plain, &changed).is_empty());
        changed.inner.b = Some([1.0, 2.0]);
        assert_eq!(differing_fields(&plain, &changed), ["inner.b"]);
        changed.list.push(Inner::default());
        changed.last = 1;
        assert_eq!(differing_fields(&plain, &changed), ["inner.b", "last", "list"]);
        let mut deeper = changed.clone();
        deeper.list[0].a = 3.0;
        assert_eq!(differing_fields(&changed, &deeper), ["list"]);
    }
}
