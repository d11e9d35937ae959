//! The text of a value, unread.

use ron::value::RawValue;
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, forward_to_deserialize_any};

/// The text of the next value, with the comments around it.
///
/// `RawValue` hands out the same text, but only after a second look at its syntax, which takes as
/// long as the first; here it looks at a stand-in.
pub(crate) fn raw_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<&'de str, D::Error> {
    let mut text = None;
    <&'de RawValue>::deserialize(Tap {
        inner: deserializer,
        text: &mut text,
    })?;
    text.ok_or_else(|| D::Error::custom("expected a value"))
}

/// A deserializer or a visitor that keeps the text which passes through it.
struct Tap<'a, 'de, I> {
    inner: I,
    text: &'a mut Option<&'de str>,
}

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Tap<'_, 'de, D> {
    type Error = D::Error;

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, D::Error> {
        self.inner.deserialize_newtype_struct(
            name,
            Tap {
                inner: visitor,
                text: self.text,
            },
        )
    }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.inner.deserialize_any(visitor)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
        unit unit_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

impl<'de, V: Visitor<'de>> Visitor<'de> for Tap<'_, 'de, V> {
    type Value = V::Value;

    fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.inner.expecting(formatter)
    }

    fn visit_borrowed_str<E: Error>(self, text: &'de str) -> Result<V::Value, E> {
        const STAND_IN: &str = "()";
        *self.text = Some(text);
        self.inner.visit_borrowed_str(STAND_IN)
    }
}
