//! The values of a text in TOML or JSON, and how they become the structs of the program.
//!
//! The deserializers of `toml` and `serde_json` have errors of their own, which are texts. This one gives a
//! [`KeyFault`]: the key, and a sentence for a person.

use std::fmt;

use serde::de::value::{BorrowedStrDeserializer, F64Deserializer};
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::de::{DeTable, DeValue};

use super::lengths::{Measure, TextContext};
use super::{KeyFault, KeyStep};

/// A value of a text. Tables are in the order of the text.
#[derive(Clone, Debug)]
pub enum TextValue {
    /// No value.
    Nothing,
    /// `true` or `false`.
    Bool(bool),
    /// A number without a fraction.
    Whole(i128),
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// A date, which no key has.
    Date,
    /// Values in their order.
    List(Vec<Self>),
    /// Values with their keys.
    Table(Vec<(String, Self)>),
}

impl TextValue {
    /// Returns the tables of a text in TOML.
    pub(super) fn from_toml(table: &DeTable) -> Self {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let entry = |(key, value): &(&toml::Spanned<_>, &toml::Spanned<DeValue>)| {
            let key: &std::borrow::Cow<str> = key.get_ref();
            (key.to_string(), Self::from_toml_value(value.get_ref()))
        };
        Self::Table(entries.iter().map(entry).collect())
    }

    fn from_toml_value(value: &DeValue) -> Self {
        match value {
            DeValue::String(text) => Self::Text(text.to_string()),
            DeValue::Integer(whole) => {
                let number = i128::from_str_radix(whole.as_str(), whole.radix());
                number.map_or(Self::Number(f64::INFINITY), Self::Whole)
            }
            // The parser has checked that it is a number.
            DeValue::Float(number) => Self::Number(number.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(value) => Self::Bool(*value),
            DeValue::Datetime(_) => Self::Date,
            DeValue::Array(list) => {
                Self::List(list.iter().map(|entry| Self::from_toml_value(entry.get_ref())).collect())
            }
            DeValue::Table(table) => Self::from_toml(table),
        }
    }

    fn unexpected(&self) -> Unexpected<'_> {
        match self {
            Self::Nothing => Unexpected::Other("nothing"),
            Self::Bool(value) => Unexpected::Bool(*value),
            Self::Whole(number) => match i64::try_from(*number) {
                Ok(number) => Unexpected::Signed(number),
                Err(_) => Unexpected::Float(*number as f64),
            },
            Self::Number(number) => Unexpected::Float(*number),
            Self::Text(text) => Unexpected::Str(text),
            Self::Date => Unexpected::Other("a date"),
            Self::List(_) => Unexpected::Seq,
            Self::Table(_) => Unexpected::Map,
        }
    }

    fn refused<T>(&self, expected: impl fmt::Display) -> Result<T, KeyFault> {
        Err(KeyFault::not_a(expected, self.unexpected()))
    }

    /// Returns a whole number that fits the type `T`.
    fn whole<T: TryFrom<i128>>(&self) -> Result<T, KeyFault> {
        let fitting = if let Self::Whole(number) = *self { T::try_from(number).ok() } else { None };
        fitting.map_or_else(|| self.refused("a whole number from 0"), Ok)
    }
}

/// Reads a value, with what its lengths mean.
#[derive(Clone, Copy)]
pub struct TextReader<'c, 'de> {
    value: &'de TextValue,
    context: Option<&'c TextContext>,
}

impl<'c, 'de> TextReader<'c, 'de> {
    /// Returns a reader of a value whose lengths are numbers.
    pub fn plain(value: &'de TextValue) -> Self {
        Self { value, context: None }
    }

    /// Returns a reader of a value whose lengths may have units.
    pub fn new(value: &'de TextValue, context: &'c TextContext) -> Self {
        Self { value, context: Some(context) }
    }

    /// Reads a value in a list or a table.
    fn within<T>(self, step: KeyStep, read: impl FnOnce(Self) -> Result<T, KeyFault>) -> Result<T, KeyFault> {
        let found = match self.context {
            Some(context) => context.within(step.clone(), || read(self)),
            None => read(self),
        };
        found.map_err(|fault| fault.within(step))
    }
}

