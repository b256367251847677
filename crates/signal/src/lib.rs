//! Boresight.
