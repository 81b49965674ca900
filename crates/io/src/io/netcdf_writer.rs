//! NetCDF in its classic form: a header that describes dimensions, attributes and variables, then the values
//! of one variable after the other, big-endian. There is no record dimension.
//!
//! CDF-1 has 32-bit offsets. A file whose end they cannot reach is CDF-2, with 64-bit offsets. In both, a
//! variable has less than 4 GiB.

use std::io::{self, Write};

use super::{Meter, write_rows};
use meshbrush_mesh::text::Grouped;

/// The value of an attribute.
#[derive(Clone, Debug)]
pub(super) enum AttributeValue {
    /// Text in UTF-8.
    Text(String),
    /// Whole numbers.
    Ints(Vec<i32>),
    /// Real numbers.
    Reals(Vec<f64>),
}

impl From<&str> for AttributeValue {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<i32> for AttributeValue {
    fn from(value: i32) -> Self {
        Self::Ints(vec![value])
    }
}

impl From<f64> for AttributeValue {
    fn from(value: f64) -> Self {
        Self::Reals(vec![value])
    }
}

/// Names and values of attributes.
pub(super) type Attributes = Vec<(&'static str, AttributeValue)>;

/// The type of the values of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VariableType {
    /// Whole numbers of 4 bytes.
    Int,
    /// Real numbers of 8 bytes.
    Double,
}

impl VariableType {
    fn bytes(self) -> u64 {
        match self {
            Self::Int => 4,
            Self::Double => 8,
        }
    }
}

/// The format's numbers for types and lists.
const CHAR: u32 = 2;
const INT: u32 = 4;
const DOUBLE: u32 = 6;
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;

/// Appends a row of values, by its number, to some bytes.
pub(super) type WriteRow<'a> = Box<dyn Fn(&mut Vec<u8>, usize) -> io::Result<()> + Sync + 'a>;

/// A variable, and a function that makes its values.
pub(super) struct WrittenVariable<'a> {
    /// Its name; no other variable has it.
    pub(super) name: String,
    /// The type of its values.
    pub(super) kind: VariableType,
    /// The numbers of its dimensions in [`Dataset::dimensions`]; none for a single value.
    pub(super) dimensions: Vec<usize>,
    /// Its attributes.
    pub(super) attributes: Attributes,
    /// The number of rows that `write_row` makes; together they are all values, big-endian.
    pub(super) rows: usize,
    /// Makes a row.
    pub(super) write_row: WriteRow<'a>,
}

/// A file.
pub(super) struct Dataset<'a> {
    /// Names and lengths of dimensions.
    pub(super) dimensions: Vec<(&'static str, usize)>,
    /// Attributes of the whole file.
    pub(super) attributes: Attributes,
    /// The variables, in the order of the file.
    pub(super) variables: Vec<WrittenVariable<'a>>,
}

/// Most values along a dimension.
const LONGEST_DIMENSION: usize = i32::MAX as usize;
/// Most bytes of a variable: four less than 4 GiB.
const LARGEST_VARIABLE: u64 = u32::MAX as u64 - 3;

impl Dataset<'_> {
    /// Writes the file, and tells the meter its length.
    ///
    /// # Errors
    /// Fails with the errors of `out`, when the work was cancelled, and where a dimension or a variable is
    /// too large for the format.
    pub(super) fn write(&self, out: &mut impl Write, meter: &Meter) -> io::Result<()> {
        self.check_sizes()?;
        let header = self.header();
        meter.expect(
            header.len() as u64 + self.variables.iter().map(|variable| self.bytes(variable)).sum::<u64>(),
        );
        let mut out = meter.count(out);
        out.write_all(&header)?;
        self.variables
            .iter()
            .try_for_each(|variable| write_rows(&mut out, variable.rows, &variable.write_row))
    }

    fn check_sizes(&self) -> io::Result<()> {
        let help = "choose a larger diameter, or another format, as .vtu";
        if let Some((name, length)) = self.dimensions.iter().find(|(_, length)| *length > LONGEST_DIMENSION) {
            let (length, most) = (Grouped(*length), Grouped(LONGEST_DIMENSION));
            let problem =
                format!("the dimension {name} has {length} values, and NetCDF holds {most} at most");
            return Err(io::Error::other(format!("{problem}; {help}")));
        }
        if let Some(variable) = self.variables.iter().find(|variable| self.bytes(variable) > LARGEST_VARIABLE)
        {
            let (name, bytes) = (&variable.name, Grouped(self.bytes(variable) as usize));
            let problem = format!("the variable {name} has {bytes} bytes, and NetCDF holds less than 4 GiB");
            return Err(io::Error::other(format!("{problem}; {help}")));
        }
        Ok(())
    }

    /// Returns the bytes of the values of a variable, a multiple of four.
    fn bytes(&self, variable: &WrittenVariable) -> u64 {
        let counts = variable.dimensions.iter().map(|&dimension| self.dimensions[dimension].1 as u64);
        variable.kind.bytes() * counts.product::<u64>()
    }

    /// Returns the header, with offsets as long as the file needs.
    fn header(&self) -> Vec<u8> {
        let length = self.header_with(false, 0).len() as u64;
        let all: u64 = self.variables.iter().map(|variable| self.bytes(variable)).sum();
        let is_long = length + all > i32::MAX as u64;
        let length = self.header_with(is_long, 0).len() as u64;
        self.header_with(is_long, length)
    }

    /// Returns the header for values that begin at an offset.
    fn header_with(&self, is_long: bool, start: u64) -> Vec<u8> {
        let mut header = vec![b'C', b'D', b'F', if is_long { 2 } else { 1 }];
        put(&mut header, 0); // records
        put_list(&mut header, DIMENSIONS, self.dimensions.len());
        for (name, length) in &self.dimensions {
            put_name(&mut header, name);
            put(&mut header, *length as u32);
        }
        put_attributes(&mut header, &self.attributes);
        put_list(&mut header, VARIABLES, self.variables.len());
        let mut offset = start;
        for variable in &self.variables {
            put_name(&mut header, &variable.name);
            put(&mut header, variable.dimensions.len() as u32);
            variable.dimensions.iter().for_each(|&dimension| put(&mut header, dimension as u32));
            put_attributes(&mut header, &variable.attributes);
            put(&mut header, if variable.kind == VariableType::Int { INT } else { DOUBLE });
            put(&mut header, self.bytes(variable) as u32);
            match is_long {
                true => header.extend(offset.to_be_bytes()),
                false => put(&mut header, offset as u32),
            }
            offset += self.bytes(variable);
        }
        header
    }
}

