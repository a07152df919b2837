//! The truth in f64, scalar and plain.
