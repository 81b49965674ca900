//! The same data in different formats of files give the same mesh.

use crate::folder::Folder;

const HEADER: &str = "ncols 2\nnrows 2\nxllcorner 4\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
const VALUES: [f32; 4] = [-9999.0, 0.5, -9999.0, 0.125];

/// Returns an uncompressed TIFF file of the values, placed by its tags or not.
fn tiff(is_placed: bool) -> Vec<u8> {
    let doubles: Vec<u8> =
        [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 4.0, 2.0, 0.0].iter().flat_map(|n: &f64| n.to_le_bytes()).collect();
    let data: Vec<u8> =
        VALUES.iter().flat_map(|value| value.to_le_bytes()).chain(*b"-9999\0\0\0").chain(doubles).collect();
    let mut entries: Vec<[u32; 4]> = vec![
        [256, 3, 1, 2],
        [257, 3, 1, 2],
        [258, 3, 1, 32],
        [262, 3, 1, 1],
        [273, 4, 1, 8],
        [278, 3, 1, 2],
        [279, 4, 1, 16],
        [339, 3, 1, 3],
    ];
    if is_placed {
        entries.extend([[33550, 12, 3, 32], [33922, 12, 6, 56]]);
    }
    entries.push([42113, 2, 6, 24]);
    let mut bytes = [b"II\x2a\0", &(8 + data.len() as u32).to_le_bytes()[..], &data].concat();
    bytes.extend((entries.len() as u16).to_le_bytes());
    for [tag, kind, count, value] in entries {
        bytes.extend([(tag as u16).to_le_bytes(), (kind as u16).to_le_bytes()].concat());
        bytes.extend([count.to_le_bytes(), value.to_le_bytes()].concat());
    }
    bytes.extend([0; 4]);
    bytes
}

/// Returns a classic NetCDF file of the values, the top row first, and of another grid `b`.
fn netcdf() -> Vec<u8> {
    let words = |list: &[u32]| list.iter().flat_map(|number| number.to_be_bytes()).collect::<Vec<u8>>();
    let name = |name: u8| [vec![0, 0, 0, 1], vec![name, 0, 0, 0]].concat();
    let side = |axis: u8| [name(axis), words(&[2])].concat();
    let header =
        [b"CDF\x01\0\0\0\0".to_vec(), words(&[10, 2]), side(b'y'), side(b'x'), words(&[0, 0, 11, 4])];
    let mut bytes = header.concat();
    let fill =
        [words(&[12, 1, 10]), b"_FillValue\0\0".to_vec(), words(&[5, 1]), (-9999f32).to_be_bytes().to_vec()];
    let (fill, none) = (fill.concat(), words(&[0, 0]));
    let mut begin = 300;
    for (axis, dimensions, attributes, [kind, size]) in [
        (b'y', &[1, 0][..], &none, [6, 16]),
        (b'x', &[1, 1], &none, [6, 16]),
        (b'z', &[2, 0, 1], &fill, [5, 16]),
        (b'b', &[2, 0, 1], &none, [5, 16]),
    ] {
        bytes.extend(
            [name(axis), words(dimensions), attributes.clone(), words(&[kind, size, begin])].concat(),
        );
        begin += size;
    }
    bytes.resize(300, 0);
    bytes.extend([1.5f64, 0.5, 4.5, 5.5].iter().flat_map(|number| number.to_be_bytes()));
    bytes.extend(VALUES.iter().chain(&[7.0; 4]).flat_map(|value| value.to_be_bytes()));
    bytes
}

