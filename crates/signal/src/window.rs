//! Windows for the range and Doppler transforms.

use crate::error::SignalError;
use boresight_core::{Complex64, InputError};
use boresight_math::error::check_range;
use boresight_math::fft::Transforms;
use boresight_options::{Choice, Described, Kind, doc};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::f64::consts::PI;

/// Longest window, so that a wrong length cannot exhaust memory.
pub const MAX_LENGTH: usize = 1 << 20;

/// A taper, symmetric about the middle of the data, with a largest value of 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Window {
    /// All ones: best resolution, sidelobes at -13 dB.
    Rectangular,
    /// Raised cosine, sidelobes from -31 dB falling 18 dB an octave.
    #[default]
    Hann,
    /// Raised cosine on a pedestal (0.54, 0.46), sidelobes at -43 dB.
    Hamming,
    /// Three terms (0.42, 0.5, 0.08), sidelobes at -58 dB.
    Blackman,
    /// Four terms (Harris 1978), sidelobes at -92 dB.
    BlackmanHarris,
    /// Dolph-Chebyshev: the narrowest main lobe for sidelobes all at `-sidelobe_db`.
    Chebyshev {
        /// Main lobe over sidelobes, dB, 20 to 150.
        sidelobe_db: f64,
    },
    /// Taylor: `nbar - 1` sidelobes near `-sidelobe_db`, the others falling.
    Taylor {
        /// Sidelobes of nearly constant level, plus one; 1 to 32.
        nbar: usize,
        /// Main lobe over the near sidelobes, dB, 15 to 100.
        sidelobe_db: f64,
    },
}

impl Described for Window {
    const KIND: Kind = Kind::Choice(&Choice {
        name: "WindowName",
        doc: doc("A taper."),
        variants: &[
            ("rectangular", doc("All ones: best resolution, sidelobes at -13 dB.")),
            ("hann", doc("Raised cosine, sidelobes from -31 dB falling 18 dB an octave.")),
            ("hamming", doc("Raised cosine on a pedestal, sidelobes at -43 dB.")),
            ("blackman", doc("Three terms, sidelobes at -58 dB.")),
            ("blackman-harris", doc("Four terms, sidelobes at -92 dB.")),
            (
                "chebyshev",
                doc("Dolph-Chebyshev: the narrowest main lobe for sidelobes all at -80 dB."),
            ),
            ("taylor", doc("Taylor: three sidelobes near -40 dB, the others falling.")),
        ],
    });
}

impl<'de> Deserialize<'de> for Window {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::named(&name).map_err(|_| D::Error::unknown_variant(&name, &Self::NAMES))
    }
}

impl Serialize for Window {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl Window {
    /// Names [`Window::named`] knows.
    pub const NAMES: [&'static str; 7] =
        ["rectangular", "hann", "hamming", "blackman", "blackman-harris", "chebyshev", "taylor"];

    /// The window of a name; Chebyshev with sidelobes at -80 dB, Taylor with `nbar` 4 and -40 dB.
    ///
    /// # Errors
    /// [`InputError::Unknown`] for any other name.
    pub fn named(name: &str) -> Result<Self, SignalError> {
        Ok(match name {
            "rectangular" => Self::Rectangular,
            "hann" => Self::Hann,
            "hamming" => Self::Hamming,
            "blackman" => Self::Blackman,
            "blackman-harris" => Self::BlackmanHarris,
            "chebyshev" => Self::Chebyshev { sidelobe_db: 80.0 },
            "taylor" => Self::Taylor { nbar: 4, sidelobe_db: 40.0 },
            _ => {
                return Err(SignalError::Argument(InputError::Unknown {
                    what: "window".into(),
                    expected: Self::NAMES.join(", "),
                    given: name.into(),
                }));
            }
        })
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rectangular => "rectangular",
            Self::Hann => "hann",
            Self::Hamming => "hamming",
            Self::Blackman => "blackman",
            Self::BlackmanHarris => "blackman-harris",
            Self::Chebyshev { .. } => "chebyshev",
            Self::Taylor { .. } => "taylor",
        }
    }

