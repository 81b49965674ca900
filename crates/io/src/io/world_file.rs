//! World files (`.pgw`, `.tfw`, `.wld`): six lines with the position of a picture.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use glam::dvec2;

use super::disk::{self, File};
use super::error::{Flaw, PlacedFlaw, ReadError};
use super::samples::no_rectangle;
use meshbrush_mesh::geometry::Rect;

/// Returns the endings of the world file beside a picture, in the order of search: of `.png`, these are
/// `pgw`, `pngw`, `wld` and `PGW`.
fn endings(picture: &Path) -> Vec<String> {
    let own = picture.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let ends = own.chars().next().into_iter().chain(own.chars().last());
    let short: String = ends.chain(['w']).collect();
    vec![short.clone(), format!("{own}w"), "wld".into(), short.to_uppercase()]
}

/// Most bytes of a world file: six numbers take fewer.
const MOST_BYTES: u64 = 4096;

/// Returns the rectangle of a picture of `size` = [columns, rows] from the world file beside it; `None` if
/// there is no such file.
///
/// # Errors
/// Fails when the file cannot be read, has no six numbers, or turns or mirrors the picture.
pub fn bounds_beside(picture: &Path, size: [u32; 2]) -> Result<Option<Rect>, ReadError> {
    let mut files = endings(picture).into_iter().map(|ending| picture.with_extension(ending));
    let Some(file) = files.find(|file: &PathBuf| disk::is_file(file)) else { return Ok(None) };
    let read = || -> Result<Rect, PlacedFlaw> {
        let source = File::open(&file)?;
        if source.length()? > MOST_BYTES {
            return Err(Flaw::Syntax("a world file has six lines, and this one is far longer.".into()).into());
        }
        // Bytes that are no text are in no number.
        let mut text = Vec::new();
        source.take(MOST_BYTES).read_to_end(&mut text)?;
        Ok(bounds(&String::from_utf8_lossy(&text), size).map_err(Flaw::Syntax)?)
    };
    read().map(Some).map_err(|flaw| flaw.in_file(&file))
}

/// Returns the rectangle from the text of a world file: width of a pixel, two rotations, minus its height,
/// and x and y of the centre of the upper left pixel.
fn bounds(text: &str, [columns, rows]: [u32; 2]) -> Result<Rect, String> {
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    let [width, turn_y, turn_x, minus_height, x, y] = numbers[..] else {
        return Err("a world file has six lines with a number each.".into());
    };
    if turn_x != 0.0 || turn_y != 0.0 {
        return Err(
            "it turns the picture, and only pictures with north up can be shown. Warp it first.".into()
        );
    }
    let height = -minus_height;
    if !(width > 0.0 && height > 0.0 && numbers.iter().all(|number| number.is_finite())) {
        return Err("the first line must be positive and the fourth negative: the size of a pixel.".into());
    }
    let corner = dvec2(x - width / 2.0, y + height / 2.0);
    let size = dvec2(width * f64::from(columns), height * f64::from(rows));
    let bounds = Rect::new(dvec2(corner.x, corner.y - size.y), dvec2(corner.x + size.x, corner.y));
    if bounds.is_proper() { Ok(bounds) } else { Err(no_rectangle(width, height).to_string()) }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn the_six_lines_are_those_of_the_upper_left_pixel() {
        let placed = bounds("0.5\n0\n0\n-0.25\n10.25\n39.875\n", [4, 8]).unwrap();
        assert_eq!(placed, Rect::new(dvec2(10.0, 38.0), dvec2(12.0, 40.0)));
    }

    #[test]
    fn the_ending_is_that_of_the_picture() {
        assert_eq!(endings(Path::new("a/b.png")), ["pgw", "pngw", "wld", "PGW"]);
        assert_eq!(endings(Path::new("b.TIFF"))[..2], ["tfw", "tiffw"]);
    }

    #[test]
    fn a_file_that_is_no_text_is_refused_with_a_sentence() {
        let folder = std::env::temp_dir().join(format!("meshbrush-world-file-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("a.pgw"), b"0.5\n0\n0\n-0.2\xc58\n1\n2\n").unwrap();
        let problem = bounds_beside(&folder.join("a.png"), [2, 2]).unwrap_err().to_string();
        fs::remove_dir_all(&folder).unwrap();
        assert!(problem.ends_with("a world file has six lines with a number each."), "{problem}");
    }

    #[test]
    fn turned_mirrored_and_broken_files_are_refused_with_a_sentence() {
        for (text, says) in [
            ("1\n0.1\n0\n-1\n0\n0", "turns"),
            ("1\n0\n0\n1\n0\n0", "negative"),
            ("1\n0\n0", "six lines"),
            ("a b c", "six lines"),
        ] {
            let problem = bounds(text, [2, 2]).unwrap_err();
            assert!(problem.contains(says), "{text}: {problem}");
        }
    }
}
