//! The values of a text in TOML or JSON, and how they become the structs of the program.
//!
//! The deserializers of `toml` and `serde_json` have errors of their own, which are texts. This one gives a
//! [`KeyFault`]: the key, and a sentence for a person.

use std::fmt;

use serde::de::value::BorrowedStrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, MapAccess, SeqAccess, Unexpected,
    VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::de::{DeTable, DeValue};

use super::KeyFault;

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

    pub(super) fn refused<T>(&self, expected: impl fmt::Display) -> Result<T, KeyFault> {
        Err(KeyFault::not_a(expected, self.unexpected()))
    }

    /// Returns a whole number that fits the type `T`.
    fn whole<T: TryFrom<i128>>(&self) -> Result<T, KeyFault> {
        let fitting = if let Self::Whole(number) = *self { T::try_from(number).ok() } else { None };
        fitting.map_or_else(|| self.refused("a whole number from 0"), Ok)
    }
}

impl<'de> Deserializer<'de> for &'de TextValue {
    type Error = KeyFault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        match self {
            TextValue::Nothing => visitor.visit_unit(),
            TextValue::Bool(value) => visitor.visit_bool(*value),
            TextValue::Whole(number) => match i64::try_from(*number) {
                Ok(number) => visitor.visit_i64(number),
                Err(_) => visitor.visit_f64(*number as f64),
            },
            TextValue::Number(number) => visitor.visit_f64(*number),
            TextValue::Text(text) => visitor.visit_borrowed_str(text),
            TextValue::Date => self.refused("a number, a text, a list or a table"),
            TextValue::List(list) => visitor.visit_seq(Entries { list, next: 0 }),
            TextValue::Table(table) => visitor.visit_map(Keys { table, next: 0 }),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        if let TextValue::Bool(value) = self {
            visitor.visit_bool(*value)
        } else {
            self.refused("true or false")
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        match self {
            TextValue::Whole(number) => visitor.visit_f64(*number as f64),
            TextValue::Number(number) => visitor.visit_f64(*number),
            _ => self.refused("a number"),
        }
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        visitor.visit_u32(self.whole()?)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        visitor.visit_u64(self.whole()?)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        if let TextValue::Text(text) = self {
            visitor.visit_borrowed_str(text)
        } else {
            self.refused("a text in quotation marks")
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        match self {
            TextValue::Nothing => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, KeyFault> {
        if let TextValue::List(_) = self { self.deserialize_any(visitor) } else { self.refused("a list") }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, KeyFault> {
        match self {
            TextValue::List(list) if list.len() == length => self.deserialize_any(visitor),
            TextValue::List(list) => {
                Err(KeyFault::invalid_length(list.len(), &&*format!("a list of {length} numbers")))
            }
            _ => self.refused(format!("a list of {length} numbers")),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        match self {
            TextValue::Text(word) => visitor.visit_enum(Variant { word, content: None }),
            TextValue::Table(table) => match &table[..] {
                [(word, content)] => visitor.visit_enum(Variant { word, content: Some(content) }),
                _ => self.refused("a table with one key"),
            },
            _ => Err(KeyFault::only_a_word()),
        }
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u128 f32 char bytes byte_buf unit unit_struct tuple_struct map struct
        identifier ignored_any
    }
}

/// The entries of a list, from one of them on.
struct Entries<'de> {
    list: &'de [TextValue],
    next: usize,
}

impl<'de> SeqAccess<'de> for Entries<'de> {
    type Error = KeyFault;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, KeyFault> {
        let Some(entry) = self.list.get(self.next) else { return Ok(None) };
        let index = self.next;
        self.next += 1;
        seed.deserialize(entry).map(Some).map_err(|fault| fault.within(index))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.list.len() - self.next)
    }
}

/// The entries of a table, from one of them on.
struct Keys<'de> {
    table: &'de [(String, TextValue)],
    next: usize,
}

impl<'de> MapAccess<'de> for Keys<'de> {
    type Error = KeyFault;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, KeyFault> {
        let Some((key, _)) = self.table.get(self.next) else { return Ok(None) };
        let found: Result<_, KeyFault> = seed.deserialize(BorrowedStrDeserializer::new(key));
        found.map(Some).map_err(|fault| fault.of_key(key))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, KeyFault> {
        let (key, value) = &self.table[self.next];
        self.next += 1;
        seed.deserialize(value).map_err(|fault| fault.within(key.clone()))
    }
}

/// A word, or a table with one key, whose value belongs to that word.
struct Variant<'de> {
    word: &'de str,
    content: Option<&'de TextValue>,
}

impl<'de> EnumAccess<'de> for Variant<'de> {
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

impl<'de> Variant<'de> {
    fn content(&self) -> Result<&'de TextValue, KeyFault> {
        let word = self.word;
        self.content
            .ok_or_else(|| KeyFault::not_a(format!("a table with the key `{word}`"), Unexpected::Str(word)))
    }
}

impl<'de> VariantAccess<'de> for Variant<'de> {
    type Error = KeyFault;

    fn unit_variant(self) -> Result<(), KeyFault> {
        if self.content.is_some() { Err(KeyFault::only_a_word()) } else { Ok(()) }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, KeyFault> {
        seed.deserialize(self.content()?).map_err(|fault| fault.within(self.word.to_owned()))
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, KeyFault> {
        let list = self.content()?.deserialize_tuple(length, visitor);
        list.map_err(|fault| fault.within(self.word.to_owned()))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, KeyFault> {
        self.content()?.deserialize_any(visitor).map_err(|fault| fault.within(self.word.to_owned()))
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
