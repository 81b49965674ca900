//! Damaged, empty, huge and malicious files: reading each gives a result or an error sentence, without a
//! panic and without taking all memory.

use std::fmt::Write;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use glam::dvec2;
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::domain::{Domain, RegionError};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{Layer, LayerKind, Quantity};
use meshbrush_core::paint::{Brush, DiameterChange, Medium};
use meshbrush_io::io::png::{Behind, decode};
use meshbrush_io::io::{
    GridPlace, Meter, asc, geojson, geotiff, netcdf, npy, points, recipe, recording, shapes, shp, threats,
};
use meshbrush_mesh::geometry::Rect;
use tiff::tags::Tag;

const NAME: &str = "the file";

/// Reads a file and returns the error sentence, if there is one.
type Reader = fn(&[u8]) -> Result<(), String>;

fn read_geojson(bytes: &[u8]) -> Result<(), String> {
    let polygons = geojson::read_from(bytes, Path::new(NAME)).map_err(|error| error.to_string())?;
    Domain::of_polygons(&polygons).map(drop).map_err(|error| format!("{NAME}: {error}"))
}

fn read_asc(bytes: &[u8]) -> Result<(), String> {
    asc::from_bytes(bytes, Path::new(NAME)).map(drop).map_err(|error| error.to_string())
}

fn read_points(bytes: &[u8]) -> Result<(), String> {
    points::read_from(bytes, Path::new(NAME)).map(drop).map_err(|error| error.to_string())
}

fn read_shapes(bytes: &[u8]) -> Result<(), String> {
    shapes::read_from(bytes, Path::new(NAME)).map(drop).map_err(|error| error.to_string())
}

fn read_threats(bytes: &[u8]) -> Result<(), String> {
    threats::read_from(bytes, Path::new(NAME)).map(drop).map_err(|error| error.to_string())
}

fn read_recipe(bytes: &[u8]) -> Result<(), String> {
    let Ok(text) = String::from_utf8(bytes.to_vec()) else { return Ok(()) };
    let found = |name: &str| Ok(PathBuf::from(name));
    let read = recipe::parse(Path::new(NAME), text, &found);
    // The sentence is the first line; below it, a pointer into the text.
    read.map(drop).map_err(|error| error.to_string().lines().next().unwrap_or_default().to_owned())
}

fn read_png(bytes: &[u8]) -> Result<(), String> {
    decode(Cursor::new(bytes), Rect::UNIT, Behind::Black).map(drop).map_err(|flaw| format!("{NAME}: {flaw}"))
}

fn read_geotiff(bytes: &[u8]) -> Result<(), String> {
    geotiff::decode(Cursor::new(bytes)).map(drop).map_err(|flaw| format!("{NAME}: {flaw}"))
}

fn read_netcdf(bytes: &[u8]) -> Result<(), String> {
    let read = netcdf::decode(Cursor::new(bytes.to_vec()), None, &GridPlace::default(), &Meter::default());
    read.map(drop).map_err(|flaw| format!("{NAME}: {flaw}"))
}

fn read_npy(bytes: &[u8]) -> Result<(), String> {
    npy::decode(bytes, Rect::UNIT).map(drop).map_err(|flaw| format!("{NAME}: {flaw}"))
}

fn read_shp(bytes: &[u8]) -> Result<(), String> {
    shp::read_from(bytes, Path::new(NAME)).map(drop).map_err(|error| error.to_string())
}

fn read_formula(bytes: &[u8]) -> Result<(), String> {
    let Ok(text) = std::str::from_utf8(bytes) else { return Ok(()) };
    let formula = Formula::parse(text).map_err(|mistake| format!("{NAME}: {mistake}"))?;
    let _ = formula.eval(0.5, -0.5);
    Ok(())
}

/// Reads a recording and repeats its edits.
fn read_recording(bytes: &[u8]) -> Result<(), String> {
    let file = recording::from_bytes(bytes, Path::new(NAME)).map_err(|error| error.to_string())?;
    file.replay(&Meter::default()).map(drop).map_err(|error| error.to_string())
}

/// Returns a recording of a stroke and its undo on a few coarse triangles.
fn recording_sample() -> Vec<u8> {
    let layers = Layer::stack([LayerKind::paint(Quantity::Diameter)]);
    let settings = Settings { spacing: 0.9, max_triangles: 500, layers, ..Settings::default() };
    let mut document = Document::new(settings, None).unwrap();
    document.record();
    let medium = Medium::Diameter(0.3, DiameterChange::Finer);
    document.begin_stroke(Brush { medium, radius: 0.2, hardness: 0.5, strength: 1.0 });
    document.draw_to(dvec2(0.5, 0.25));
    document.end_stroke();
    document.undo();
    let mut bytes = Vec::new();
    recording::write(&mut bytes, document.recording().unwrap(), &Meter::default()).unwrap();
    bytes
}

