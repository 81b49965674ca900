//! Files are made here, byte by byte where the encoder of the decoder's crate has no such variant.

mod written;

use std::io::Cursor;

use glam::dvec2;
use meshbrush_mesh::text::LengthUnit;
use tiff::encoder::{Compression as Packing, Predictor, TiffEncoder, colortype};

use super::super::coordinate_system::CoordinateKind;
use super::*;
use meshbrush_core::layers::PositiveDepth;
use written::{COLUMNS, File, ROWS, Value};

fn read_back(file: &File) -> GeoTiff {
    decode(Cursor::new(file.bytes())).unwrap()
}

fn refusal(file: &File) -> String {
    decode(Cursor::new(file.bytes())).unwrap_err().to_string()
}

/// The values of a band as a raster has them: the lowest row first.
fn expected(file: &File) -> Vec<f32> {
    let line = file.size[0] * file.bands;
    let rows = file.samples.chunks(line).rev();
    rows.flat_map(|row| row.iter().step_by(file.bands)).map(|&sample| sample as f32).collect()
}

fn numbers(sample: (usize, u16), bands: usize) -> Vec<f64> {
    let mut random = fastrand::Rng::with_seed(sample.0 as u64 * 10 + u64::from(sample.1));
    let (bits, format) = sample;
    let one = || match format {
        3 => f64::from((random.f32() - 0.5) * 1e4),
        2 => (random.i64(..) >> (64 - bits)) as f64,
        _ => (random.u64(..) >> (64 - bits)) as f64,
    };
    std::iter::repeat_with(one).take(COLUMNS * ROWS * bands).collect()
}

const SAMPLES: [(usize, u16); 8] = [(8, 1), (8, 2), (16, 1), (16, 2), (32, 1), (32, 2), (32, 3), (64, 3)];

#[test]
fn every_sample_type_layout_and_predictor_is_read_exactly() {
    let mut files = 0;
    for sample in SAMPLES {
        for bands in [1, 3] {
            for tiles in [None, Some([16, 16]), Some([3, 2]), Some([7, 5])] {
                for variant in 0..16 {
                    let bit = |n: usize| variant >> n & 1 == 1;
                    let of_float = if sample.1 == 3 { 3 } else { 2 };
                    let file = File {
                        is_big: bit(0),
                        is_big_endian: bit(1),
                        is_planar: bit(2) && bands > 1,
                        is_deflated: bit(3),
                        predictor: if bit(3) { of_float } else { 1 },
                        tiles,
                        ..File::of(sample, numbers(sample, bands))
                    };
                    let read = read_back(&file.clone().placed());
                    assert_eq!(
                        read.raster.values(),
                        expected(&file),
                        "{sample:?} {bands} {tiles:?} {variant}"
                    );
                    assert_eq!(read.raster.bounds(), Rect::new(dvec2(10.0, 15.0), dvec2(17.0, 20.0)));
                    assert_eq!((read.is_placed, usize::from(read.bands)), (true, bands));
                    files += 1;
                }
            }
        }
    }
    assert_eq!(files, 8 * 2 * 4 * 16);
}

#[test]
fn compressions_of_the_encoder_are_read() {
    let samples: Vec<i16> = (0..COLUMNS * ROWS).map(|n| (n * n) as i16 - 300).collect();
    let file = File::of((16, 2), samples.iter().map(|&sample| sample.into()).collect());
    let packings =
        [Packing::Uncompressed, Packing::Lzw, Packing::Deflate(Default::default()), Packing::Packbits];
    for packing in packings {
        for predictor in [Predictor::None, Predictor::Horizontal] {
            let mut bytes = Cursor::new(Vec::new());
            let encoder = TiffEncoder::new(&mut bytes).unwrap().with_compression(packing);
            let mut encoder = encoder.with_predictor(predictor);
            let image = encoder.new_image::<colortype::GrayI16>(COLUMNS as u32, ROWS as u32).unwrap();
            image.write_data(&samples).unwrap();
            let read = decode(Cursor::new(bytes.into_inner())).unwrap();
            assert_eq!(read.raster.values(), expected(&file));
            assert!(!read.is_placed);
        }
    }
}

