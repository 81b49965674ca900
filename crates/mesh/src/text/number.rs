use std::fmt;

/// An f64 as text: the shortest that reads back as the same number, with an exponent where it would be long.
///
/// ```
/// use meshbrush_mesh::text::Number;
///
/// assert_eq!(Number(20.0).to_string(), "20");
/// assert_eq!(Number(0.1 + 0.2).to_string(), "0.30000000000000004");
/// assert_eq!(Number(1e-300).to_string(), "1e-300");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number(pub f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.0 + 0.0; // no -0
        let plain = number == 0.0 || (1e-5..1e16).contains(&number.abs()) || !number.is_finite();
        if plain { write!(f, "{}", number) } else { write!(f, "{:e}", number) }
    }
}