const GEOJSON: &str = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"a":[1,{"b":null}]},
"geometry":{"type":"MultiPolygon","coordinates":[[[[0,0],[4,0,9],[4e0,4],[0,0]],[[1,1],[2,1],[2,1.5]]]]}}]}"#;

const SHAPES: &str = r#"{"type":"GeometryCollection","geometries":[{"type":"MultiPoint","coordinates":[[1,2],[3,4]]},
{"type":"LineString","coordinates":[[0,0],[1e1,-1]]},{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,0]]]}]}"#;

const THREATS: &str = "Lon;lat;peak;range;law;note\n1,5;2;0.5;3;gaussian;\"a;b\"\n-1;0;1;2e1;;\n";

const RECIPE: &str = r#"
[domain]
bounds = [0, 0, 2, 1]
inside = "x < 1"
unit = "km"
[mesh]
spacing = 0.5 # coarse
rule = "area"
[limits]
h_min = 1e-2
gradation = 0.3
[[layer]]
kind = "formula"
quantity = "diameter"
formula = "0.1 + x^2"
[[layer]]
kind = "threats"
threats = [{ x = 1, y = 0.5, range = 0.2, law = "disc" }]
[[layer]]
kind = "distance"
to = "outline"
at_zero = 0.02
slope = 0.1
mask = [[[[0, 0], [1, 0], [1, 1]]]]
[[layer]]
kind = "band"
file = "depth.asc"
between = [-20, 0]
diameter = 0.03
combine = "floor"
[[output]]
file = "a.vtu"
"#;

/// Returns a GeoTIFF of 3 × 2 pixels, of which one has no value.
fn geotiff_sample() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    let mut image = encoder.new_image::<tiff::encoder::colortype::Gray32Float>(3, 2).unwrap();
    let tags = image.encoder();
    tags.write_tag(Tag::ModelPixelScaleTag, &[2.0, 2.0, 0.0][..]).unwrap();
    tags.write_tag(Tag::ModelTiepointTag, &[0.0, 0.0, 0.0, 10.0, 20.0, 0.0][..]).unwrap();
    tags.write_tag(Tag::GeoKeyDirectoryTag, &[1u16, 1, 0, 1, 1025, 0, 1, 2][..]).unwrap();
    tags.write_tag(Tag::GdalNodata, "-9").unwrap();
    image.write_data(&[1.0, 2.5, 3.0, 4.0, -9.0, 6.0]).unwrap();
    bytes.into_inner()
}

/// Returns an array of 2 × 3 numbers.
fn npy_sample() -> Vec<u8> {
    let header = "{'descr': '<i2', 'fortran_order': True, 'shape': (2, 3), }";
    [b"\x93NUMPY\x01\0".as_slice(), &[header.len() as u8, 0], header.as_bytes(), &[0xff; 12]].concat()
}

/// Returns a classic NetCDF file with a grid of 3 × 2 numbers, of which one is no value.
fn netcdf_sample() -> Vec<u8> {
    let (mut header, mut begin) = (b"CDF\x01\0\0\0\0".to_vec(), 200u32);
    let words = |header: &mut Vec<u8>, list: &[u32]| header.extend(list.iter().flat_map(|n| n.to_be_bytes()));
    words(&mut header, &[10, 2, 1]);
    header.extend(b"y\0\0\0");
    words(&mut header, &[2, 1]);
    header.extend(b"x\0\0\0");
    words(&mut header, &[3, 0, 0, 11, 3]);
    for (name, dimensions, kind, bytes) in
        [("y", &[0u32][..], 6u32, 16), ("x", &[1], 6, 24), ("z", &[0, 1], 3, 12)]
    {
        words(&mut header, &[1]);
        header.extend([name.as_bytes(), &[0; 3]].concat());
        words(&mut header, &[dimensions.len() as u32]);
        words(&mut header, dimensions);
        match name {
            "z" => {
                words(&mut header, &[12, 1, 13]);
                header.extend(b"missing_value\0\0\0");
                words(&mut header, &[3, 1, 5 << 16]);
            }
            _ => words(&mut header, &[0, 0]),
        }
        words(&mut header, &[kind, bytes, begin]);
        begin += bytes;
    }
    assert_eq!(header.len(), 200);
    let axes = [1.5f64, 2.5, 10.0, 12.0, 14.0];
    let samples = [1i16, -2, 3, 4, 5, 6];
    header.extend(axes.iter().flat_map(|number| number.to_be_bytes()));
    header.extend(samples.iter().flat_map(|number| number.to_be_bytes()));
    header
}

