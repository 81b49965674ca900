//! NetCDF-4.

use super::*;

/// Files that other programs wrote.
const FILES: [(&str, &[u8]); 8] = [
    ("contiguous", include_bytes!("contiguous.nc")),
    ("packed", include_bytes!("packed.nc")),
    ("attributes", include_bytes!("attributes.nc")),
    ("unlimited", include_bytes!("unlimited.nc")),
    ("fixed array", include_bytes!("fixed_array.nc")),
    ("extensible array", include_bytes!("extensible_array.nc")),
    ("tree", include_bytes!("tree.nc")),
    ("one chunk", include_bytes!("one_chunk.nc")),
];

fn read(bytes: &[u8], window: Option<Rect>) -> Result<FileGrid, Flaw> {
    let place = window.map_or(GridPlace::default(), at);
    decode(Cursor::new(bytes.to_vec()), None, &place, &Meter::default())
}

#[test]
fn every_layout_is_read_exactly() {
    for (name, bytes) in FILES {
        let grid = read(bytes, None).unwrap();
        assert_eq!((grid.raster.size(), sides(&grid)), ([9, 7], [4.0, 50.0, 8.5, 53.5]), "{name}");
        for (x, y) in grid.raster.all().pixels() {
            let (value, expected) = (grid.raster.get(x, y), (y * 9 + x) as f32);
            assert!(
                if expected == 20.0 { value.is_nan() } else { value == expected },
                "{name}: {value} at {x}, {y}"
            );
        }
        assert_eq!(grid.system.map(|system| system.kind), Some(CoordinateKind::Geographic), "{name}");
        let window = Rect::new(dvec2(5.6, 51.7), dvec2(5.7, 52.3));
        let part = read(bytes, Some(window)).unwrap();
        assert_eq!(sides(&part), [5.0, 51.0, 6.5, 53.0], "{name}");
        assert_eq!(part.raster.row(0, 1..3), [21.0, 22.0], "{name}");
    }
}

#[test]
fn every_cut_and_many_changed_bytes_give_a_result_or_a_sentence() {
    for (name, bytes) in FILES {
        let tried = |bytes: &[u8]| {
            let read = read(bytes, None);
            if let Err(flaw) = &read {
                let sentence = flaw.to_string();
                assert!(sentence.ends_with('.') && sentence.len() < 500, "{name}: {sentence}");
            }
            read.is_ok()
        };
        for end in (0..bytes.len()).step_by(7) {
            tried(&bytes[..end]);
        }
        assert!(!tried(&bytes[..bytes.len() / 2]), "{name}");
        let mut changed = bytes.to_vec();
        for at in (0..bytes.len()).step_by(4) {
            changed[at] = [0, 0x7f, 0xff, bytes[at] ^ 1, bytes[at] ^ 0x80][at / 4 % 5];
            tried(&changed);
            changed[at] = bytes[at];
        }
    }
}
