//! What crosses the crates of marbles: pictures with known pixels, stated bounds measured,
//! refused scenes with their messages.

mod refused;