/// Returns a shapefile with a point and a triangle.
fn shp_sample() -> Vec<u8> {
    let numbers = |list: &[f64]| list.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>();
    let point = [vec![0, 0, 0, 1, 0, 0, 0, 10, 1, 0, 0, 0], numbers(&[7.0, 8.0])].concat();
    let counts = [1, 4, 0].map(i32::to_le_bytes).concat();
    let corners = numbers(&[0.0, 0.0, 0.0, 4.0, 4.0, 0.0, 0.0, 0.0]);
    let triangle = [vec![0, 0, 0, 2, 0, 0, 0, 56, 5, 0, 0, 0], vec![0; 32], counts, corners].concat();
    let mut header = vec![0; 100];
    header[..4].copy_from_slice(&9994i32.to_be_bytes());
    header[27] = ((100 + point.len() + triangle.len()) / 2) as u8;
    [header, point, triangle].concat()
}

/// Returns a small valid file of each format with its reader.
fn samples() -> Vec<(Vec<u8>, Reader)> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 5, 4);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(vec![0, 0, 0, 9, 9, 9, 255, 255, 255]);
    encoder.set_trns(vec![255, 0]);
    encoder.write_header().unwrap().write_image_data(&[0, 1, 2, 1, 0].repeat(4)).unwrap();
    let asc =
        "ncols 3\nnrows 2\nxllcorner 10\nyllcenter -4\ncellsize 2\nnodata_value -9\n1 2,5 3e0\n4 -9 6\n";
    vec![
        (GEOJSON.into(), read_geojson),
        (asc.into(), read_asc),
        ("name,\"Y\", X \n\"a, \"\"b\"\"\",\"2\", 1\n,inf,-2e3\n".into(), read_points),
        (png, read_png),
        (geotiff_sample(), read_geotiff),
        (netcdf_sample(), read_netcdf),
        (npy_sample(), read_npy),
        (shp_sample(), read_shp),
        (SHAPES.into(), read_shapes),
        (THREATS.into(), read_threats),
        ("if(abs(x)+θ <= 8 and not y, hypot(x, 2^-y), max(1e-3, r))".into(), read_formula),
    ]
}

/// Returns the samples, and a recipe. A part of a recipe can be a recipe, even an empty one.
fn all_samples() -> Vec<(Vec<u8>, Reader)> {
    samples().into_iter().chain([(RECIPE.into(), read_recipe as Reader)]).collect()
}

fn assert_sentence(said: Result<(), String>) {
    if let Err(sentence) = said {
        assert!(sentence.starts_with(NAME), "{sentence}");
        let is_whole =
            sentence.ends_with('.') || (sentence.contains("did you mean") && sentence.ends_with('?'));
        assert!(is_whole && sentence.len() < 400, "{sentence}");
    }
}

#[test]
fn every_prefix_gives_a_result_or_a_sentence() {
    for (file, read) in all_samples() {
        assert_eq!(read(&file), Ok(()));
        (0..file.len()).for_each(|end| assert_sentence(read(&file[..end])));
    }
    for (file, read) in samples() {
        assert!(read(&[]).is_err() && read(&file[..file.len() / 2]).is_err());
    }
}

#[test]
fn damaged_recordings_give_a_result_or_a_sentence() {
    let file = recording_sample();
    assert_eq!(read_recording(&file), Ok(()));
    (0..file.len()).step_by(5).for_each(|end| assert_sentence(read_recording(&file[..end])));
    assert!(read_recording(&[]).is_err() && read_recording(&file[..file.len() / 2]).is_err());
    let mut changed = file.clone();
    for at in 0..file.len() {
        // Each change is a whole mesh, so there are fewer changes than for the other formats.
        changed[at] = [b'9', b'-', b'"', 0xff][at % 4];
        assert_sentence(read_recording(&changed));
        changed[at] = file[at];
    }
}