#[test]
fn pixels_without_a_value_are_nan() {
    let lowest = f64::from(f32::MIN);
    for (sample, text, missing) in [
        ((32, 3), "-3.4028235e+38", lowest),
        ((32, 3), "-3.40282346638528898e+38 ", lowest),
        ((32, 3), "nan", f64::NAN),
        ((32, 3), "-9999", -9999.0),
        ((64, 3), "-1.7976931348623157e+308", f64::MIN),
        ((64, 3), "inf", f64::INFINITY),
        ((16, 2), "-32768", -32768.0),
        ((8, 1), "255.0", 255.0),
        ((8, 2), "-128", -128.0),
        ((32, 2), "2147483647", 2_147_483_647.0),
    ] {
        let mut samples = vec![1.0; COLUMNS * ROWS];
        samples[COLUMNS + 2] = missing;
        let file = File::of(sample, samples).with(42113, Value::Text(text));
        let read = read_back(&file).raster;
        let nan: Vec<_> = read.all().pixels().filter(|&(x, y)| read.get(x, y).is_nan()).collect();
        assert_eq!(nan, [(2, ROWS as u32 - 2)], "{text}");
        // A number that samples cannot have leaves all values.
        let file = file.with(42113, Value::Text("1e300"));
        let values = decode(Cursor::new(file.bytes())).map(|read| read.raster);
        assert!(values.is_err() || values.is_ok_and(|raster| raster.values().contains(&1.0)));
    }
    let file = File::of((32, 3), vec![1.0; COLUMNS * ROWS]).with(42113, Value::Text("none"));
    assert!(refusal(&file).contains("“none”, which is not a number"));
    let file = File::of((64, 3), vec![1e39; COLUMNS * ROWS]);
    assert!(refusal(&file).contains("the value 1e39 is too large") && refusal(&file).contains("-a_nodata"));
}

#[test]
fn samples_become_values_by_scale_offset_and_unit() {
    const SCALED: &str = r#"<GDALMetadata><Item name="SCALE" sample="0" role="scale">0.5</Item>
        <Item name="OFFSET" sample="0" role="offset">-8</Item></GDALMetadata>"#;
    const FEET: &str =
        r#"<GDALMetadata><Item name="UNITTYPE" sample="0" role="unittype">ft</Item></GDALMetadata>"#;
    let file = File::of((16, 2), vec![20.0; COLUMNS * ROWS]);
    let read = |file: &File| decode(Cursor::new(file.bytes())).unwrap();
    assert_eq!(read(&file.clone().with(42112, Value::Text(SCALED))).raster.get(0, 0), 2.0);
    let feet = read(&file.clone().with(42112, Value::Text(FEET)));
    assert_eq!((feet.raster.get(0, 0), feet.facts.notes.len()), (6.096, 1));
    // Heights in US survey feet, and depths below the mean sea level.
    let keys = |key, value| Value::Shorts(vec![1, 1, 0, 1, key, 0, 1, value]);
    assert_eq!(
        read(&file.clone().with(34735, keys(4099, 9003))).raster.get(0, 0),
        (24_000.0 / 3937.0) as f32
    );
    let depths = read(&file.clone().with(34735, keys(4096, 5715)));
    assert_eq!((depths.raster.get(0, 0), depths.facts.positive), (20.0, Some(PositiveDepth::Down)));
    assert_eq!(read(&file.with(42112, Value::Text("<damaged"))).raster.get(0, 0), 20.0);
}

