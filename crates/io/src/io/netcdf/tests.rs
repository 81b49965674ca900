//! Classic files are written here, byte by byte. Those in NetCDF-4 are in the folder `netcdf/tests`, made
//! with its script `make.py`.

mod hdf;
mod written;

use std::io::Cursor;

use meshbrush_core::earth::Projection;
use meshbrush_mesh::text::LengthUnit;

use super::super::GridWindow;
use super::super::coordinate_system::CoordinateKind;
use super::*;
use written::{File as Classic, Of, Written};

const LON: [f64; 4] = [10.25, 10.75, 11.25, 11.75];
const LAT: [f64; 3] = [50.5, 51.5, 52.5];

fn read(file: &Classic) -> Result<FileGrid, Flaw> {
    decode(Cursor::new(file.bytes()), None, &GridPlace::default(), &Meter::default())
}

fn read_window(file: &Classic, [low_x, low_y, high_x, high_y]: [f64; 4]) -> Result<FileGrid, Flaw> {
    let place = at(Rect::new(dvec2(low_x, low_y), dvec2(high_x, high_y)));
    decode(Cursor::new(file.bytes()), None, &place, &Meter::default())
}

/// Returns the place of a grid of which a window is wanted.
fn at(area: Rect) -> GridPlace {
    GridPlace { over: None, window: Some(GridWindow { area, plane: None }) }
}

fn said(file: &Classic) -> String {
    read(file).unwrap_err().to_string()
}

fn sides(grid: &FileGrid) -> [f64; 4] {
    let bounds = grid.raster.bounds();
    [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y]
}

fn counted() -> Vec<f64> {
    (1..=12).map(f64::from).collect()
}

/// A grid of 4 × 3 pixels with the numbers 1 to 12.
fn sample() -> Classic {
    Classic::grid(&LON, &LAT, 5, counted())
}

/// The values of a grid that has them in the order of rows from the lowest.
fn values(numbers: &[f64]) -> Vec<f32> {
    numbers.iter().map(|&number| number as f32).collect()
}

#[test]
fn every_version_and_type_is_read_exactly() {
    for version in [1, 2, 5] {
        for code in [1, 3, 4, 5, 6, 7, 8, 9, 10, 11] {
            let mut numbers = counted();
            numbers[5] = match code {
                1 => -128.0,
                3 | 4 | 10 => -4000.0,
                5 | 6 => -0.5,
                7 => 255.0,
                _ => 40_000.0,
            };
            let file = Classic { version, ..Classic::grid(&LON, &LAT, code, numbers.clone()) };
            let grid = read(&file).unwrap();
            assert_eq!((grid.raster.size(), sides(&grid)), ([4, 3], [10.0, 50.0, 12.0, 53.0]));
            assert_eq!(grid.raster.values(), values(&numbers), "version {version}, type {code}");
            let system = grid.system.unwrap();
            assert_eq!((system.kind, system.unit), (CoordinateKind::Geographic, LengthUnit::Degree));
        }
    }
}

#[test]
fn rows_and_columns_are_in_the_order_of_the_coordinates() {
    let reversed = |list: &[f64]| list.iter().rev().copied().collect::<Vec<_>>();
    let (lon, lat) = (reversed(&LON), reversed(&LAT));
    let expected = values(&counted());
    let rows = |order: [usize; 3]| order.map(|row| counted()[4 * row..4 * row + 4].to_vec()).concat();
    let south_up = Classic::grid(&LON, &LAT, 3, counted());
    let north_up = Classic::grid(&LON, &lat, 3, rows([2, 1, 0]));
    let turned = Classic::grid(&lon, &lat, 3, reversed(&counted()));
    let mut by_columns = Classic::grid(&LON, &lat, 3, Vec::new());
    let of = |x: usize, y: usize| counted()[4 * y + x];
    by_columns.z().samples = (0..4).flat_map(|x| [2, 1, 0].map(|y| of(x, y))).collect();
    by_columns.z().dimensions = vec![1, 0];
    for file in [&south_up, &north_up, &turned, &by_columns] {
        let grid = read(file).unwrap();
        assert_eq!((grid.raster.values(), sides(&grid)), (&*expected, [10.0, 50.0, 12.0, 53.0]));
        let part = read_window(file, [11.1, 52.1, 11.2, 52.2]).unwrap();
        assert_eq!(sides(&part), [10.5, 51.0, 12.0, 53.0]);
        assert_eq!(part.raster.values(), [6.0, 7.0, 8.0, 10.0, 11.0, 12.0]);
    }
}

