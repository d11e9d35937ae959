//! Names and flags.

use crate::text::{Read, Slice, read_simple};

/// Declares a value that RON knows: its type and what is expected.
macro_rules! words {
    ($($(#[$meta:meta])* $name:ident($type:ty): $expected:literal;)*) => {$(
        $(#[$meta])*
        #[derive(Clone, Debug)]
        pub(crate) struct $name(pub(crate) $type);

        impl<'t> Read<'t> for $name {
            fn read(slice: Slice<'t>) -> Option<Self> {
                read_simple(slice, $expected).map(Self)
            }
        }
    )*};
}

words! {
    /// Yes or no.
    #[derive(Copy)]
    Flag(bool): "`true` or `false`";
    /// The name of a material.
    MaterialName(String): "the name of a material in quotation marks";
    /// The name of a light.
    LightName(String): "the name of a light in quotation marks";
    /// The unit of lengths.
    UnitName(String): "the name of a unit in quotation marks";
    /// The name of a file, relative to the scene file.
    FileName(String): "the name of a file in quotation marks";
}