#[test]
fn a_grid_is_the_same_in_every_format() {
    let folder = Folder::new("formats-grids");
    folder.file("a.asc", format!("{HEADER}-9999 0.5\n-9999 0.125\n"));
    folder.file("a.tif", tiff(true));
    folder.file("beside.tiff", tiff(false));
    folder.file("beside.tfw", "1\n0\n0\n-1\n4.5\n1.5\n");
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }";
    let values = VALUES.map(|value| if value < 0.0 { f32::NAN } else { value });
    let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    folder.file(
        "a.npy",
        [b"\x93NUMPY\x01\0", &[header.len() as u8, 0][..], header.as_bytes(), &values].concat(),
    );
    folder.file("a.nc", netcdf());
    folder.file("b.grd", netcdf());
    let mesh = |options: &str| folder.json("mesh", format!("--spacing 1 --target-raster {options}"));
    let expected = mesh("a.asc");
    assert_eq!(expected["max_level"], 7);
    // An array says no place, and covers the domain.
    for options in ["a.tif", "beside.tiff", "a.nc", "a.nc#z", "b.grd", "a.npy --domain 4,0,6,2"] {
        assert_eq!(mesh(options)["hash"], expected["hash"], "{options}");
    }
    folder.file("nowhere.tif", tiff(false));
    let ran = folder.run("mesh --target-raster nowhere.tif --domain 4,0,6,2");
    assert!(
        ran.err.contains("nowhere.tif: the file does not say where it lies. Put a world file"),
        "{}",
        ran.err
    );
    // A recipe may say the place of any raster.
    for file in ["nowhere.tif", "a.npy", "a.nc#z"] {
        let layer = format!("kind = \"raster\"\nfile = \"{file}\"\nas = \"diameter\"\nbounds = [4, 0, 6, 2]");
        folder.file(
            "r.toml",
            format!("[domain]\nbounds = [4, 0, 6, 2]\n[mesh]\nspacing = 1\n[[layer]]\n{layer}\n"),
        );
        assert_eq!(folder.json("mesh", "r.toml")["hash"], expected["hash"], "{file}");
    }
}

/// Returns a shapefile of one polygon whose rings are closed; the outer one runs clockwise.
fn shapefile(rings: &[Vec<[f64; 2]>]) -> Vec<u8> {
    let count: usize = rings.iter().map(Vec::len).sum();
    let starts = rings.iter().scan(0, |next, ring| Some(std::mem::replace(next, *next + ring.len() as i32)));
    let numbers: Vec<i32> = [rings.len() as i32, count as i32].into_iter().chain(starts).collect();
    let points = rings.iter().flatten().flatten().flat_map(|number| number.to_le_bytes());
    let content = 5i32.to_le_bytes().into_iter().chain([0; 32]);
    let content: Vec<u8> =
        content.chain(numbers.into_iter().flat_map(i32::to_le_bytes)).chain(points).collect();
    let mut bytes = vec![0; 100];
    bytes[..4].copy_from_slice(&9994i32.to_be_bytes());
    bytes[24..28].copy_from_slice(&((108 + content.len() as i32) / 2).to_be_bytes());
    let record = [1, content.len() as i32 / 2].map(i32::to_be_bytes).concat();
    [bytes, record, content].concat()
}

#[test]
fn polygons_are_the_same_in_every_format() {
    let folder = Folder::new("formats-polygons");
    let square = |low: f64, high: f64| vec![[low, low], [low, high], [high, high], [high, low], [low, low]];
    let hole: Vec<[f64; 2]> = square(1.0, 2.0).into_iter().rev().collect();
    folder.file("a.shp", shapefile(&[square(0.0, 4.0), hole.clone()]));
    let rings = format!("{:?}", [square(0.0, 4.0), hole]);
    folder.file("a.geojson", format!("{{\"type\":\"Polygon\",\"coordinates\":{rings}}}"));
    let hash = |options: String| folder.json("mesh", options)["hash"].clone();
    let of = |ending: &str| {
        [
            hash(format!("--region a.{ending} --spacing 1")),
            hash(format!("--domain -1,-1,5,5 --spacing 1 --distance a.{ending} --distance-at-zero 0.25")),
        ]
    };
    assert_eq!(of("shp"), of("geojson"));
}
