//! Packs parts that the fuzzer changed into projects with valid checksums, so that reading does not stop at
//! the checksum.

use std::io::Read;
use std::path::Path;
use std::sync::{Arc, LazyLock};

use flate2::read::DeflateDecoder;
use glam::dvec2;
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::domain::Domain;
use meshbrush_core::layers::{Layer, LayerKind, RasterLayer, RasterReading, RasterSource};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_io::io::project::{self, Project};
use meshbrush_mesh::geometry::Rect;

/// Name and content of each part.
pub type Parts = Vec<(String, Vec<u8>)>;

/// The parts of a small project that has all of them, and several tiles.
pub static SAMPLE: LazyLock<Parts> = LazyLock::new(|| unpacked(&bytes_of(&sample())));

/// Numbers at the limits of formats and checks.
const NUMBERS: [&str; 16] = [
    "0",
    "-0.0",
    "1",
    "2",
    "-1",
    "66",
    "2048",
    "2049",
    "8192",
    "4294967295",
    "5e-324",
    "1e-9",
    "1e9",
    "1e308",
    "1e999",
    "null",
];

/// A small project.
pub fn sample() -> Project {
    let triangle = vec![vec![dvec2(0.0, 0.0), dvec2(1.0, 0.1), dvec2(0.3, 1.0)]];
    let raster = Raster::from_values(Rect::UNIT, [2, 2], vec![0.0, 0.25, 0.5, 1.0]);
    let source = RasterSource { name: "a.png".into(), raster: Arc::new(RasterPyramid::new(raster)) };
    let settings = Settings {
        domain: Domain::of_polygons(&[triangle]).unwrap(),
        layers: Layer::default_stack(LayerKind::Raster(RasterLayer { source, reading: RasterReading::Risk })),
        ..Settings::default()
    };
    let mut document = Document::new(settings, None).unwrap();
    for medium in [Medium::Risk(1.0), Medium::Diameter(0.05, DiameterChange::Finer)] {
        document.begin_stroke(Brush { medium, radius: 0.1, hardness: 0.5, strength: 1.0 });
        document.draw_to(dvec2(0.5, 0.98));
        document.draw_to(dvec2(0.98, 0.98));
        document.end_stroke();
    }
    Project::of(&document)
}

pub fn bytes_of(project: &Project) -> Vec<u8> {
    let mut bytes = Vec::new();
    project::write(&mut bytes, project).unwrap();
    bytes
}

/// Asserts that a project that was read, and its document, save and open without a change.
pub fn hold(project: Project) {
    assert!(project.settings.clone().checked().is_ok_and(|settings| settings == project.settings));
    saved_again(&project);
    let document = project.into_document().expect("settings that were read are met");
    let project = Project::of(&document);
    saved_again(&project);
    let back = project.into_document().unwrap();
    assert!(back.settings() == document.settings() && back.paint() == document.paint());
}

fn saved_again(project: &Project) {
    let bytes = bytes_of(project);
    let again = project::from_bytes(&bytes, Path::new("again.meshbrush")).unwrap();
    assert!(again == *project);
    assert!(bytes_of(&again) == bytes);
}

/// Changes parts; four bytes of input say where, how, and to what.
pub fn change(parts: &mut Parts, edits: &[u8]) {
    for &[which, a, b, value] in edits.as_chunks().0 {
        let count = parts.len();
        let (_, content) = &mut parts[usize::from(which & 15) % count];
        let place = usize::from(u16::from_le_bytes([a, b])) % (content.len() + 1);
        match which >> 4 {
            0..8 => replace_number(content, usize::from(a), NUMBERS[usize::from(value) % NUMBERS.len()]),
            8 => content.insert(place, value),
            9 => drop(content.splice(place..(place + usize::from(value)).min(content.len()), [])),
            10 => content.truncate(place),
            _ => content.iter_mut().skip(place).take(1).for_each(|byte| *byte = value),
        }
    }
}

/// Replaces the n-th number of a text.
fn replace_number(text: &mut Vec<u8>, n: usize, number: &str) {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || b".-e".contains(byte);
    let begins = |&i: &usize| text[i].is_ascii_digit() && (i == 0 || !is_digit(&text[i - 1]));
    let starts: Vec<usize> = (0..text.len().min(4096)).filter(begins).collect();
    if let Some(&start) = starts.get(n % starts.len().max(1)) {
        let length = text[start..].iter().take_while(|byte| is_digit(byte)).count();
        text.splice(start..start + length, number.bytes());
    }
}

/// The parts of an archive that the program wrote, read by the local headers alone.
pub fn unpacked(mut bytes: &[u8]) -> Parts {
    let mut parts = Vec::new();
    while bytes.starts_with(b"PK\x03\x04") {
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let (packed, name) = (word(18), word(26) & 0xffff);
        let mut content = Vec::new();
        DeflateDecoder::new(&bytes[30 + name..][..packed]).read_to_end(&mut content).unwrap();
        parts.push((String::from_utf8(bytes[30..30 + name].to_vec()).unwrap(), content));
        bytes = &bytes[30 + name + packed..];
    }
    parts
}

/// An archive of stored parts.
pub fn packed(parts: &Parts) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in parts {
        let start = (out.len() as u32).to_le_bytes();
        let size = (content.len() as u32).to_le_bytes();
        let crc = crc32fast::hash(content).to_le_bytes();
        let name_length = [name.len() as u8, 0, 0, 0];
        let common = [&[20, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &crc, &size, &size, &name_length].concat();
        out.extend([b"PK\x03\x04", &common[..], name.as_bytes(), content].concat());
        directory.extend([b"PK\x01\x02\x14\0", &common[..], &[0; 10], &start, name.as_bytes()].concat());
    }
    let count = (parts.len() as u16).to_le_bytes();
    let (size, start) = ((directory.len() as u32).to_le_bytes(), (out.len() as u32).to_le_bytes());
    out.extend([&directory[..], b"PK\x05\x06\0\0\0\0", &count, &count, &size, &start, &[0, 0]].concat());
    out
}
