//! Structs whose fields are keys of one table: a table is read part by part, each into the struct that knows
//! its keys.
//!
//! ```text
//! name = "Coast"  kind = "distance"  locked = true  to = "outline"  at_zero = 1  slope = 0.2
//! └────────── Heading ───────────┘  └ SharedKeys ┘  └─ TargetKeys ┘ └───── GrowthKeys ──────┘
//! ```
//!
//! serde's own `flatten` would lose the path to a value that cannot be used.

use std::fmt;

use serde::de::{DeserializeOwned, Deserializer, Error, Visitor};
use serde::forward_to_deserialize_any;

use crate::io::lengths::TextContext;
use crate::io::values::TextReader;
use crate::io::{KeyFault, TextValue};

/// The entries of a table that nothing has taken yet.
pub struct TableEntries<'c> {
    left: Vec<(String, TextValue)>,
    context: &'c TextContext,
}

impl<'c> TableEntries<'c> {
    /// Returns the entries of a table, or `None` for another value.
    pub fn of(table: TextValue, context: &'c TextContext) -> Option<Self> {
        if let TextValue::Table(left) = table { Some(Self { left, context }) } else { None }
    }

    /// Returns what lengths mean in the table.
    pub(super) fn context(&self) -> &'c TextContext {
        self.context
    }

    /// Returns the keys of the entries that are left.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.left.iter().map(|(key, _)| &**key)
    }
}

/// A part of the keys of a table.
pub trait KeyGroup: Sized {
    /// Returns the keys, in the order in which they are written.
    fn names() -> Vec<&'static str>;

    /// Takes the entries with its keys out of a table.
    ///
    /// # Errors
    /// Fails for a value of another type, and for a key that is needed and missing.
    fn take(entries: &mut TableEntries<'_>) -> Result<Self, KeyFault>;
}

/// The fields of a struct that serde derives are its keys.
impl<T: DeserializeOwned> KeyGroup for T {
    fn names() -> Vec<&'static str> {
        field_names::<T>().to_vec()
    }

    fn take(entries: &mut TableEntries<'_>) -> Result<Self, KeyFault> {
        let names = field_names::<T>();
        let own = entries.left.extract_if(.., |(key, _)| names.contains(&&**key)).collect();
        T::deserialize(TextReader::new(&TextValue::Table(own), entries.context))
    }
}

/// Makes a struct of key groups a key group.
macro_rules! group_of_groups {
    ($group:ident { $($part:ident: $part_type:ty),+ $(,)? }) => {
        impl $crate::io::layers::KeyGroup for $group {
            fn names() -> Vec<&'static str> {
                [$(<$part_type as $crate::io::layers::KeyGroup>::names()),+].concat()
            }

            fn take(entries: &mut $crate::io::layers::TableEntries<'_>) -> Result<Self, $crate::io::KeyFault> {
                Ok(Self { $($part: $crate::io::layers::KeyGroup::take(entries)?),+ })
            }
        }
    };
}
pub(super) use group_of_groups;

/// Returns the names that serde has for the fields of a struct; none for another type.
fn field_names<T: DeserializeOwned>() -> &'static [&'static str] {
    let mut names: &[&str] = &[];
    let _ = T::deserialize(FieldNames(&mut names));
    names
}

/// Notes the fields that are asked for, and has none of them.
struct FieldNames<'n>(&'n mut &'static [&'static str]);

impl<'de> Deserializer<'de> for FieldNames<'_> {
    type Error = NoValue;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, NoValue> {
        Err(NoValue)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, NoValue> {
        *self.0 = fields;
        Err(NoValue)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[derive(Debug, thiserror::Error)]
#[error("there is no value")]
struct NoValue;

impl Error for NoValue {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self
    }
}
