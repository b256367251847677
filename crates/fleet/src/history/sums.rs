//! Sums over stretches of drives, from which every fit follows.

use std::ops::{Add, Range, Sub};

/// Mean square of the times about their means, over the length of the series squared, below which they are taken to be the same.
const LEAST_TIMES: f64 = 1e-10;

/// A drive: time over the length of the series, angle about a reference, its independent and its shared deviation, and the probability that
/// it is not off by more.
#[derive(Debug, Clone, Copy)]
pub(super) struct Datum {
    pub time: f64,
    pub angle: f64,
    pub sigma: f64,
    pub floor: f64,
    pub inlying: f64,
}

/// Weighted sums; weights are `inlying / sigma^2`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    /// Drives, each with the probability that it is not off.
    pub n: f64,
    pub w: f64,
    /// Squared weights.
    pub ww: f64,
    pub t: f64,
    pub y: f64,
    pub tt: f64,
    pub ty: f64,
    pub yy: f64,
    pub floor: f64,
}

/// Squares and products about the means.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Centred {
    pub w: f64,
    pub tt: f64,
    pub ty: f64,
    pub yy: f64,
}

macro_rules! by_field {
    ($trait:ident, $method:ident, $operator:tt, $type:ident, $($field:ident),*) => {
        impl $trait for $type {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self { $($field: self.$field $operator other.$field),* }
            }
        }
    };
}
by_field!(Add, add, +, Sums, n, w, ww, t, y, tt, ty, yy, floor);
by_field!(Sub, sub, -, Sums, n, w, ww, t, y, tt, ty, yy, floor);
by_field!(Add, add, +, Centred, w, tt, ty, yy);
by_field!(Sub, sub, -, Centred, w, tt, ty, yy);

impl Sums {
    pub fn mean_t(&self) -> f64 {
        if self.w > 0.0 { self.t / self.w } else { 0.0 }
    }

    pub fn mean_y(&self) -> f64 {
        if self.w > 0.0 { self.y / self.w } else { 0.0 }
    }

    pub fn centred(&self) -> Centred {
        Centred {
            w: self.w,
            tt: (self.tt - self.t * self.mean_t()).max(0.0),
            ty: self.ty - self.t * self.mean_y(),
            yy: (self.yy - self.y * self.mean_y()).max(0.0),
        }
    }

    /// As many drives of one weight would be as sure of their mean.
    pub fn effective(&self) -> f64 {
        if self.ww > 0.0 { self.w * self.w / self.ww } else { 0.0 }
    }
}

impl Centred {
    /// Whether the times differ enough for a rate.
    pub fn has_rate(&self) -> bool {
        self.tt > LEAST_TIMES * self.w
    }

    /// Weighted squares that a fit leaves.
    pub fn left(&self, rate: bool) -> f64 {
        let taken = if rate && self.has_rate() { self.ty * self.ty / self.tt } else { 0.0 };
        (self.yy - taken).max(0.0)
    }
}

/// Sums up to each drive.
pub(super) struct Prefix {
    sums: Vec<Sums>,
}

/// Levels between knocks and a common rate.
pub(super) struct Line {
    starts: Vec<usize>,
    pub levels: Vec<f64>,
    /// None without, or where times do not differ.
    pub rate: Option<f64>,
}

impl Line {
    /// The fit at drive `k`, at a time.
    pub fn at(&self, k: usize, time: f64) -> f64 {
        let segment = self.starts.partition_point(|&start| start <= k);
        self.levels[segment] + self.rate.unwrap_or(0.0) * time
    }
}

impl Prefix {
    pub fn of(data: &[Datum]) -> Self {
        let mut sums = Vec::with_capacity(data.len() + 1);
        let mut sum = Sums::default();
        sums.push(sum);
        for d in data {
            let w = d.inlying / (d.sigma * d.sigma);
            let (t, y) = (w * d.time, w * d.angle);
            sum = sum
                + Sums {
                    n: d.inlying,
                    w,
                    ww: w * w,
                    t,
                    y,
                    tt: t * d.time,
                    ty: t * d.angle,
                    yy: y * d.angle,
                    floor: w * d.floor,
                };
            sums.push(sum);
        }
        Self { sums }
    }

    pub fn len(&self) -> usize {
        self.sums.len() - 1
    }

    pub fn over(&self, range: Range<usize>) -> Sums {
        self.sums[range.end] - self.sums[range.start]
    }

    pub fn all(&self) -> Sums {
        self.over(0..self.len())
    }

    pub fn inlying(&self, k: usize) -> f64 {
        self.over(k..k + 1).n
    }

    /// The deviation that the drives of a stretch share.
    pub fn floor(&self, range: Range<usize>) -> f64 {
        let sums = self.over(range);
        if sums.w > 0.0 { sums.floor / sums.w } else { 0.0 }
    }

    /// The stretches between knocks.
    pub fn segments(&self, starts: &[usize]) -> impl Iterator<Item = Range<usize>> {
        let end = self.len();
        (0..=starts.len()).map(move |j| {
            let from = if j == 0 { 0 } else { starts[j - 1] };
            from..starts.get(j).copied().unwrap_or(end)
        })
    }

    /// Squares about the means of all stretches.
    pub fn centred(&self, starts: &[usize]) -> Centred {
        self.segments(starts)
            .map(|range| self.over(range).centred())
            .fold(Centred::default(), Add::add)
    }

    pub fn line(&self, starts: &[usize], rate: bool) -> Line {
        let centred = self.centred(starts);
        let rate = (rate && centred.has_rate()).then(|| centred.ty / centred.tt);
        let level = |range: Range<usize>| {
            let sums = self.over(range);
            sums.mean_y() - rate.unwrap_or(0.0) * sums.mean_t()
        };
        let levels = self.segments(starts).map(level).collect();
        Line { starts: starts.to_vec(), levels, rate }
    }
}