#[test]
fn records_and_further_dimensions_of_length_one_are_read() {
    // Two variables per record are padded, one alone is not.
    for (others, version) in [(0, 1), (0, 5), (1, 1), (2, 2)] {
        let mut file = Classic { version, record: Some(0), ..Classic::grid(&LON, &LAT, 3, counted()) };
        let mut z = file.variables.pop().unwrap();
        z.samples = counted();
        if others == 0 {
            // The coordinates of a record dimension are in the records: here they are not.
            file.record = None;
        }
        for name in ["flag", "mark"].into_iter().take(others) {
            let samples = vec![1.0, 2.0, 3.0];
            file.variables.push(Written { name, code: 1, dimensions: vec![0], attributes: vec![], samples });
        }
        file.variables.push(z);
        assert_eq!(read(&file).unwrap().raster.values(), values(&counted()), "{others} others");
    }
    // One time of unlimited length, and nothing else in the records: three bytes are not padded.
    let mut file = Classic::grid(&LON[..3], &LAT, 1, (1..=9).map(f64::from).collect());
    file.dimensions.push(("time", 1));
    file.record = Some(2);
    file.z().dimensions = vec![2, 0, 1];
    assert_eq!(read(&file).unwrap().raster.values(), values(&counted()[..9]));
    // A file that was not closed has as many records as it holds.
    let mut bytes = file.bytes();
    bytes[4..8].fill(0xff);
    let grid = decode(Cursor::new(bytes), None, &GridPlace::default(), &Meter::default()).unwrap();
    assert_eq!(grid.raster.size(), [3, 3]);
    // Two times are two grids.
    file.dimensions[2].1 = 2;
    file.z().samples = counted()[..9].repeat(2);
    assert!(said(&file).contains("has no grid of numbers") && said(&file).contains("z(time, lat, lon)"));
}

#[test]
fn samples_without_a_value_are_nan_and_packed_ones_are_unpacked() {
    let lowest = f64::from(f32::MIN);
    for (code, missing, attributes) in [
        (5, lowest, vec![("_FillValue", Of::Numbers(5, vec![lowest]))]),
        (5, lowest, vec![("missing_value", Of::Numbers(6, vec![-3.402_823_5e38]))]),
        (5, f64::NAN, vec![]),
        (5, 9.969_209_968_386_869e36, vec![]),
        (6, f64::INFINITY, vec![("_FillValue", Of::Numbers(6, vec![f64::INFINITY]))]),
        (3, -32_767.0, vec![]),
        (3, -32_768.0, vec![("_FillValue", Of::Numbers(3, vec![-32_768.0]))]),
        (3, -99.0, vec![("missing_value", Of::Numbers(3, vec![-32_768.0, -99.0]))]),
        (3, -99.0, vec![("valid_range", Of::Numbers(3, vec![0.0, 12.0]))]),
        (3, 99.0, vec![("valid_max", Of::Numbers(3, vec![12.0]))]),
        (1, -1.0, vec![("_FillValue", Of::Numbers(1, vec![-1.0])), ("_Unsigned", Of::Text("true"))]),
    ] {
        let mut numbers = counted();
        numbers[6] = missing;
        let mut file = Classic::grid(&LON, &LAT, code, numbers);
        file.z().attributes = attributes;
        let read = read(&file).unwrap().raster;
        let without: Vec<_> = read.all().pixels().filter(|&(x, y)| read.get(x, y).is_nan()).collect();
        assert_eq!(without, [(2, 1)], "{code} {missing}");
    }
    let packed = Classic::grid(&LON, &LAT, 3, counted())
        .with("_FillValue", Of::Numbers(3, vec![3.0]))
        .with("scale_factor", Of::Numbers(6, vec![0.5]))
        .with("add_offset", Of::Numbers(5, vec![-100.0]));
    let read_back = read(&packed).unwrap().raster;
    assert!(read_back.get(2, 0).is_nan());
    assert_eq!((read_back.get(0, 0), read_back.get(3, 2)), (-99.5, -94.0));
    let mut bytes = Classic::grid(&LON, &LAT, 1, vec![-2.0; 12]).with("_Unsigned", Of::Text("true"));
    assert_eq!(read(&bytes).unwrap().raster.get(0, 0), 254.0);
    bytes.z().attributes.clear();
    assert_eq!(read(&bytes).unwrap().raster.get(0, 0), -2.0);
    let infinite = said(&Classic::grid(&LON, &LAT, 6, vec![1e39; 12]));
    assert!(
        infinite.contains("the value 1e39 is too large") && infinite.contains("_FillValue"),
        "{infinite}"
    );
}

