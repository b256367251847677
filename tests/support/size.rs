//! Sample sizes of statistical tests.

/// `full` where `BORESIGHT_FULL` is set (`npm run test:all`), else `quick`.
pub fn sized<T>(full: T, quick: T) -> T {
    if std::env::var_os("BORESIGHT_FULL").is_some() { full } else { quick }
}
