//! Order by numbers. What is sorted here is compiled once: for a type of its own each use would cost a module of
//! WebAssembly seven kilobytes.

use std::cmp::Ordering;

/// The places of numbers from the least to the greatest, equal ones as they stand. NaN lies as [`f64::total_cmp`] has it.
pub fn ascending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    places(&keys.into_iter().collect::<Vec<f64>>(), false)
}

/// The places of numbers from the greatest to the least, equal ones as they stand.
pub fn descending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    places(&keys.into_iter().collect::<Vec<f64>>(), true)
}

/// Sorts items by a number of each, from the greatest to the least, equal ones as they stand.
pub fn sort_descending<T>(items: &mut [T], key: impl Fn(&T) -> f64) {
    let order = descending(items.iter().map(key));
    permute(items, order);
}

/// Sorts items by a number of each, from the least to the greatest, equal ones as they stand.
pub fn sort_ascending<T>(items: &mut [T], key: impl Fn(&T) -> f64) {
    let order = ascending(items.iter().map(key));
    permute(items, order);
}

/// Sorts items as [`slice::sort_by`] does.
pub fn sort_by<T>(items: &mut [T], mut compare: impl FnMut(&T, &T) -> Ordering) {
    let order = sorted(items.len(), &mut |a, b| compare(&items[a], &items[b]));
    permute(items, order);
}

/// Sorts numbers from the least to the greatest, NaN as [`f64::total_cmp`] has it.
#[inline(never)]
pub fn sort_numbers(numbers: &mut [f64]) {
    numbers.sort_unstable_by(f64::total_cmp);
}

/// Sorts items without further memory, equal ones in any order: by heap, whose code is small. `before` tells whether the
/// first of two comes before the second.
pub fn sort_in_place<T>(items: &mut [T], before: impl Fn(&T, &T) -> bool) {
    let count = items.len();
    // A heap whose root comes last: made from the middle down, then emptied from the end.
    for step in (1..count + count / 2).rev() {
        let (mut at, end) = if step < count {
            items.swap(0, step);
            (0, step)
        } else {
            (step - count, count)
        };
        loop {
            let mut last = 2 * at + 1;
            if last >= end {
                break;
            }
            if last + 1 < end && before(&items[last], &items[last + 1]) {
                last += 1;
            }
            if !before(&items[at], &items[last]) {
                break;
            }
            items.swap(at, last);
            at = last;
        }
    }
}

fn places(keys: &[f64], is_descending: bool) -> Vec<usize> {
    sorted(keys.len(), &mut |a, b| {
        let by = keys[a].total_cmp(&keys[b]);
        if is_descending { by.reverse() } else { by }
    })
}

#[inline(never)]
fn sorted(len: usize, compare: &mut dyn FnMut(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..len).collect();
    order.sort_by(|&a, &b| compare(a, b));
    order
}

/// Moves the item at each `order[i]` to `i`.
fn permute<T>(items: &mut [T], mut order: Vec<usize>) {
    for start in 0..items.len() {
        let mut at = start;
        while order[at] != start {
            let from = std::mem::replace(&mut order[at], at);
            items.swap(at, from);
            at = from;
        }
        order[at] = at;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_numbers_stay_as_they_stand() {
        let keys = [1.0, 3.0, 1.0, -2.0, 3.0];
        assert_eq!(ascending(keys), [3, 0, 2, 1, 4]);
        assert_eq!(descending(keys), [1, 4, 0, 2, 3]);
        let mut items: Vec<(f64, char)> = keys.into_iter().zip('a'..).collect();
        sort_descending(&mut items, |item| item.0);
        assert_eq!(items.iter().map(|item| item.1).collect::<String>(), "beacd");
        sort_ascending(&mut items, |item| item.0);
        assert_eq!(items.iter().map(|item| item.1).collect::<String>(), "dacbe");
        sort_by(&mut items, |a, b| b.1.cmp(&a.1));
        assert_eq!(items.iter().map(|item| item.1).collect::<String>(), "edcba");
        let mut numbers = keys;
        sort_numbers(&mut numbers);
        assert_eq!(numbers, [-2.0, 1.0, 1.0, 3.0, 3.0]);
    }

    #[test]
    fn items_are_sorted_as_the_standard_library_does() {
        let mut random = crate::random::Random::new(7, 1);
        for length in 0..60 {
            let mut items: Vec<(u64, usize)> =
                (0..length).map(|index| (random.bits() % 8, index)).collect();
            let mut expected = items.clone();
            expected.sort_by_key(|item| item.0);
            sort_by(&mut items, |a, b| a.0.cmp(&b.0));
            assert_eq!(items, expected);
            items.reverse();
            sort_in_place(&mut items, |a, b| a < b);
            expected.sort_unstable();
            assert_eq!(items, expected);
        }
    }

    #[test]
    fn nothing_is_lost_beside_nan() {
        assert_eq!(ascending([2.0, f64::NAN, 1.0]), [2, 0, 1]);
        assert_eq!(descending([2.0, f64::NAN, 1.0]), [1, 0, 2]);
        assert!(ascending([]).is_empty());
    }
}
