//! The limits of a project. Writing checks them before a file is replaced, and reading before a part is
//! unpacked, with the same functions: what is written can be read.

use meshbrush_core::document::MOST_RASTER_PIXELS;
use meshbrush_mesh::text::Grouped;

/// Most bytes and parts of a project.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The whole file.
    pub file: u64,
    /// Number of parts.
    pub parts: usize,
    /// The text of the settings.
    pub settings: u64,
    /// The background picture as PNG.
    pub background: u64,
    /// Points and threats, all parts together.
    pub lists: u64,
    /// Pixels of rasters, all parts together.
    pub rasters: u64,
    /// Unpacked paint that a file of any size may have, all layers together.
    pub paint: u64,
    /// Beyond that, the unpacked bytes of paint for a packed one. Strokes pack to a half or a tenth.
    pub paint_ratio: u64,
}

impl Limits {
    /// The limits of projects and of the records of a journal.
    pub const PROJECT: Self = Self {
        // The archive has numbers of 32 bits, and the largest of them has a meaning of its own.
        file: u32::MAX as u64 - 1,
        parts: u16::MAX as usize - 1,
        settings: 64 << 20,
        background: 128 << 20,
        lists: 512 << 20, // 33 million points
        rasters: 4 * MOST_RASTER_PIXELS,
        paint: 1_000_000_000, // 250 million pixels
        paint_ratio: 40,
    };
}

/// What a part holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PartContent {
    Settings,
    Background,
    Lists,
    Raster,
    Paint,
    /// A part that other programs added, which is not read.
    Unknown,
}

impl PartContent {
    fn of_part(name: &str) -> Self {
        match name.split('.').next().unwrap_or_default() {
            "settings" => Self::Settings,
            "background" => Self::Background,
            "domain" | "shapes" | "polygons" | "points" | "threats" => Self::Lists,
            "raster" => Self::Raster,
            "paint" => Self::Paint,
            _ => Self::Unknown,
        }
    }
}

/// A project, or a part of it, is beyond a limit: a sentence without its first words and its full stop.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("its {what} take {given}, and the limit is {limit}; {advice}")]
pub struct TooLarge {
    what: &'static str,
    given: String,
    limit: String,
    advice: &'static str,
}

/// The sizes of the parts of an archive so far.
#[derive(Debug)]
pub struct Sizes {
    limits: Limits,
    parts: usize,
    lists: u64,
    rasters: u64,
    paint: u64,
    packed_paint: u64,
}

impl Sizes {
    /// Returns the sizes of an archive without parts.
    pub fn new(limits: Limits) -> Self {
        Self { limits, parts: 0, lists: 0, rasters: 0, paint: 0, packed_paint: 0 }
    }

    /// Adds a part with its numbers of bytes, unpacked and packed.
    ///
    /// # Errors
    /// Fails when the part, or all parts of its kind together, are beyond a limit.
    pub fn add(&mut self, name: &str, bytes: u64, packed: u64) -> Result<(), TooLarge> {
        let limits = self.limits;
        self.parts += 1;
        if self.parts > limits.parts {
            let [given, limit] = [self.parts, limits.parts].map(|n| format!("{} parts", Grouped(n)));
            return Err(TooLarge { what: "layers and regions", given, limit, advice: "remove some" });
        }
        let advice = "shorten formulas and names, or remove layers";
        match PartContent::of_part(name) {
            PartContent::Settings => check("settings", bytes, limits.settings, advice),
            PartContent::Background => {
                check("pixels of the background picture", bytes, limits.background, "use a smaller picture")
            }
            PartContent::Lists => {
                let advice = "simplify shapes, masks and regions, or remove layers";
                check("points and threats", add(&mut self.lists, bytes), limits.lists, advice)
            }
            PartContent::Raster => {
                let advice = "scale rasters down, or remove layers";
                check("rasters", add(&mut self.rasters, bytes), limits.rasters, advice)
            }
            PartContent::Paint => {
                add(&mut self.paint, bytes);
                add(&mut self.packed_paint, packed);
                Ok(())
            }
            PartContent::Unknown => Ok(()),
        }
    }

