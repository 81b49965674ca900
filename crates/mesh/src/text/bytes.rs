use std::fmt;

/// A count of bytes for a person: `2 GB`, `12.5 MB`; units are powers of 1000.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bytes(pub usize);

impl Bytes {
    /// Returns the bytes of a size as typed: a number with a unit, in powers of 1000, or of 1024 for units
    /// with an i.
    ///
    /// Returns `None` for any other text. Negative sizes become 0, and sizes beyond `usize` its largest
    /// value.
    ///
    /// ```
    /// # use meshbrush_mesh::text::Bytes;
    /// assert_eq!(Bytes::parse("2.5 GB"), Some(2_500_000_000));
    /// assert_eq!(Bytes::parse("1KiB"), Some(1024));
    /// assert_eq!(Bytes::parse("2"), None);
    /// ```
    pub fn parse(typed: &str) -> Option<usize> {
        let text = typed.trim();
        let (number, unit) = text.split_at(text.find(|c: char| c.is_ascii_alphabetic())?);
        let unit = match unit.to_ascii_lowercase().as_str() {
            "b" => 1.0,
            "kb" => 1e3,
            "mb" => 1e6,
            "gb" => 1e9,
            "tb" => 1e12,
            "kib" => 1024.0,
            "mib" => f64::from(1 << 20),
            "gib" => f64::from(1 << 30),
            "tib" => 1024.0 * f64::from(1 << 30),
            _ => return None,
        };
        let bytes = number.trim().parse::<f64>().ok()? * unit;
        Some(bytes as usize)
    }

    /// Returns a text from which [`Self::parse`] reads the same size: that for a person, unless it is
    /// rounded.
    ///
    /// ```
    /// # use meshbrush_mesh::text::Bytes;
    /// assert_eq!(Bytes(2_500_000_000).exactly(), "2.5 GB");
    /// assert_eq!(Bytes(2_500_000_001).exactly(), "2500000001 B");
    /// ```
    pub fn exactly(self) -> String {
        let text = self.to_string();
        if Self::parse(&text) == Some(self.0) { text } else { format!("{} B", self.0) }
    }
}

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (unit, name) = if self.0 >= 1_000_000_000 { (1e9, "GB") } else { (1e6, "MB") };
        let value = (self.0 as f64 / unit * 1000.0).round() / 1000.0;
        write!(f, "{value} {name}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_written_for_a_person() {
        let written =
            [0, 400, 12_500_000, 999_999_999, 2_000_000_000, 2_147_483_648].map(|n| Bytes(n).to_string());
        assert_eq!(written, ["0 MB", "0 MB", "12.5 MB", "1000 MB", "2 GB", "2.147 GB"]);
    }
}
