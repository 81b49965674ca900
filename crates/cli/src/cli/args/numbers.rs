//! Numbers of options, with sentences for those that cannot be used.

/// Reads a number that is finite.
pub fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "write a number, as in 3 or 0.5".to_owned())
}

/// Reads a number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    let number = finite(text).ok().filter(|number| *number > 0.0);
    number.ok_or_else(|| "write a number above 0, as in 0.5".to_owned())
}

/// Reads a number between 0 and 1.
pub fn share(text: &str) -> Result<f64, String> {
    let number = finite(text).ok().filter(|number| *number > 0.0 && *number < 1.0);
    number.ok_or_else(|| "write a number between 0 and 1, as in 0.2".to_owned())
}