impl<'de> Deserializer<'de> for TextReader<'_, 'de> {
    type Error = KeyFault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        match self.value {
            TextValue::Nothing => visitor.visit_unit(),
            TextValue::Bool(value) => visitor.visit_bool(*value),
            TextValue::Whole(number) => match i64::try_from(*number) {
                Ok(number) => visitor.visit_i64(number),
                Err(_) => visitor.visit_f64(*number as f64),
            },
            TextValue::Number(number) => visitor.visit_f64(*number),
            TextValue::Text(text) => visitor.visit_borrowed_str(text),
            TextValue::Date => self.value.refused("a number, a text, a list or a table"),
            TextValue::List(list) => visitor.visit_seq(ListReader { list, next: 0, context: self.context }),
            TextValue::Table(table) => visitor.visit_map(KeyReader { table, next: 0, context: self.context }),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        if let TextValue::Bool(value) = self.value {
            visitor.visit_bool(*value)
        } else {
            self.value.refused("true or false")
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        match self.value {
            TextValue::Whole(number) => visitor.visit_f64(*number as f64),
            TextValue::Number(number) => visitor.visit_f64(*number),
            _ => self.value.refused("a number"),
        }
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        visitor.visit_u32(self.value.whole()?)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        visitor.visit_u64(self.value.whole()?)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        if let TextValue::Text(text) = self.value {
            visitor.visit_borrowed_str(text)
        } else {
            self.value.refused("a text in quotation marks")
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        match self.value {
            TextValue::Nothing => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    /// A text may stand in the place of a length: the name of the type says so.
    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        let read = self.context.and_then(|context| Some((context, Measure::of_type(name)?)));
        match (self.value, read) {
            (TextValue::Text(text), Some((context, measure))) => {
                let number: F64Deserializer<KeyFault> = context.number(measure, text)?.into_deserializer();
                visitor.visit_newtype_struct(number)
            }
            _ => visitor.visit_newtype_struct(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        if let TextValue::List(_) = self.value {
            self.deserialize_any(visitor)
        } else {
            self.value.refused("a list")
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, KeyFault> {
        match self.value {
            TextValue::List(list) if list.len() == length => self.deserialize_any(visitor),
            TextValue::List(list) => {
                Err(KeyFault::invalid_length(list.len(), &&*format!("a list of {length} numbers")))
            }
            _ => self.value.refused(format!("a list of {length} numbers")),
        }
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        self.deserialize_tuple(length, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        match self.value {
            TextValue::Text(word) => {
                visitor.visit_enum(Variant { word, content: None, context: self.context })
            }
            TextValue::Table(table) => match &table[..] {
                [(word, content)] => {
                    visitor.visit_enum(Variant { word, content: Some(content), context: self.context })
                }
                _ => self.value.refused("a table with one key"),
            },
            _ => Err(KeyFault::only_a_word()),
        }
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u128 f32 char bytes byte_buf unit unit_struct map struct
        identifier ignored_any
    }
}

/// The entries of a list, from one of them on.
struct ListReader<'c, 'de> {
    list: &'de [TextValue],
    next: usize,
    context: Option<&'c TextContext>,
}

impl<'de> SeqAccess<'de> for ListReader<'_, 'de> {
    type Error = KeyFault;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, KeyFault> {
        let Some(entry) = self.list.get(self.next) else { return Ok(None) };
        let index = self.next;
        self.next += 1;
        TextReader { value: entry, context: self.context }
            .within(index.into(), |entry| seed.deserialize(entry))
            .map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.list.len() - self.next)
    }
}

/// The entries of a table, from one of them on.
struct KeyReader<'c, 'de> {
    table: &'de [(String, TextValue)],
    next: usize,
    context: Option<&'c TextContext>,
}

impl<'de> MapAccess<'de> for KeyReader<'_, 'de> {
    type Error = KeyFault;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, KeyFault> {
        let Some((key, _)) = self.table.get(self.next) else { return Ok(None) };
        let found: Result<_, KeyFault> = seed.deserialize(BorrowedStrDeserializer::new(key));
        found.map(Some).map_err(|fault| fault.of_key(key))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, KeyFault> {
        let (key, value) = &self.table[self.next];
        self.next += 1;
        TextReader { value, context: self.context }
            .within(key.clone().into(), |value| seed.deserialize(value))
    }
}

/// A word, or a table with one key, whose value belongs to that word.
struct Variant<'c, 'de> {
    word: &'de str,
    content: Option<&'de TextValue>,
    context: Option<&'c TextContext>,
}

impl<'de> EnumAccess<'de> for Variant<'_, 'de> {
    type Error = KeyFault;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), KeyFault> {
        let found: Result<_, KeyFault> = seed.deserialize(BorrowedStrDeserializer::new(self.word));
        match found {
            Ok(variant) => Ok((variant, self)),
            Err(fault) if self.content.is_some() => Err(fault.of_key(self.word)),
            Err(fault) => Err(fault),
        }
    }
}

impl<'de> Variant<'_, 'de> {
    /// Reads what belongs to the word.
    fn read<T>(&self, read: impl FnOnce(TextReader<'_, 'de>) -> Result<T, KeyFault>) -> Result<T, KeyFault> {
        let word = self.word;
        let missing = || KeyFault::not_a(format!("a table with the key `{word}`"), Unexpected::Str(word));
        let value = self.content.ok_or_else(missing)?;
        TextReader { value, context: self.context }.within(word.to_owned().into(), read)
    }
}

impl<'de> VariantAccess<'de> for Variant<'_, 'de> {
    type Error = KeyFault;

    fn unit_variant(self) -> Result<(), KeyFault> {
        if self.content.is_some() { Err(KeyFault::only_a_word()) } else { Ok(()) }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, KeyFault> {
        self.read(|content| seed.deserialize(content))
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, KeyFault> {
        self.read(|content| content.deserialize_tuple(length, visitor))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        self.read(|content| content.deserialize_any(visitor))
    }
}

impl<'de> Deserialize<'de> for TextValue {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(AnyValue)
    }
}

/// Takes whatever there is.
struct AnyValue;

impl<'de> Visitor<'de> for AnyValue {
    type Value = TextValue;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("any value")
    }

    fn visit_unit<E: Error>(self) -> Result<TextValue, E> {
        Ok(TextValue::Nothing)
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<TextValue, E> {
        Ok(TextValue::Bool(value))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<TextValue, E> {
        Ok(TextValue::Whole(number.into()))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<TextValue, E> {
        Ok(TextValue::Whole(number.into()))
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<TextValue, E> {
        Ok(TextValue::Number(number))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<TextValue, E> {
        Ok(TextValue::Text(text.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut entries: A) -> Result<TextValue, A::Error> {
        let mut list = Vec::new();
        while let Some(entry) = entries.next_element()? {
            list.push(entry);
        }
        Ok(TextValue::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<TextValue, A::Error> {
        let mut table = Vec::new();
        while let Some(entry) = entries.next_entry()? {
            table.push(entry);
        }
        Ok(TextValue::Table(table))
    }
}