#[test]
fn a_band_is_chosen_and_pictures_in_colours_are_refused() {
    let pixel = [1.0, 2.0, 3.0];
    for is_planar in [false, true] {
        let file = File { is_planar, ..File::of((8, 1), pixel.repeat(COLUMNS * ROWS)) }.placed();
        let band = |file: &File, band| Pixels::decode(Cursor::new(file.bytes()), band, Beside::default());
        for (place, value) in pixel.into_iter().enumerate() {
            assert!(band(&file, Some(place)).unwrap().values.iter().all(|&read| f64::from(read) == value));
        }
        assert!(band(&file, None).unwrap().facts.notes[0].contains("it has 3 bands"));
        let sentence = band(&file, Some(3)).map(drop).unwrap_err().to_string();
        assert!(sentence.contains("it has no band 4"), "{sentence}");
        let colours = file.clone().with(262, Value::Shorts(vec![2]));
        assert!(refusal(&colours).contains("a picture in colours"));
        assert_eq!(band(&colours, Some(1)).unwrap().values[0], 2.0);
        // The third band is the opacity of pixels.
        let mut hidden = file.clone().with(338, Value::Shorts(vec![0, 2]));
        hidden.samples[2] = 0.0;
        let read = read_back(&hidden).raster;
        assert_eq!(read.values().iter().filter(|value| value.is_nan()).count(), 1);
        assert!(read.get(0, ROWS as u32 - 1).is_nan());
    }
}

#[test]
fn fills_that_are_not_declared_are_no_values_and_said() {
    for (sample, fill) in
        [((32, 3), 3.4028234663852886e38), ((32, 3), 1e20), ((16, 2), -32768.0), ((64, 3), -1e30)]
    {
        let mut samples = vec![5.0; COLUMNS * ROWS];
        samples[..2].fill(fill);
        let read = decode(Cursor::new(File::of(sample, samples).bytes())).unwrap();
        assert_eq!(read.raster.values().iter().filter(|value| value.is_nan()).count(), 2, "{fill}");
        assert!(read.facts.notes[0].contains("2 pixels"), "{:?}", read.facts.notes);
    }
    let mut samples: Vec<f64> = (0..COLUMNS * ROWS).map(|n| n as f64).collect();
    samples[3] = -9999.0;
    let read = decode(Cursor::new(File::of((32, 3), samples).bytes())).unwrap();
    assert!(read.raster.values().contains(&-9999.0) && read.facts.notes[0].contains("far from all others"));
}

#[test]
fn tiles_that_are_not_stored_have_no_value() {
    let file = File { tiles: Some([4, 4]), ..File::of((32, 3), vec![1.0; COLUMNS * ROWS]) };
    // Four tiles, of which the upper right one is left out.
    let counts = Value::Longs(vec![64, 0, 64, 64]);
    let offsets = Value::Longs(vec![8, 0, 8, 8]);
    let sparse = file.with(324, offsets).with(325, counts);
    let read = read_back(&sparse).raster;
    assert_eq!((read.get(6, 4), read.get(0, 4), read.get(6, 0)), (0.0, 1.0, 1.0));
    let read = read_back(&sparse.with(42113, Value::Text("-1"))).raster;
    assert!(read.get(6, 4).is_nan() && read.get(4, 1).is_nan() && read.get(3, 4) == 1.0);
}

fn bounds_of(file: &File) -> [f64; 4] {
    let bounds = read_back(file).raster.bounds();
    [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y]
}