#[test]
fn coordinates_are_known_by_standard_name_unit_axis_or_name() {
    let mut file = sample();
    for (names, attributes, kind, unit) in [
        (
            ["a", "b"],
            [("units", "degreeN"), ("units", "degree_E")],
            CoordinateKind::Geographic,
            LengthUnit::Degree,
        ),
        (
            ["a", "b"],
            [("standard_name", "latitude"), ("standard_name", "longitude")],
            CoordinateKind::Geographic,
            LengthUnit::Degree,
        ),
        (["Latitude", "LON"], [("title", ""), ("title", "")], CoordinateKind::Geographic, LengthUnit::Degree),
        (["y", "x"], [("units", "m"), ("units", "metres")], CoordinateKind::Projected, LengthUnit::Metre),
        (["Y", "X"], [("units", "km"), ("units", "km")], CoordinateKind::Projected, LengthUnit::Kilometre),
    ] {
        for (side, (name, (attribute, text))) in names.into_iter().zip(attributes).enumerate() {
            file.dimensions[side].0 = name;
            file.variables[side].name = name;
            file.variables[side].attributes = vec![(attribute, Of::Text(text))];
        }
        let system = read(&file).unwrap().system.unwrap();
        assert_eq!((system.kind, system.unit), (kind, unit), "{names:?}");
    }
    file.variables[0].attributes.clear();
    file.variables[1].attributes.clear();
    assert_eq!(read(&file).unwrap().system, None);
    for (side, axis) in ["Y", "X"].into_iter().enumerate() {
        file.variables[side].attributes = vec![("axis", Of::Text(axis)), ("units", Of::Text("feet"))];
        file.variables[side].name = ["first", "second"][side];
    }
    assert_eq!(read(&file).unwrap().system, None);
    file.variables[1].attributes.clear();
    assert!(said(&file).contains("no grid of numbers over x and y"), "{}", said(&file));
}

#[test]
fn a_grid_mapping_says_the_system() {
    let wkt = r#"PROJCS["WGS 84 / UTM zone 33N",UNIT["metre",1],AUTHORITY["EPSG","32633"]]"#;
    let geographic = Of::Text("latitude_longitude");
    for (attributes, units, epsg, unit) in [
        (vec![("crs_wkt", Of::Text(wkt))], "m", Some(32633), LengthUnit::Metre),
        (vec![("spatial_ref", Of::Text(wkt))], "m", Some(32633), LengthUnit::Metre),
        (vec![("spatial_ref", Of::Text(wkt))], "km", None, LengthUnit::Kilometre),
        (
            vec![("grid_mapping_name", geographic.clone()), ("epsg_code", Of::Text("EPSG:4258"))],
            "degrees",
            Some(4258),
            LengthUnit::Degree,
        ),
        (vec![("grid_mapping_name", geographic)], "degrees", None, LengthUnit::Degree),
        (
            vec![("grid_mapping_name", Of::Text("mercator")), ("epsg", Of::Numbers(4, vec![3395.0]))],
            "m",
            Some(3395),
            LengthUnit::Metre,
        ),
    ] {
        let mut file = sample().with("grid_mapping", Of::Text("crs: x y"));
        if units != "degrees" {
            for (side, name) in ["y", "x"].into_iter().enumerate() {
                file.variables[side].name = name;
                file.dimensions[side].0 = name;
                file.variables[side].attributes = vec![("units", Of::Text(units))];
            }
        }
        let crs = Written { name: "crs", code: 2, dimensions: vec![], attributes, samples: vec![] };
        file.variables.insert(0, crs);
        let system = read(&file).unwrap().system.unwrap();
        assert_eq!((system.epsg, system.unit), (epsg, unit), "{units}");
    }
}

