//! Tables as text: a header that names the columns, and rows of fields.
//!
//! Fields are separated by commas, semicolons or tabs, and follow RFC 4180: one that begins with a quotation
//! mark may contain separators, but it must end on its line. Without commas between fields, a comma may be
//! the decimal point. White space around fields and blank lines are ignored.

use std::io::{BufRead, Read};

use csv_core::{ReadRecordResult, ReaderBuilder, Terminator};

use super::Flaw;
use super::error::PlacedFlaw;
use meshbrush_mesh::text::excerpt;

/// Longest line that is read, in bytes. Without a limit a file without line breaks would fill the memory.
const LONGEST_LINE: u64 = 1 << 20;

/// Characters that may separate fields. The first one counts with which the header has the required columns.
const DELIMITERS: [u8; 3] = *b",;\t";

fn parser(delimiter: u8) -> csv_core::Reader {
    // Of a line break in two bytes the first is white space at the end of the last field.
    ReaderBuilder::new().delimiter(delimiter).terminator(Terminator::Any(b'\n')).build()
}

/// Returns the first name of each column, as in `x, y and range`.
fn in_words(names: &[&[&str]]) -> String {
    let columns: Vec<&str> = names.iter().map(|names| names[0]).collect();
    let (last, others) = columns.split_last().unwrap_or((&"", &[]));
    format!("{} and {last}", others.join(", "))
}

/// The rows of a table, one at a time.
pub(super) struct Rows<R> {
    source: R,
    delimiter: u8,
    parser: csv_core::Reader,
    /// The number of the current line, counted from one.
    pub(super) line: usize,
    /// The fields of the current row, one after the other, and where each ends.
    text: String,
    ends: Vec<usize>,
    /// Whether the first row was read in place of a header and is still to come.
    is_first_ahead: bool,
}

/// The columns of a table.
pub(super) struct Columns<const COUNT: usize> {
    /// The column of each name.
    pub(super) places: [Option<usize>; COUNT],
    /// Whether a header names them; otherwise they are in the order of the names.
    pub(super) are_named: bool,
}

/// Names of columns with longitudes; other names are those of x in the coordinates of the document.
const LONGITUDES: [&str; 4] = ["lon", "lng", "long", "longitude"];

impl<R: BufRead> Rows<R> {
    pub(super) fn new(source: R) -> Self {
        let delimiter = DELIMITERS[0];
        Self {
            source,
            delimiter,
            parser: parser(delimiter),
            line: 0,
            text: String::new(),
            ends: Vec::new(),
            is_first_ahead: false,
        }
    }

    /// Reads the header, finds out what separates the fields, and returns the column of each name.
    ///
    /// # Errors
    /// Fails when one of the first `required` columns has no name in the header, or a column is there twice.
    pub(super) fn read_header<const COUNT: usize>(
        &mut self,
        names: [&[&str]; COUNT],
        required: usize,
    ) -> Result<[Option<usize>; COUNT], PlacedFlaw> {
        let Some(line) = self.next_line()? else {
            let columns = in_words(&names[..required]);
            let problem = format!("there is no header; the first line must name the columns {columns}.");
            return Err(Flaw::Syntax(problem).into());
        };
        self.header_of(line, names, required)
    }

    fn header_of<const COUNT: usize>(
        &mut self,
        line: Vec<u8>,
        names: [&[&str]; COUNT],
        required: usize,
    ) -> Result<[Option<usize>; COUNT], PlacedFlaw> {
        for delimiter in DELIMITERS {
            (self.delimiter, self.parser) = (delimiter, parser(delimiter));
            self.parse_line(line.clone())?;
            let places = names.map(|names| {
                self.fields().position(|field| names.iter().any(|name| field.eq_ignore_ascii_case(name)))
            });
            if places[..required].iter().all(Option::is_some) {
                names.iter().try_for_each(|names| self.check_once(names))?;
                return Ok(places);
            }
        }
        let header = String::from_utf8_lossy(&line);
        let (found, columns) = (excerpt(40, header.trim()), in_words(&names[..required]));
        let problem = format!("the header is `{found}`, and it must name the columns {columns}.");
        Err(Flaw::Syntax(problem).at(self.line))
    }

    /// Refuses a header in which several columns have one of these names, since it is unknown which of them
    /// counts.
    fn check_once(&self, names: &[&str]) -> Result<(), PlacedFlaw> {
        let is_meant = |field: &&str| names.iter().any(|name| field.eq_ignore_ascii_case(name));
        let columns: Vec<String> =
            self.fields().filter(is_meant).take(3).map(|field| format!("`{}`", excerpt(20, field))).collect();
        if columns.len() < 2 {
            return Ok(());
        }
        let (found, name) = (columns.join(" and "), names[0]);
        let problem =
            format!("the header has {found}, each of which could be {name}. Rename or remove all but one.");
        Err(Flaw::Syntax(problem).at(self.line))
    }