#[test]
fn the_place_is_that_of_tie_point_or_matrix() {
    let plain = File::of((8, 1), numbers((8, 1), 1));
    let keys = |raster_type| Value::Shorts(vec![1, 1, 0, 2, 1024, 0, 1, 2, 1025, 0, 1, raster_type]);
    let tied = |tie: [f64; 3]| {
        let scale = Value::Doubles(vec![0.5, 0.25, 0.0]);
        let tie = Value::Doubles(vec![tie[0], tie[1], 0.0, 100.0, 50.0, tie[2]]);
        plain.clone().with(33550, scale).with(33922, tie)
    };
    assert_eq!(bounds_of(&tied([0.0; 3])), [100.0, 48.75, 103.5, 50.0]);
    assert_eq!(bounds_of(&tied([0.0; 3]).with(34735, keys(1))), [100.0, 48.75, 103.5, 50.0]);
    // Samples at points: the tie point is the centre of the first pixel.
    assert_eq!(bounds_of(&tied([0.0; 3]).with(34735, keys(2))), [99.75, 48.875, 103.25, 50.125]);
    assert_eq!(bounds_of(&tied([7.0, 5.0, 9.0])), [96.5, 50.0, 100.0, 51.25]);
    let matrix = |step: f64, turn: f64| {
        let (x, y) = ([0.5, turn, 0.0, 100.0], [0.0, step, 0.0, 50.0]);
        let rest = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        plain.clone().with(34264, Value::Doubles([&x[..], &y, &rest].concat()))
    };
    assert_eq!(bounds_of(&matrix(-0.25, 0.0)), [100.0, 48.75, 103.5, 50.0]);
    assert_eq!(bounds_of(&matrix(-0.25, 0.0).with(34735, keys(2))), [99.75, 48.875, 103.25, 50.125]);
    assert_eq!(read_back(&matrix(-0.25, 0.0)).raster.values(), expected(&plain));
    // From south to north: the first row of the file is the lowest.
    assert_eq!(bounds_of(&matrix(0.25, 0.0)), [100.0, 50.0, 103.5, 51.25]);
    let in_order: Vec<f32> = plain.samples.iter().map(|&sample| sample as f32).collect();
    assert_eq!(read_back(&matrix(0.25, 0.0)).raster.values(), in_order);
    assert!(refusal(&matrix(-0.25, 0.1)).contains("turned or warped"));
    // A turn of less than a pixel in a row of a thousand million is rounding.
    assert_eq!(bounds_of(&matrix(-0.25, 1e-10)), [100.0, 48.75, 103.5, 50.0]);
    assert!(refusal(&matrix(-0.25, 1e-9)).contains("turned or warped"));
    let warped = plain.clone().with(33922, Value::Doubles(vec![0.0; 12]));
    assert!(refusal(&warped).contains("turned or warped"));
    let mirrored = plain.clone().with(34264, Value::Doubles([&[-0.5], &[0.0; 15][..]].concat()));
    assert!(refusal(&mirrored).contains("from east to west"));
    for step in [0.0, f64::NAN, f64::INFINITY, 1e-300] {
        let sentence = refusal(&plain.clone().placed().with(33550, Value::Doubles(vec![step, 1.0, 0.0])));
        assert!(sentence.contains("covers no rectangle"), "{step}: {sentence}");
    }
}

#[test]
fn the_keys_name_the_coordinate_system() {
    let plain = File::of((8, 1), numbers((8, 1), 1));
    let system = |keys: &[u16], texts| {
        let directory = [&[1, 1, 0, keys.len() as u16 / 4], keys].concat();
        let file = plain.clone().with(34735, Value::Shorts(directory)).with(34737, Value::Text(texts));
        read_back(&file).coordinate_system
    };
    assert_eq!(read_back(&plain).coordinate_system, None);
    let geographic = system(&[1024, 0, 1, 2, 2048, 0, 1, 4326, 2049, 34737, 7, 0], "WGS 84|").unwrap();
    assert_eq!((geographic.kind, geographic.epsg), (CoordinateKind::Geographic, Some(4326)));
    assert_eq!((geographic.name.as_deref(), geographic.unit), (Some("WGS 84"), LengthUnit::Degree));
    let projected = system(&[1024, 0, 1, 1, 1026, 34737, 4, 3, 3072, 0, 1, 32633], "ab|UTM|").unwrap();
    assert_eq!((projected.kind, projected.epsg), (CoordinateKind::Projected, Some(32633)));
    assert_eq!((projected.name.as_deref(), projected.unit), (Some("UTM"), LengthUnit::Metre));
    let own = system(&[1024, 0, 1, 1, 3072, 0, 1, 32767, 3073, 34737, 999, 65000], "a|").unwrap();
    assert_eq!((own.kind, own.epsg, own.name), (CoordinateKind::Projected, None, None));
    assert_eq!(system(&[1024, 0, 1], ""), None);
    assert_eq!(system(&[1024, 0, 1, 3], "").map(|system| system.kind), Some(CoordinateKind::Other));
}