#[test]
fn every_changed_byte_gives_a_result_or_a_sentence() {
    for (file, read) in all_samples() {
        let mut changed = file.clone();
        for at in 0..file.len() {
            for byte in [0, b'0', b'9', b'-', b'e', b'"', b'[', b'}', b' ', b'\n', 0x7f, 0xff, file[at] ^ 1] {
                changed[at] = byte;
                assert_sentence(read(&changed));
            }
            changed[at] = file[at];
        }
    }
}

/// Returns the words of a text and what separates them.
fn words(text: &str) -> Vec<&str> {
    let is_word = |c: &char| c.is_alphanumeric() || "._-+".contains(*c);
    let mut ends: Vec<usize> = Vec::new();
    for ((_, c), (at, next)) in text.char_indices().zip(text.char_indices().skip(1)) {
        if is_word(&c) != is_word(&next) {
            ends.push(at);
        }
    }
    ends.push(text.len());
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(&ends).map(|(start, &end)| &text[start..end]).collect()
}

#[test]
fn no_message_repeats_a_long_word_of_a_file() {
    let letters = "a".repeat(100_000);
    let huge = [
        letters.clone(),
        format!("\"{letters}\""),
        "9".repeat(100_000),
        format!("0.{}e", "9".repeat(100_000)),
        format!("[{}", "{".repeat(100)),
        format!("\"{}", "`\\\"“é".repeat(20_000)),
    ];
    let recipe_lines = |bytes: &[u8]| {
        let found = |name: &str| Ok(PathBuf::from(name));
        let read = recipe::parse(Path::new(NAME), String::from_utf8(bytes.to_vec()).unwrap(), &found);
        read.map(drop).map_err(|error| error.to_string())
    };
    let texts = samples().into_iter().filter(|(file, _)| std::str::from_utf8(file).is_ok());
    for (file, read) in texts.chain([(RECIPE.into(), recipe_lines as Reader)]) {
        let text = String::from_utf8(file).unwrap();
        let words = words(&text);
        assert_eq!(words.concat(), text);
        let mut refused = 0;
        for at in 0..words.len() {
            for huge in &huge {
                let changed = [words[..at].concat(), huge.clone(), words[at + 1..].concat()].concat();
                if let Err(message) = read(changed.as_bytes()) {
                    refused += 1;
                    let start: String = message.chars().take(300).collect();
                    assert!(message.chars().count() < 1000, "{start}… for a word in place of {}", words[at]);
                }
            }
        }
        assert!(refused > words.len() / 2);
    }
}

#[test]
fn an_outline_may_begin_with_a_byte_order_mark() {
    let text = polygon("[[[0,0],[4,0],[4,4]]]");
    let marked = format!("\u{feff}{text}");
    assert_eq!(read_geojson(marked.as_bytes()), Ok(()));
    assert_eq!(read_shapes(marked.as_bytes()), Ok(()));
    assert!(said("\u{feff}").contains("line 1: the file ends too early"));
    assert!(said("\u{feff}\u{feff}{}").contains("line 1: this is not valid GeoJSON"));
}