    /// Returns the columns as [`Self::read_header`] does. A first line of numbers is a row of a table without
    /// a header.
    ///
    /// # Errors
    /// Fails as [`Self::read_header`] does.
    pub(super) fn read_columns<const COUNT: usize>(
        &mut self,
        names: [&[&str]; COUNT],
        required: usize,
    ) -> Result<Columns<COUNT>, PlacedFlaw> {
        let Some(line) = self.next_line()? else {
            return self.read_header(names, required).map(|places| Columns { places, are_named: true });
        };
        for delimiter in DELIMITERS {
            (self.delimiter, self.parser) = (delimiter, parser(delimiter));
            let is_split = self.parse_line(line.clone()).is_ok();
            if is_split && (0..required).all(|column| self.number(column, "").is_ok()) {
                self.is_first_ahead = true;
                let places = std::array::from_fn(|column| Some(column).filter(|_| column < self.ends.len()));
                return Ok(Columns { places, are_named: false });
            }
        }
        self.header_of(line, names, required).map(|places| Columns { places, are_named: true })
    }

    /// Returns whether the header calls a column a longitude. It is the current row.
    pub(super) fn is_longitude(&self, column: usize) -> bool {
        let name = self.field(column).unwrap_or_default();
        LONGITUDES.iter().any(|longitude| name.eq_ignore_ascii_case(longitude))
    }

    /// Goes to the next line that is not blank. Returns whether there is one.
    pub(super) fn advance(&mut self) -> Result<bool, PlacedFlaw> {
        if std::mem::take(&mut self.is_first_ahead) {
            return Ok(true);
        }
        match self.next_line()? {
            Some(line) => self.parse_line(line).map(|()| true),
            None => Ok(false),
        }
    }

    /// Returns the next line that is not blank, with its line break.
    fn next_line(&mut self) -> Result<Option<Vec<u8>>, PlacedFlaw> {
        loop {
            let mut bytes = Vec::new();
            let read = self.source.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut bytes)?;
            if read == 0 {
                return Ok(None);
            }
            self.line += 1;
            if read as u64 == LONGEST_LINE {
                return Err(Flaw::Syntax("the line is longer than a megabyte.".into()).at(self.line));
            }
            if !bytes.trim_ascii().is_empty() {
                return Ok(Some(bytes));
            }
        }
    }

    /// Splits a line into fields.
    fn parse_line(&mut self, mut line: Vec<u8>) -> Result<(), PlacedFlaw> {
        let flaw = |problem: &str| Flaw::Syntax(problem.into()).at(self.line);
        // The parser waits for the end of the line; the last one of a file may have none.
        line.push(b'\n');
        // Fields are shorter than their line, and a line has fewer fields than bytes.
        let mut text = vec![0; line.len()];
        self.ends.resize(line.len(), 0);
        self.parser.reset();
        // It also removes a byte order mark, which spreadsheets put before the first line.
        let (result, _, bytes, fields) = self.parser.read_record(&line, &mut text, &mut self.ends);
        if result != ReadRecordResult::Record {
            return Err(flaw("a quotation mark is not closed on its line."));
        }
        text.truncate(bytes);
        self.ends.truncate(fields);
        self.text = String::from_utf8(text).map_err(|_| flaw("the line is not UTF-8 text."))?;
        Ok(())
    }

    /// Returns the fields of the current row, without the white space around them.
    fn fields(&self) -> impl Iterator<Item = &str> {
        (0..self.ends.len()).filter_map(|column| self.field(column))
    }

    /// Returns a field of the current row, `None` if the row is shorter.
    pub(super) fn field(&self, column: usize) -> Option<&str> {
        let start = if column == 0 { 0 } else { *self.ends.get(column - 1)? };
        self.text.get(start..*self.ends.get(column)?).map(str::trim)
    }

    /// Returns the number in a column of the current row.
    pub(super) fn number(&self, column: usize, name: &str) -> Result<f64, PlacedFlaw> {
        let flaw = |problem| Flaw::Syntax(problem).at(self.line);
        let text = self.field(column).filter(|text| !text.is_empty());
        let text = text.ok_or_else(|| flaw(format!("there is no {name}.")))?;
        let with_point = |text: &str| (self.delimiter != b',').then(|| text.replace(',', "."));
        let parsed = text.parse().ok().or_else(|| with_point(text)?.parse().ok());
        parsed.ok_or_else(|| flaw(format!("{name} is `{}`, which is not a number.", excerpt(40, text))))
    }
}