#[test]
fn one_of_several_grids_is_chosen_by_its_name() {
    let mut file = sample();
    let other = |name, value: f64| Written {
        name,
        code: 5,
        dimensions: vec![0, 1],
        attributes: vec![],
        samples: vec![value; 12],
    };
    file.variables.push(other("Depth", 7.0));
    file.variables.push(other("elevation", 8.0));
    let first = |file: &Classic, name| {
        let grid = decode(Cursor::new(file.bytes()), name, &GridPlace::default(), &Meter::default());
        grid.map(|grid| grid.raster.get(0, 0)).map_err(|flaw| flaw.to_string())
    };
    assert_eq!(first(&file, None), Ok(8.0));
    assert_eq!(first(&file, Some("z")), Ok(1.0));
    let none = first(&file, Some("lat")).unwrap_err();
    assert_eq!(none, "the file has no grid “lat”. It has: z, Depth, elevation.");
    file.variables.pop();
    assert_eq!(first(&file, None), Ok(1.0));
    file.variables[2].name = "a";
    file.variables[3].name = "b";
    let several = first(&file, None).unwrap_err();
    assert_eq!(several, "the file has several grids: a, b. Name one after the file, as in FILE.nc#NAME.");
}

#[test]
fn coordinates_that_are_not_even_are_refused() {
    let with_lat =
        |lat: [f64; 3]| read(&Classic::grid(&LON, &lat, 5, counted())).map_err(|flaw| flaw.to_string());
    let uneven = with_lat([50.0, 51.02, 52.0]).unwrap_err();
    assert!(
        uneven.contains("“lat” is not evenly spaced: a value is 51.02, where steps of 1 give 51."),
        "{uneven}"
    );
    assert!(with_lat([50.0, 51.009, 52.0]).is_ok());
    for lat in [
        [50.0, f64::NAN, 52.0],
        [f64::NAN, 51.0, 52.0],
        [50.0; 3],
        [50.0, 51.0, f64::INFINITY],
        [-1e308, 0.0, 1e308],
    ] {
        assert!(with_lat(lat).is_err(), "{lat:?}");
    }
    // Single precision rounds fine coordinates.
    let step = 1.0 / 960.0;
    let lon: Vec<f64> = (0..400).map(|n| f64::from((179.0 + f64::from(n) * step) as f32)).collect();
    let mut fine = Classic::grid(&lon, &LAT, 1, vec![1.0; 1200]);
    fine.variables[1].code = 5;
    assert_eq!(read(&fine).unwrap().raster.size(), [400, 3]);
    let single = said(&Classic::grid(&LON[..1], &LAT, 5, counted()));
    assert!(single.contains("“lon” has 1 values"), "{single}");
    let mut old = sample();
    for (variable, name) in old.variables.iter_mut().zip(["x_range", "y_range", "z"]) {
        variable.name = name;
        variable.attributes.clear();
    }
    assert!(said(&old).contains("gmt grdconvert"), "{}", said(&old));
    let mut curved = sample();
    for variable in &mut curved.variables[..2] {
        variable.dimensions = vec![0, 1];
        variable.samples = counted();
    }
    assert!(said(&curved).contains("the grid is curved, and only straight grids"), "{}", said(&curved));
}

