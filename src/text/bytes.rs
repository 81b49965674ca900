use std::fmt;

/// A count of bytes for a person: `2 GB`, `12.5 MB`; units are powers of 1000.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bytes(pub usize);

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
