//! Tables from the classes of a grid to values, as from land cover to Manning's n.
//!
//! The columns are `class` (or `code`) and `value`, or the name of the quantity in place of `value`. Other
//! columns are ignored. Without a header the first two columns count.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::disk::File;
use super::error::PlacedFlaw;
use super::table::{Columns, Rows};
use super::{Flaw, Number, ReadError};

/// Most rows of a table: one for each class that a pixel of two bytes can have.
const MOST_ROWS: usize = 65_536;

/// The value of each class.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClassTable(BTreeMap<u64, f64>);

impl ClassTable {
    /// Returns the value of a class, if the table has it.
    pub fn value(&self, class: f32) -> Option<f64> {
        self.0.get(&key(f64::from(class))).copied()
    }
}

/// Returns the bits of a class: both zeros are one.
fn key(class: f64) -> u64 {
    (class + 0.0).to_bits()
}

/// Reads the table for a quantity with this name.
///
/// # Errors
/// Fails when the file cannot be read, its header lacks a column, a field is no finite number, or a class is
/// there twice, with the line.
pub fn read(path: &Path, quantity: &str) -> Result<ClassTable, ReadError> {
    let read = File::open(path).map_err(PlacedFlaw::from);
    read.and_then(|file| parse(BufReader::new(file), quantity)).map_err(|flaw| flaw.in_file(path))
}

fn parse(source: impl BufRead, quantity: &str) -> Result<ClassTable, PlacedFlaw> {
    let mut rows = Rows::new(source);
    let Columns { places, .. } = rows.read_columns([&["class", "code"], &["value", quantity]], 2)?;
    let [Some(class), Some(value)] = places else { unreachable!("these columns are required") };
    let mut table = BTreeMap::new();
    while rows.advance()? {
        let (class, value) = (rows.number(class, "class")?, rows.number(value, "value")?);
        let flaw = |problem: String| Flaw::Syntax(problem).at(rows.line);
        if !(class.is_finite() && value.is_finite()) {
            let (class, value) = (Number(class), Number(value));
            return Err(flaw(format!(
                "the class is {class} and its value {value}, and both must be finite."
            )));
        }
        // Pixels have classes as f32 has them.
        let class = f64::from(class as f32);
        if table.insert(key(class), value).is_some() {
            return Err(flaw(format!("the class {} is there twice; remove one of its rows.", Number(class))));
        }
        if table.len() > MOST_ROWS {
            return Err(flaw(format!("there are more than {MOST_ROWS} classes, and that is the limit.")));
        }
    }
    match table.is_empty() {
        true => Err(Flaw::Syntax("there is no class in it; write a row for each class.".into()).into()),
        false => Ok(ClassTable(table)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<ClassTable, String> {
        let read = parse(text.as_bytes(), "manning").map_err(|flaw| flaw.in_file(Path::new("n.csv")));
        read.map_err(|error| error.to_string())
    }

    #[test]
    fn a_table_has_a_value_for_each_class() {
        for text in [
            "class,value\n11,0.02\n41,0.1\n0,0.03\n",
            "name;manning;code\nwater;0,02;11\nforest;0,1;41\nnone;0,03;0\n",
            "11,0.02\n41,0.1\n-0,0.03\n",
        ] {
            let table = table(text).unwrap();
            let values = [11.0, 41.0, 0.0, -0.0, 12.0].map(|class| table.value(class));
            assert_eq!(values, [Some(0.02), Some(0.1), Some(0.03), Some(0.03), None], "{text}");
        }
    }

    #[test]
    fn a_table_of_no_use_is_refused_with_the_line() {
        for (text, sentence) in [
            ("", "n.csv: there is no header"),
            ("class,value\n", "n.csv: there is no class in it"),
            ("class,cost\n1,2\n", "must name the columns class and value"),
            ("class,value\n1,0.02\n1,0.03\n", "n.csv, line 3: the class 1 is there twice"),
            ("class,value\n1,inf\n", "n.csv, line 2: the class is 1 and its value inf"),
            ("class,value\n1,wet\n", "value is `wet`, which is not a number"),
            ("class,value,manning\n1,2,3\n", "each of which could be value"),
        ] {
            let error = table(text).unwrap_err();
            assert!(error.contains(sentence), "{text}: {error}");
        }
    }
}