    /// Checks the paint, whose limit depends on the size of all its parts, and the bytes of the file.
    ///
    /// # Errors
    /// Fails when one of them is beyond its limit.
    pub fn finish(&self, file: u64) -> Result<(), TooLarge> {
        let limit = self.limits.paint.max(self.packed_paint.saturating_mul(self.limits.paint_ratio));
        check("painted pixels", self.paint, limit, "erase paint where the domain does not need it")?;
        check("parts", file, self.limits.file, "scale rasters down, or remove layers")
    }
}

fn add(sum: &mut u64, bytes: u64) -> u64 {
    *sum = sum.saturating_add(bytes);
    *sum
}

fn check(what: &'static str, bytes: u64, limit: u64, advice: &'static str) -> Result<(), TooLarge> {
    if bytes <= limit {
        return Ok(());
    }
    let [given, limit] = [bytes, limit].map(|bytes| format!("{} bytes", Grouped(bytes as usize)));
    Err(TooLarge { what, given, limit, advice })
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::super::archive::{Archive, ArchiveWriter};
    use super::*;
    use crate::io::Meter;

    const SMALL: Limits = Limits {
        file: 2000,
        parts: 5,
        settings: 100,
        background: 100,
        lists: 100,
        rasters: 100,
        paint: 100,
        paint_ratio: 3,
    };

    /// Writes parts of so many bytes: zeros, which pack to a few bytes.
    fn written(parts: &[(&str, usize)], limits: Limits) -> io::Result<Vec<u8>> {
        let mut archive = ArchiveWriter::new(Vec::new(), limits);
        for (name, bytes) in parts {
            archive.add(name, &Meter::default(), |out| out.write_all(&vec![0; *bytes]))?;
        }
        archive.finish()
    }

    #[test]
    fn what_is_beyond_a_limit_is_neither_written_nor_read() {
        let with_numbers: Vec<String> = (0..6).map(|number| format!("raster.{number}")).collect();
        let many: Vec<(&str, usize)> = with_numbers.iter().map(|name| (&name[..], 1)).collect();
        let cases: [(&[(&str, usize)], &str); 8] = [
            (&[("settings.json", 101)], "its settings take 101"),
            (&[("background.png", 101)], "background picture"),
            (&[("domain.0", 40), ("shapes.0", 30), ("threats.0", 31)], "points and threats"),
            (&[("polygons.1", 60), ("points.0", 41)], "points and threats"),
            (&[("raster.0", 60), ("raster.1", 41)], "rasters"),
            (&[("paint.1", 60), ("paint.2", 41)], "painted pixels"),
            (&many, "6 parts"),
            (&[("settings.json", 10), ("another", 3_000_000)], "its parts take"),
        ];
        for (parts, words) in cases {
            let error = written(parts, SMALL).unwrap_err().to_string();
            assert!(error.contains(words) && error.contains("the limit is"), "{words}: {error}");
            let bytes = written(parts, Limits::PROJECT).unwrap();
            let refused = Archive::open(&bytes, SMALL).unwrap_err().to_string();
            assert_eq!(refused.trim_end_matches('.'), error, "the reader has another sentence");
            let (&(last, bytes), others) = parts.split_last().unwrap();
            let fewer = match bytes {
                1 => others.to_vec(),
                3_000_000 => [others, &[(last, 1000)]].concat(),
                _ => [others, &[(last, bytes - 1)]].concat(),
            };
            let bytes = written(&fewer, SMALL).unwrap();
            assert!(Archive::open(&bytes, SMALL).is_ok(), "{words}: the limit itself is possible");
        }
    }

    #[test]
    fn paint_that_packs_badly_may_be_larger() {
        let mut random = fastrand::Rng::with_seed(1);
        let noise: Vec<u8> = (0..400).map(|_| random.u8(..)).collect();
        let mut archive = ArchiveWriter::new(Vec::new(), SMALL);
        archive.add("paint.1", &Meter::default(), |out| out.write_all(&noise)).unwrap();
        assert!(Archive::open(&archive.finish().unwrap(), SMALL).is_ok());
    }
}