#[test]
fn pictures_that_are_too_large_are_refused_before_they_take_memory() {
    let plain = File::of((32, 3), numbers((32, 3), 1)).placed();
    let sized = |columns, rows| {
        plain.clone().with(256, Value::Longs(vec![columns])).with(257, Value::Longs(vec![rows]))
    };
    for [columns, rows] in [[100_000, 5], [7, u32::MAX], [0, 5], [20_000, 20_000]] {
        let sentence = refusal(&sized(columns, rows));
        assert!(sentence.contains("pixels"), "{columns} × {rows}: {sentence}");
    }
    let bands = sized(65_536, 3000).with(277, Value::Shorts(vec![u16::MAX])).with(278, Value::Longs(vec![1]));
    assert!(refusal(&bands).contains("this is not a TIFF raster"));
    let tiles = File { tiles: Some([16, 16]), ..plain };
    for [width, height] in [[u32::MAX, u32::MAX], [u32::MAX, 1], [1, u32::MAX], [0, 16], [1, 1]] {
        let tiles = tiles.clone().with(322, Value::Longs(vec![width])).with(323, Value::Longs(vec![height]));
        let sentence = decode(Cursor::new(tiles.bytes())).map(drop).map_err(|flaw| flaw.to_string());
        assert!(sentence.is_err_and(|sentence| sentence.ends_with('.')), "{width} × {height}");
    }
}

#[test]
fn what_is_no_raster_of_numbers_is_refused_with_a_sentence() {
    let plain = File::of((8, 1), numbers((8, 1), 1)).placed();
    for (tag, value, says) in [
        (259, 7, "its compression has the number 7"),
        (259, 50000, "only Deflate, LZW and PackBits"),
        (262, 3, "palette"),
        (258, 4, "samples have 4 bits"),
        (339, 3, "8 bits in the format 3"),
        (339, 4, "in the format 4"),
        (317, 3, "its predictor"),
        (317, 9, "unknown predictor"),
    ] {
        let sentence = refusal(&plain.clone().with(tag, Value::Shorts(vec![value])));
        assert!(sentence.contains(says) && sentence.ends_with('.'), "{tag}: {sentence}");
    }
}

#[test]
fn a_directory_that_points_to_itself_ends() {
    let file = File::of((8, 1), numbers((8, 1), 1)).placed();
    let mut bytes = file.bytes();
    // The next directory is this one.
    let directory: [u8; 4] = bytes[4..8].try_into().unwrap();
    let end = bytes.len();
    bytes[end - 4..].copy_from_slice(&directory);
    match decode(Cursor::new(bytes)) {
        Ok(read) => assert_eq!(read.raster.values(), expected(&file)),
        Err(flaw) => assert!(flaw.to_string().contains("cycle"), "{flaw}"),
    }
}

#[test]
fn every_cut_and_every_changed_byte_gives_a_result_or_a_sentence() {
    let numbers = numbers((32, 3), 2);
    let of = |tiles, is_big| File {
        tiles,
        is_big,
        is_deflated: true,
        predictor: 3,
        ..File::of((32, 3), numbers.clone())
    };
    for file in [of(None, false), of(Some([4, 4]), true)] {
        let keys = Value::Shorts(vec![1, 1, 0, 2, 1024, 0, 1, 2, 2049, 34737, 3, 0]);
        let file =
            file.placed().with(34735, keys).with(34737, Value::Text("ab|")).with(42113, Value::Text("-9"));
        let bytes = file.bytes();
        let check = |bytes: &[u8]| {
            if let Err(flaw) = decode(Cursor::new(bytes)) {
                let sentence = flaw.to_string();
                assert!(sentence.ends_with('.') && sentence.len() < 400, "{sentence}");
            }
        };
        // The last bytes are the place of the next directory, which is not read.
        for end in 0..bytes.len() - 8 {
            assert!(decode(Cursor::new(&bytes[..end])).is_err(), "cut at {end}");
        }
        let mut changed = bytes.clone();
        for at in 0..bytes.len() {
            for byte in [0, 1, 2, 3, 9, 0x7f, 0x80, 0xff, bytes[at] ^ 1] {
                changed[at] = byte;
                check(&changed);
            }
            changed[at] = bytes[at];
        }
    }
}
