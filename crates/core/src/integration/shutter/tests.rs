//! The average over time.
