//! The text of a scene file: its tokens, values that know their place, and what is wrong there.

mod edit;
mod explain;
mod fault;
mod json;
mod located;
mod placed;
mod raw;
mod show;
mod slice;
mod suggest;
pub(crate) mod token;

pub(crate) use edit::{append_after, path_at, set, value_at};
pub(crate) use fault::{Fault, Names, collect, note_failure, refuse};
pub(crate) use json::{is_json, to_ron};
pub(crate) use located::{LocatedFault, Place};
pub(crate) use placed::{
    Placed, Read, optional, present, read_file, read_simple, read_structure, read_tuple,
};
pub use show::harmless;
pub(crate) use show::{is_harmful, quoted, reason, show};
pub(crate) use slice::Slice;
pub(crate) use suggest::{closest, did_you_mean, either, list};
