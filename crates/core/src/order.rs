//! Order by numbers. What is sorted here is compiled once: for a type of its own each use would cost a module of
//! WebAssembly seven kilobytes.

/// The places of numbers from the least to the greatest, equal ones as they stand. NaN lies as [`f64::total_cmp`] has it.
pub fn ascending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    places(&keys.into_iter().collect::<Vec<f64>>(), false)
}

/// The places of numbers from the greatest to the least, equal ones as they stand.
pub fn descending(keys: impl IntoIterator<Item = f64>) -> Vec<usize> {
    places(&keys.into_iter().collect::<Vec<f64>>(), true)
}

/// Sorts items by a number of each, from the greatest to the least, equal ones as they stand.
pub fn sort_descending<T>(items: &mut Vec<T>, key: impl Fn(&T) -> f64) {
    let order = descending(items.iter().map(key));
    let mut all: Vec<Option<T>> = items.drain(..).map(Some).collect();
    items.extend(order.into_iter().filter_map(|place| all[place].take()));
}

#[inline(never)]
fn places(keys: &[f64], is_descending: bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by(|&a, &b| {
        let by = keys[a].total_cmp(&keys[b]);
        if is_descending { by.reverse() } else { by }
    });
    order
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
    }

    #[test]
    fn nothing_is_lost_beside_nan() {
        assert_eq!(ascending([2.0, f64::NAN, 1.0]), [2, 0, 1]);
        assert_eq!(descending([2.0, f64::NAN, 1.0]), [1, 0, 2]);
        assert!(ascending([]).is_empty());
    }
}