#[test]
fn a_window_is_where_the_grid_is_or_a_sentence_says_where_that_is() {
    let globe: Vec<f64> = (0..36).map(|n| 5.0 + 10.0 * f64::from(n)).collect();
    let samples: Vec<f64> = (0..108).map(f64::from).collect();
    let file = Classic::grid(&globe, &LAT, 3, samples);
    let part = read_window(&file, [-15.0, 51.2, 12.0, 51.3]).unwrap();
    assert_eq!(sides(&part), [-30.0, 50.0, 30.0, 53.0]);
    assert_eq!(part.raster.values()[..6], [33.0, 34.0, 35.0, 0.0, 1.0, 2.0]);
    assert_eq!(part.raster.get(3, 2), 72.0);
    // Of a document in a plane, the window in degrees counts.
    let projection: Projection = "+proj=merc +lon_0=0 +ellps=WGS84 +units=m".parse().unwrap();
    let corner = |x, y| projection.plane_from_geographic(dvec2(x, y));
    let area = Rect::new(corner(-14.0, 51.3), corner(11.0, 51.4));
    let window = GridWindow { area, plane: Some(projection.into()) };
    let mut place = GridPlace { over: None, window: Some(window) };
    let read = |place: &GridPlace| decode(Cursor::new(file.bytes()), None, place, &Meter::default()).unwrap();
    assert_eq!(read(&place), part);
    // All of it lies where a recipe says.
    place.over = Some(Rect::UNIT);
    assert_eq!((read(&place).raster.bounds(), read(&place).raster.size()), (Rect::UNIT, [36, 3]));
    let outside = read_window(&file, [0.0, -20.0, 10.0, -10.0]).unwrap_err().to_string();
    assert!(
        outside.contains("from 50 to 53 in y, and the domain from 0 to 10 and from -20 to -10"),
        "{outside}"
    );
}

#[test]
fn a_grid_that_is_too_large_is_refused_before_memory_is_taken() {
    let mut file = sample();
    for (variable, count) in file.variables[..2].iter_mut().zip([43_200, 86_400]) {
        variable.samples = (0..count).map(f64::from).collect();
    }
    file.dimensions = vec![("lat", 43_200), ("lon", 86_400)];
    let whole = said(&file);
    assert!(whole.starts_with("86,400 × 43,200 pixels of the grid cannot be read"), "{whole}");
    assert!(
        whole.contains("65,536 along each side, and 200,000,000 in all. Choose a domain first"),
        "{whole}"
    );
    let half = read_window(&file, [0.0, 0.0, 50_000.0, 30_000.0]).unwrap_err().to_string();
    assert!(half.contains("pixels of the grid in the domain cannot be read"), "{half}");
    // The file says more pixels than it has.
    assert!(read_window(&file, [0.0, 0.0, 10_000.0, 10_000.0]).unwrap_err().to_string().contains("cut off"));
}

#[test]
fn histories_may_be_long_and_names_in_any_encoding() {
    let history: &'static str = "ncks -O in.nc out.nc\n".repeat(5_000).leak();
    let mut file = sample().with("history", Of::Text(history));
    file.z().name = "höhe";
    let mut bytes = file.bytes();
    let at = bytes.windows(2).position(|pair| pair == "ö".as_bytes()).unwrap();
    bytes[at..at + 2].copy_from_slice(b"\xf6\x7f");
    let grid = decode(Cursor::new(bytes), None, &GridPlace::default(), &Meter::default()).unwrap();
    assert_eq!(grid.raster.values(), values(&counted()));
}

#[test]
fn every_cut_and_every_changed_byte_gives_a_result_or_a_sentence() {
    let mut file = sample().with("_FillValue", Of::Numbers(5, vec![3.0]));
    file.record = Some(0);
    for version in [1, 2, 5] {
        file.version = version;
        let whole = file.bytes();
        let tried = |bytes: &[u8]| {
            decode(Cursor::new(bytes.to_vec()), None, &GridPlace::default(), &Meter::default())
        };
        for end in 0..whole.len() {
            assert!(tried(&whole[..end]).is_err(), "cut at {end}");
        }
        let mut changed = whole.clone();
        for at in 0..whole.len() {
            for byte in [0, 1, 2, 0x7f, 0x80, 0xff, whole[at] ^ 1] {
                changed[at] = byte;
                if let Err(flaw) = tried(&changed) {
                    let sentence = flaw.to_string();
                    assert!(sentence.ends_with('.') && sentence.len() < 500, "{sentence}");
                }
            }
            changed[at] = whole[at];
        }
    }
}
