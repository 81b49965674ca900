use std::fmt;

/// A count as people read it: digits in groups of three. It stands in the lowest room because every room's sentences count.
///
/// ```
/// # use meshbrush::geometry::Grouped;
/// assert_eq!(Grouped(2_113_944).to_string(), "2,113,944");
/// assert_eq!(Grouped(721).to_string(), "721");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grouped(pub usize);

impl fmt::Display for Grouped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = self.0.to_string();
        let mut text = String::with_capacity(digits.len() * 4 / 3);
        for (place, digit) in digits.chars().enumerate() {
            if place > 0 && (digits.len() - place).is_multiple_of(3) {
                text.push(',');
            }
            text.push(digit);
        }
        f.pad(&text)
    }
}