    /// Its values; all ones for fewer than 3 samples of a raised cosine, whose ends are zeros.
    ///
    /// # Errors
    /// [`InputError::OutOfRange`] for a length of 0 or above [`MAX_LENGTH`], a sidelobe level or
    /// `nbar` outside its range.
    pub fn coefficients(self, length: usize) -> Result<Vec<f64>, SignalError> {
        check_range("window length", length as f64, 1.0, MAX_LENGTH as f64)?;
        Ok(match self {
            Self::Rectangular => vec![1.0; length],
            Self::Hann => cosine_sum(length, &[0.5, 0.5]),
            Self::Hamming => cosine_sum(length, &[0.54, 0.46]),
            Self::Blackman => cosine_sum(length, &[0.42, 0.5, 0.08]),
            Self::BlackmanHarris => cosine_sum(length, &[0.35875, 0.48829, 0.14128, 0.01168]),
            Self::Chebyshev { sidelobe_db } => {
                check_range("Chebyshev sidelobe_db", sidelobe_db, 20.0, 150.0)?;
                chebyshev(length, sidelobe_db)
            }
            Self::Taylor { nbar, sidelobe_db } => {
                check_range("Taylor nbar", nbar as f64, 1.0, 32.0)?;
                check_range("Taylor sidelobe_db", sidelobe_db, 15.0, 100.0)?;
                taylor(length, nbar, sidelobe_db)
            }
        })
    }
}

/// Mean of a window: what it leaves of a tone in the middle of a bin.
pub fn coherent_gain(coefficients: &[f64]) -> f64 {
    coefficients.iter().sum::<f64>() / coefficients.len().max(1) as f64
}

/// Equivalent noise bandwidth in bins of the unpadded transform: `N sum w^2 / (sum w)^2`, 1 for
/// the rectangular window.
pub fn noise_bandwidth_bins(coefficients: &[f64]) -> f64 {
    let sum: f64 = coefficients.iter().sum();
    let squares: f64 = coefficients.iter().map(|w| w * w).sum();
    coefficients.len() as f64 * squares / (sum * sum)
}

/// Neighbouring bins of noise that count as one independent bin, in a transform to `bins` bins: the
/// sum of the squared correlation of powers over all lags, by Parseval's theorem.
pub(crate) fn power_correlation(coefficients: &[f64], bins: usize) -> f64 {
    let squares: f64 = coefficients.iter().map(|w| w.powi(2)).sum();
    let fourths: f64 = coefficients.iter().map(|w| w.powi(4)).sum();
    bins as f64 * fourths / (squares * squares)
}

/// `a_0 - a_1 cos x + a_2 cos 2x - ...` over one period, both ends included; ones where there is
/// nothing between the ends, which would be zeros.
fn cosine_sum(length: usize, terms: &[f64]) -> Vec<f64> {
    if length < 3 {
        return vec![1.0; length];
    }
    let step = 2.0 * PI / (length - 1) as f64;
    (0..length)
        .map(|n| {
            let n = n.min(length - 1 - n) as f64; // both halves alike to the last bit
            let mut sign = -1.0;
            terms
                .iter()
                .enumerate()
                .map(|(k, a)| {
                    sign = -sign;
                    sign * a * (step * n * k as f64).cos()
                })
                .sum()
        })
        .collect()
}

/// Dolph-Chebyshev (Dolph 1946): the transform of a Chebyshev polynomial of degree `length - 1`.
fn chebyshev(length: usize, sidelobe_db: f64) -> Vec<f64> {
    if length == 1 {
        return vec![1.0];
    }
    let order = (length - 1) as f64;
    let beta = (10.0_f64.powf(sidelobe_db / 20.0).acosh() / order).cosh();
    let polynomial = |x: f64| {
        if x.abs() <= 1.0 {
            (order * x.acos()).cos()
        } else {
            let sign = if x < 0.0 && length.is_multiple_of(2) { -1.0 } else { 1.0 };
            sign * (order * x.abs().acosh()).cosh()
        }
    };
    // Sampled at multiples of 2 pi / length; a half-sample shift centres windows of even length.
    let shift = if length.is_multiple_of(2) { PI / length as f64 } else { 0.0 };
    let mut spectrum: Vec<Complex64> = (0..length)
        .map(|k| {
            let value = polynomial(beta * (PI * k as f64 / length as f64).cos());
            Complex64::from_polar(value, shift * k as f64)
        })
        .collect();
    f64::plan_forward(length).process(&mut spectrum);
    // The middle of the window is now at index 0 (odd length) or between 0 and 1 (even).
    let first = usize::from(length.is_multiple_of(2));
    let half = length / 2;
    let mut window = vec![0.0; length];
    for n in 0..length.div_ceil(2) {
        let value = spectrum[n + first].re;
        window[half + n] = value;
        window[length - 1 - half - n] = value;
    }
    let largest = window.iter().copied().fold(f64::MIN, f64::max);
    window.iter_mut().for_each(|w| *w /= largest);
    window
}

/// Taylor (1955), scaled to 1 in the middle of the data.
fn taylor(length: usize, nbar: usize, sidelobe_db: f64) -> Vec<f64> {
    let a = 10.0_f64.powf(sidelobe_db / 20.0).acosh() / PI;
    let nbar_f = nbar as f64;
    let dilation = nbar_f * nbar_f / (a * a + (nbar_f - 0.5) * (nbar_f - 0.5));
    let coefficients: Vec<f64> = (1..nbar)
        .map(|m| {
            let m_squared = (m * m) as f64;
            let zeros: f64 = (1..nbar)
                .map(|n| {
                    let n = n as f64 - 0.5;
                    1.0 - m_squared / dilation / (a * a + n * n)
                })
                .product();
            let others: f64 =
                (1..nbar).filter(|&n| n != m).map(|n| 1.0 - m_squared / (n * n) as f64).product();
            let sign = if m.is_multiple_of(2) { -1.0 } else { 1.0 };
            sign * zeros / (2.0 * others)
        })
        .collect();
    let value = |offset: f64| {
        let phase = 2.0 * PI * offset / length as f64;
        let terms = coefficients.iter().enumerate();
        1.0 + 2.0 * terms.map(|(k, f)| f * (phase * (k + 1) as f64).cos()).sum::<f64>()
    };
    let middle = value(0.0);
    let centre = (length - 1) as f64 / 2.0;
    (0..length).map(|n| value(n as f64 - centre) / middle).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use boresight_core::Diagnose;

    fn close(given: &[f64], reference: &[f64], name: &str) {
        for (a, b) in given.iter().zip(reference) {
            assert!((a - b).abs() < 1e-12, "{name}: {a} against {b}");
        }
    }

    /// First halves from scipy.signal.windows 1.17 (`sym=True`), for 8 and for 9 samples.
    #[test]
    fn values_are_those_of_scipy() {
        let chebyshev = |sidelobe_db| Window::Chebyshev { sidelobe_db };
        let taylor = |nbar, sidelobe_db| Window::Taylor { nbar, sidelobe_db };
        let cases: [(Window, [f64; 4], [f64; 5]); 9] = [
            (Window::Rectangular, [1.0; 4], [1.0; 5]),
            (
                Window::Hann,
                [0.0, 0.18825509907063326, 0.6112604669781572, 0.9504844339512095],
                [0.0, 0.14644660940672627, 0.5, 0.8535533905932737, 1.0],
            ),
            (
                Window::Hamming,
                [0.08000000000000007, 0.25319469114498266, 0.6423596296199047, 0.9544456792351128],
                [0.08000000000000007, 0.21473088065418822, 0.54, 0.865269119345812, 1.0],
            ),
            (
                Window::Blackman,
                [0.0, 0.09045342435412808, 0.45918295754596367, 0.9203636180999082],
                [0.0, 0.06644660940672624, 0.34, 0.7735533905932738, 1.0],
            ),
            (
                Window::BlackmanHarris,
                [6e-5, 0.0333917234781512, 0.33283350429856506, 0.8893697722232838],
                [6e-5, 0.021735837018679628, 0.21747, 0.6957641629813204, 1.0],
            ),
            (
                chebyshev(60.0),
                [0.0684755541639967, 0.3032191616552019, 0.6868466207739324, 1.0],
                [
                    0.051868563594324145,
                    0.22712393362332253,
                    0.5379172015600897,
                    0.8604844373949189,
                    1.0,
                ],
            ),
            (
                chebyshev(100.0),
                [0.03638368090334488, 0.225355076045345, 0.6241595403271377, 1.0],
                [
                    0.02182740747521154,
                    0.14450562749217408,
                    0.44346858840240555,
                    0.8207710626585829,
                    1.0,
                ],
            ),
            (
                taylor(4, 30.0),
                [0.2793462998238399, 0.5149598981910933, 0.7973015281194145, 0.9756107180961113],
                [
                    0.2718834924087382,
                    0.46690631985001974,
                    0.7246751121792886,
                    0.92465582532122,
                    1.0,
                ],
            ),
            (
                taylor(6, 50.0),
                [0.08586512810954264, 0.3279640863826339, 0.6844633689206735, 0.9595539331140686],
                [
                    0.07831551609573678,
                    0.2763447218023436,
                    0.5830873268822512,
                    0.8773297663124521,
                    1.0,
                ],
            ),
        ];
        for (window, even, odd) in cases {
            close(&window.coefficients(8).unwrap(), &even, window.name());
            close(&window.coefficients(9).unwrap(), &odd, window.name());
        }
    }

    /// Mean, noise bandwidth and sixth value by scipy and NumPy.
    #[test]
    fn gains_and_bandwidths_are_those_of_scipy() {
        let cases = [
            (Window::Hann, 127, 0.49606299212598415, 1.5119047619047625, 0.015461356885461075),
            (Window::Hann, 256, 0.498046875, 1.5058823529411764, 0.0037897451640321322),
            (
                Window::BlackmanHarris,
                256,
                0.35734886718750003,
                2.0122105064216753,
                0.00028262481587376133,
            ),
            (
                Window::Chebyshev { sidelobe_db: 80.0 },
                127,
                0.41166068595376587,
                1.7533400854120678,
                0.00922204095112743,
            ),
            (
                Window::Chebyshev { sidelobe_db: 80.0 },
                256,
                0.41301283281077317,
                1.7477138983865663,
                0.004676294717249328,
            ),
            (
                Window::Taylor { nbar: 4, sidelobe_db: 40.0 },
                256,
                0.5716918443402976,
                1.2901358585007352,
                0.1252709434873493,
            ),
        ];
        for (window, length, gain, bandwidth, sixth) in cases {
            let values = window.coefficients(length).unwrap();
            let given = [coherent_gain(&values), noise_bandwidth_bins(&values), values[5]];
            close(&given, &[gain, bandwidth, sixth], window.name());
        }
    }

    #[test]
    fn chebyshev_sidelobes_are_all_at_their_level() {
        let mut padded: Vec<Complex64> = Window::Chebyshev { sidelobe_db: 70.0 }
            .coefficients(32)
            .unwrap()
            .into_iter()
            .map(Complex64::from)
            .collect();
        padded.resize(4096, Complex64::ZERO);
        f64::plan_forward(4096).process(&mut padded);
        let db: Vec<f64> =
            padded.iter().map(|z| 20.0 * (z.norm() / padded[0].norm()).log10()).collect();
        let peaks: Vec<f64> =
            db[..2048].windows(3).filter(|w| w[1] > w[0] && w[1] > w[2]).map(|w| w[1]).collect();
        assert!(peaks.len() > 10 && peaks.iter().all(|p| (p + 70.0).abs() < 0.05), "{peaks:?}");
    }

    #[test]
    fn names_go_round_and_bad_arguments_are_refused() {
        for name in Window::NAMES {
            let window = Window::named(name).unwrap();
            assert_eq!(window.name(), name);
            for length in [1, 2, 3] {
                assert!(coherent_gain(&window.coefficients(length).unwrap()) > 0.1);
            }
            for length in [0, usize::MAX] {
                let refused = window.coefficients(length).unwrap_err();
                assert_eq!(refused.details().what, "window length");
            }
        }
        assert!(Window::named("kaiser").unwrap_err().to_string().contains("taylor"));
        for (bad, what) in [
            (Window::Chebyshev { sidelobe_db: f64::NAN }, "Chebyshev sidelobe_db"),
            (Window::Chebyshev { sidelobe_db: 0.0 }, "Chebyshev sidelobe_db"),
            (Window::Taylor { nbar: 0, sidelobe_db: 30.0 }, "Taylor nbar"),
            (Window::Taylor { nbar: 4, sidelobe_db: 1e9 }, "Taylor sidelobe_db"),
        ] {
            assert_eq!(bad.coefficients(8).unwrap_err().details().what, what);
        }
    }
}