fn put(header: &mut Vec<u8>, value: u32) {
    header.extend(value.to_be_bytes());
}

/// Begins a list; an empty one has no number of its kind.
fn put_list(header: &mut Vec<u8>, kind: u32, count: usize) {
    put(header, if count == 0 { 0 } else { kind });
    put(header, count as u32);
}

/// Text with its length, padded to a multiple of four bytes.
fn put_name(header: &mut Vec<u8>, name: &str) {
    put(header, name.len() as u32);
    header.extend(name.as_bytes());
    header.resize(header.len().next_multiple_of(4), 0);
}

fn put_attributes(header: &mut Vec<u8>, attributes: &Attributes) {
    put_list(header, ATTRIBUTES, attributes.len());
    for (name, value) in attributes {
        put_name(header, name);
        match value {
            AttributeValue::Text(text) => {
                put(header, CHAR);
                put_name(header, text);
            }
            AttributeValue::Ints(values) => {
                put(header, INT);
                put(header, values.len() as u32);
                values.iter().for_each(|value| header.extend(value.to_be_bytes()));
            }
            AttributeValue::Reals(values) => {
                put(header, DOUBLE);
                put(header, values.len() as u32);
                values.iter().for_each(|value| header.extend(value.to_be_bytes()));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a file of two variables along one dimension. None of its values is made here.
    fn dataset(length: usize) -> Dataset<'static> {
        let variable = |name: &str, kind| WrittenVariable {
            name: name.into(),
            kind,
            dimensions: vec![0],
            attributes: vec![("units", "m".into()), ("range", AttributeValue::Reals(vec![0.0, 1.0]))],
            rows: length,
            write_row: Box::new(|_, _| unreachable!()),
        };
        let variables = vec![variable("a", VariableType::Double), variable("b", VariableType::Int)];
        Dataset { dimensions: vec![("n", length)], attributes: vec![("three", 3.into())], variables }
    }

    #[test]
    fn a_file_beyond_2_gib_has_64_bit_offsets() {
        let short = dataset(1000).header();
        assert_eq!(&short[..4], b"CDF\x01");
        let begins_at = (short.len() as u32 + 8000).to_be_bytes();
        assert_eq!(
            (&short[short.len() - 8..short.len() - 4], &short[short.len() - 4..]),
            (&4000_u32.to_be_bytes()[..], &begins_at[..])
        );
        let last = (i32::MAX as usize - short.len()) / 12;
        assert_eq!(dataset(last).header()[3], 1);
        let long = dataset(last + 1).header();
        assert_eq!((long[3], long.len()), (2, short.len() + 8));
        let offset = u64::from_be_bytes(long[long.len() - 8..].try_into().unwrap());
        assert_eq!(offset, long.len() as u64 + 8 * (last as u64 + 1));
    }

    #[test]
    fn what_the_format_cannot_hold_is_refused_before_anything_is_written() {
        for (length, problem) in [
            (536_870_912, "the variable a has 4,294,967,296 bytes, and NetCDF holds less than 4 GiB"),
            (1 << 31, "the dimension n has 2,147,483,648 values, and NetCDF holds 2,147,483,647 at most"),
        ] {
            let mut out = Vec::new();
            let error = dataset(length).write(&mut out, &Meter::default()).unwrap_err().to_string();
            assert!(error.starts_with(problem) && out.is_empty(), "{error}");
        }
        assert!(dataset(536_870_911).check_sizes().is_ok());
    }
}
