//! What the headers of both kinds of NetCDF files say, and the samples of a block.

use super::super::Flaw;
use super::super::samples::SampleType;

/// A dimension. Dimensions of a file with the same name are the same.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dimension {
    pub(super) name: String,
    pub(super) length: u64,
}

/// The value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ReadAttribute {
    Text(String),
    /// Numbers of a type.
    Numbers(StoredType, Vec<f64>),
}

/// A variable.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ReadVariable {
    pub(super) name: String,
    /// The type of its values; `None` for text and other types that are no numbers.
    pub(super) sample: Option<StoredType>,
    /// The slowest dimension first.
    pub(super) dimensions: Vec<Dimension>,
    pub(super) attributes: Vec<(String, ReadAttribute)>,
}

impl ReadVariable {
    /// Returns an attribute that is text, without spaces around it.
    pub(super) fn text(&self, name: &str) -> Option<&str> {
        match self.attribute(name)? {
            ReadAttribute::Text(text) => Some(text.trim_matches(|c: char| c.is_whitespace() || c == '\0')),
            ReadAttribute::Numbers(..) => None,
        }
    }

    /// Returns the numbers of an attribute; none where it is absent, or text.
    pub(super) fn numbers(&self, name: &str) -> &[f64] {
        match self.attribute(name) {
            Some(ReadAttribute::Numbers(_, numbers)) => numbers,
            Some(ReadAttribute::Text(_)) | None => &[],
        }
    }

    /// Returns the type of the numbers of an attribute.
    pub(super) fn type_of_numbers(&self, name: &str) -> Option<StoredType> {
        match self.attribute(name)? {
            ReadAttribute::Numbers(sample, _) => Some(*sample),
            ReadAttribute::Text(_) => None,
        }
    }

    fn attribute(&self, name: &str) -> Option<&ReadAttribute> {
        self.attributes.iter().find(|(at, _)| at == name).map(|(_, value)| value)
    }
}

/// The type of the values of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StoredType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl StoredType {
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Returns whether it has whole numbers.
    pub(super) fn is_whole(self) -> bool {
        self.sample_type() == SampleType::Integer
    }

    /// Returns what the number for "no value" is rounded to.
    pub(super) fn sample_type(self) -> SampleType {
        match self {
            Self::F32 => SampleType::Single,
            Self::F64 => SampleType::Double,
            _ => SampleType::Integer,
        }
    }

    /// Returns what NetCDF puts where nothing was written. Bytes may have any value.
    pub(super) fn default_fill(self) -> Option<f64> {
        match self {
            Self::I8 | Self::U8 => None,
            Self::I16 => Some(-32_767.0),
            Self::U16 => Some(65_535.0),
            Self::I32 => Some(-2_147_483_647.0),
            Self::U32 => Some(4_294_967_295.0),
            Self::I64 => Some(-9_223_372_036_854_775_806.0),
            Self::U64 => Some(18_446_744_073_709_551_614.0),
            Self::F32 | Self::F64 => Some(9.969_209_968_386_869e36),
        }
    }
}

/// A file whose header was read.
pub(super) trait Source {
    fn variables(&self) -> &[ReadVariable];

    /// Returns the samples of a variable from the index `corner` on, `extent` of them along each dimension,
    /// the last dimension fastest. They lie within the variable.
    ///
    /// # Errors
    /// Fails when the file cannot be read there, or ends before.
    fn block(&mut self, variable: usize, corner: &[u64], extent: &[u64]) -> Result<Vec<f64>, Flaw>;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of netcdf.h: NC_FILL_SHORT and so on.
    #[test]
    fn nothing_written_is_beside_the_end_of_the_numbers() {
        for (sample, fill) in [
            (StoredType::I16, f64::from(i16::MIN + 1)),
            (StoredType::U16, f64::from(u16::MAX)),
            (StoredType::I32, f64::from(i32::MIN + 1)),
            (StoredType::U32, f64::from(u32::MAX)),
            (StoredType::I64, (i64::MIN + 2) as f64),
            (StoredType::U64, (u64::MAX - 1) as f64),
            (StoredType::F32, f64::from_bits(0x479e_0000_0000_0000)),
            (StoredType::F64, f64::from_bits(0x479e_0000_0000_0000)),
        ] {
            assert_eq!(sample.default_fill(), Some(fill));
        }
        assert_eq!([StoredType::I8, StoredType::U8].map(StoredType::default_fill), [None, None]);
    }
}