fn polygon(rings: &str) -> String {
    format!(r#"{{"type":"Polygon","coordinates":{rings}}}"#)
}

fn said(file: &str) -> String {
    read_geojson(file.as_bytes()).unwrap_err()
}

#[test]
fn outlines_that_are_too_large_are_refused_before_they_take_memory() {
    let many = polygon(&format!("[[{}[0,0]]]", "[1,2],".repeat(10_000_000)));
    assert!(
        said(&many).contains("more than 1,000,000 corners, which is the limit. Simplify the outline first")
    );
    // Too many corners in all, with few in each polygon.
    let mut parts = String::from(r#"{"type":"GeometryCollection","geometries":["#);
    for k in 0..350_000 {
        write!(parts, "{},", polygon(&format!("[[[{k},0],[{k},1],[{k}.5,1]]]"))).unwrap();
    }
    parts.replace_range(parts.len() - 1.., "]}");
    assert!(said(&parts).contains("have 1,050,000 corners, and the limit is 1,000,000"));
    let point = r#"{"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}},"#;
    let points =
        format!(r#"{{"type":"FeatureCollection","features":[{}{{"type":"x"}}]}}"#, point.repeat(300_000));
    assert!(said(&points).contains("and it has Point. Export the area"));
    assert!(said(&polygon(&"[".repeat(1_000_000))).contains("line 1: "));
    let nested = r#"{"type":"GeometryCollection","geometries":["#.repeat(100_000);
    assert!(said(&nested).contains("recursion limit exceeded"));
}

#[test]
fn shapes_that_are_too_many_are_refused_before_they_take_memory() {
    let of = |geometry: &str, count: usize| {
        let list = format!("{geometry},").repeat(count);
        let last = r#"{"type":"Point","coordinates":[0,0]}"#;
        read_shapes(format!(r#"{{"type":"GeometryCollection","geometries":[{list}{last}]}}"#).as_bytes())
    };
    let point = r#"{"type":"Point","coordinates":[1,2]}"#;
    assert!(of(point, 1_000_005).unwrap_err().contains("more than 1,000,000 geometries, the limit"));
    let two = r#"{"type":"LineString","coordinates":[[1,2],[3,4]]}"#;
    assert!(of(two, 500_000).unwrap_err().contains("1,000,001 points, and the limit is 1,000,000"));
    // What is no geometry is not kept.
    assert_eq!(of(r#"{"type":"x"}"#, 1_500_000), Ok(()));
}

#[test]
fn an_odd_outline_covers_its_first_ring_without_its_holes() {
    let area = |rings: &str| {
        let polygons = geojson::read_from(polygon(rings).as_bytes(), Path::new(NAME)).unwrap();
        // Rounded: corners are moved to a fine grid.
        Domain::of_polygons(&polygons).map(|domain| (domain.region().unwrap().area() * 1e5).round() / 1e5)
    };
    // Clockwise or not, closed or not, and with a hole of either direction.
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4],[0,0]]]"), Ok(16.0));
    assert_eq!(area("[[[0,4],[4,4],[4,0],[0,0]]]"), Ok(16.0));
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4]],[[1,1],[3,1],[3,3],[1,3]]]"), Ok(12.0));
    // Rings that touch at a corner and along an edge; a hole twice; a spike; points that come twice.
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4]],[[0,0],[2,1],[1,2]],[[4,1],[4,3],[3,2]]]"), Ok(13.5));
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4]],[[1,1],[3,1],[3,3]],[[1,1],[3,1],[3,3]]]"), Ok(14.0));
    assert_eq!(area("[[[0,0],[4,0],[4,4],[2,4],[2,4],[2,6],[2,4],[0,4]]]"), Ok(16.0));
    // A ring that runs around twice; a hole outside its ring, and one that is half outside.
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4],[0,0],[4,0],[4,4],[0,4]]]"), Ok(16.0));
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4]],[[5,1],[7,1],[7,3],[5,3]]]"), Ok(16.0));
    assert_eq!(area("[[[0,0],[4,0],[4,4],[0,4]],[[3,1],[7,1],[7,3],[3,3]]]"), Ok(14.0));
    // A figure of eight covers both lobes.
    assert_eq!(area("[[[0,0],[4,4],[4,0],[0,4]]]"), Ok(8.0));
    // Coordinates in the millions with details of a metre.
    let far = area(
        "[[[4321000,5210000],[4321004,5210000],[4321004,5210003],[4321000,5210003]],[[4321001,5210001],[4321002,5210001],[4321001,5210002]]]",
    );
    assert_eq!(far, Ok(11.5));
    assert_eq!(area("[[[7,7],[7,7],[7,7]]]"), Err(RegionError::NoArea));
    assert_eq!(area("[[[-1e308,0],[1e308,0],[0,1]]]"), Err(RegionError::Extent));
}

#[test]
fn a_picture_with_too_much_data_is_refused_or_stays_within_its_size() {
    // A small file with megabytes of rows for an image of one pixel: the surplus is not unpacked.
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, 8000, 8000);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    encoder.write_header().unwrap().write_image_data(&vec![0; 8_000_000]).unwrap();
    assert!(file.len() < 30_000, "{} bytes", file.len());
    let crc = |bytes: &[u8]| {
        !bytes.iter().fold(!0u32, |crc, &byte| {
            (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg()))
        })
    };
    let with_size = |side: u32| {
        let mut file = file.clone();
        file[16..20].copy_from_slice(&side.to_be_bytes());
        file[20..24].copy_from_slice(&side.to_be_bytes());
        let sum = crc(&file[12..29]);
        file[29..33].copy_from_slice(&sum.to_be_bytes());
        decode(Cursor::new(file), Rect::UNIT, Behind::Black).map(|raster| raster.size())
    };
    assert_eq!(with_size(1).ok(), Some([1, 1]));
    assert!(with_size(8192).is_err(), "rows are missing");
    assert!(with_size(14_143).unwrap_err().to_string().contains("14,143 × 14,143 pixels cannot be read"));
    assert!(with_size(u32::MAX >> 1).is_err() && with_size(0).is_err());
}
