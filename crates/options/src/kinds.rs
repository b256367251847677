//! Descriptions of the types that fields are made of.

use crate::check::At;
use crate::description::{Described, Kind, NumberType, Range};
use boresight_math::InputError;
use num_complex::Complex64;

impl Described for f64 {
    const KIND: Kind = Kind::Number;
    const LIST: Kind = Kind::Numbers(NumberType::F64);

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        at.number(*self, range)
    }
}

impl Described for f32 {
    const KIND: Kind = Kind::Number;
    const LIST: Kind = Kind::Numbers(NumberType::F32);

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        at.number((*self).into(), range)
    }
}

macro_rules! whole {
    ($($type:ty: $list:expr),*) => {$(
        impl Described for $type {
            const KIND: Kind = Kind::Whole;
            const LIST: Kind = $list;

            fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
                at.number(*self as f64, range)
            }
        }
    )*};
}
whole!(
    usize: Kind::List(&Kind::Whole),
    u16: Kind::List(&Kind::Whole),
    u32: Kind::Numbers(NumberType::U32),
    u8: Kind::Numbers(NumberType::U8),
    i8: Kind::Numbers(NumberType::I8),
    i32: Kind::List(&Kind::Whole)
);

impl Described for u64 {
    const KIND: Kind = Kind::Seed;
}

impl Described for bool {
    const KIND: Kind = Kind::Truth;
}

impl Described for String {
    const KIND: Kind = Kind::Text;
}

impl Described for str {
    const KIND: Kind = Kind::Text;
}

impl Described for Complex64 {
    const KIND: Kind = Kind::Tuple(&Kind::Number, 2);
}

impl<T: Described + ?Sized> Described for &T {
    const KIND: Kind = T::KIND;
}

impl<T: Described> Described for [T] {
    const KIND: Kind = T::LIST;
}

impl<T: Described> Described for Option<T> {
    const KIND: Kind = Kind::Optional(&T::KIND);

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        self.as_ref().map_or(Ok(()), |value| value.check(range, at))
    }
}

impl<T: Described> Described for Vec<T> {
    const KIND: Kind = T::LIST;

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        self.iter().enumerate().try_for_each(|(i, value)| value.check(range, &at.item(i)))
    }
}

impl<T: Described, const N: usize> Described for [T; N] {
    const KIND: Kind = Kind::Tuple(&T::KIND, N);

    fn check(&self, range: Option<Range>, at: &At<'_>) -> Result<(), InputError> {
        self.iter().enumerate().try_for_each(|(i, value)| value.check(range, &at.item(i)))
    }
}
