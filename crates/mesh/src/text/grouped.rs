use std::fmt;

/// A count for a person: digits in groups of three.
///
/// ```
/// # use meshbrush_mesh::text::Grouped;
/// assert_eq!(Grouped(2_113_944).to_string(), "2,113,944");
/// assert_eq!(Grouped(721).to_string(), "721");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grouped(pub usize);

impl fmt::Display for Grouped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&group_digits(&self.0.to_string()))
    }
}

/// Digits with a comma before every third from the end.
pub fn group_digits(digits: &str) -> String {
    let mut grouped = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.char_indices() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}
