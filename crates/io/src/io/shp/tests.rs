use std::fs;

use super::*;
use meshbrush_mesh::text::LengthUnit;

/// Returns a shapefile of records, each with its content.
fn file(records: &[Vec<u8>]) -> Vec<u8> {
    let length = HEADER as usize + records.iter().map(|record| 8 + record.len()).sum::<usize>();
    let mut bytes = vec![0; HEADER as usize];
    bytes[..4].copy_from_slice(&FILE_CODE.to_be_bytes());
    bytes[24..28].copy_from_slice(&(length as i32 / 2).to_be_bytes());
    bytes[28..32].copy_from_slice(&1000i32.to_le_bytes());
    for (number, record) in records.iter().enumerate() {
        bytes.extend((number as i32 + 1).to_be_bytes());
        bytes.extend((record.len() as i32 / 2).to_be_bytes());
        bytes.extend(record);
    }
    bytes
}

fn coordinates_of(points: &[[f64; 2]]) -> Vec<u8> {
    points.iter().flatten().flat_map(|number| number.to_le_bytes()).collect()
}

/// Heights and measures, which are left out.
fn extra(kind: i32, count: usize) -> Vec<u8> {
    vec![0x55; if kind > 10 { 8 * count } else { 0 }]
}

fn point(kind: i32, at: [f64; 2]) -> Vec<u8> {
    [kind.to_le_bytes().to_vec(), coordinates_of(&[at]), extra(kind, 1)].concat()
}

fn points(kind: i32, list: &[[f64; 2]]) -> Vec<u8> {
    let count = (list.len() as i32).to_le_bytes();
    [&kind.to_le_bytes()[..], &[0; 32], &count, &coordinates_of(list), &extra(kind, list.len())].concat()
}

fn parts(kind: i32, lists: &[&[[f64; 2]]]) -> Vec<u8> {
    let count: usize = lists.iter().map(|list| list.len()).sum();
    let starts =
        lists.iter().scan(0, |start, list| Some(std::mem::replace(start, *start + list.len() as i32)));
    let starts: Vec<u8> = starts.flat_map(i32::to_le_bytes).collect();
    let counts = [lists.len() as i32, count as i32].map(i32::to_le_bytes).concat();
    let all = coordinates_of(&lists.concat());
    [&kind.to_le_bytes()[..], &[0; 32], &counts, &starts, &all, &extra(kind, count)].concat()
}

/// A closed ring around a square, clockwise or not.
fn square(low: f64, high: f64, is_clockwise: bool) -> Vec<[f64; 2]> {
    let mut ring = vec![[low, low], [low, high], [high, high], [high, low], [low, low]];
    if !is_clockwise {
        ring.reverse();
    }
    ring
}

fn parsed(records: &[Vec<u8>]) -> ShapeList {
    parse(&*file(records), None).unwrap()
}

fn said(bytes: &[u8]) -> String {
    read_from(bytes, Path::new("a.shp")).unwrap_err().to_string()
}

#[test]
fn every_type_is_read_with_heights_and_without() {
    for more in [0, 10, 20] {
        let shapes = parsed(&[
            point(1 + more, [1.0, 2.0]),
            0i32.to_le_bytes().to_vec(),
            points(8 + more, &[[3.0, 4.0], [5.0, 6.0]]),
            parts(3 + more, &[&[[0.0, 0.0], [1.0, 1.5]], &[[2.0, 0.0], [3.0, 0.0], [4.0, -0.5]]]),
            parts(5 + more, &[&square(0.0, 4.0, true), &square(1.0, 2.0, false)]),
        ]);
        assert_eq!(shapes.points, [dvec2(1.0, 2.0), dvec2(3.0, 4.0), dvec2(5.0, 6.0)]);
        let [first, second] = &shapes.lines[..] else { panic!("{:?}", shapes.lines) };
        assert_eq!((first[1], second.len(), second[2]), (dvec2(1.0, 1.5), 3, dvec2(4.0, -0.5)));
        let [polygon] = &shapes.polygons[..] else { panic!("{:?}", shapes.polygons) };
        let corners: Vec<usize> = polygon.iter().map(Vec::len).collect();
        assert_eq!((corners, polygon[1][2]), (vec![4, 4], dvec2(2.0, 2.0)));
    }
}

#[test]
fn holes_belong_to_the_smallest_ring_around_them() {
    let rings = [
        square(0.0, 100.0, true),
        square(10.0, 90.0, false),
        square(20.0, 80.0, true),
        square(30.0, 40.0, false),
        square(200.0, 201.0, true),
        square(300.0, 301.0, false),
        square(80.0, 80.0, true),
    ];
    let rings: Vec<&[[f64; 2]]> = rings.iter().map(Vec::as_slice).collect();
    let polygons = parsed(&[parts(5, &rings)]).polygons;
    let starts: Vec<Vec<f64>> =
        polygons.iter().map(|rings| rings.iter().map(|ring| bounds(ring).min.x).collect()).collect();
    assert_eq!(starts, [vec![0.0, 10.0], vec![20.0, 30.0], vec![200.0], vec![300.0], vec![80.0]]);
}

/// As other programs write them: turned, all in one direction, a hole before its ring, parts that touch.
#[test]
fn rings_are_what_they_are_around_whichever_way_they_run() {
    let area = |rings: &[(f64, f64, bool)]| -> f64 {
        let rings: Vec<Vec<[f64; 2]>> =
            rings.iter().map(|&(low, high, is_clockwise)| square(low, high, is_clockwise)).collect();
        let rings: Vec<&[[f64; 2]]> = rings.iter().map(Vec::as_slice).collect();
        let polygons = parsed(&[parts(5, &rings)]).polygons;
        let size = |ring: &Ring| signed_area(ring).abs();
        polygons.iter().map(|rings| size(&rings[0]) - rings[1..].iter().map(size).sum::<f64>()).sum()
    };
    for ways in 0..16 {
        let way = |n: u32| ways >> n & 1 == 1;
        let (sea, isle, other, pond) =
            ((0.0, 100.0, way(0)), (10.0, 20.0, way(1)), (40.0, 80.0, way(2)), (50.0, 60.0, way(3)));
        for rings in [[sea, isle, other, pond], [pond, other, isle, sea], [isle, sea, pond, other]] {
            assert_eq!(area(&rings), 1e4 - 100.0 - 1600.0 + 100.0, "{rings:?}");
        }
        assert_eq!(area(&[sea, (100.0, 130.0, way(1)), (0.0, 20.0, way(2))]), 1e4 + 900.0 - 400.0, "{ways}");
    }
}

#[test]
fn the_text_beside_a_file_tells_the_unit() {
    let folder = std::env::temp_dir().join(format!("meshbrush-shp-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("coast.shp");
    fs::write(&path, file(&[parts(5, &[&square(0.0, 4.0, true)])])).unwrap();
    let meter = Meter::default();
    let outline = read_outline(&path, &meter).unwrap();
    assert_eq!((outline.polygons.len(), outline.coordinates.unit()), (1, LengthUnit::Degree));
    assert_eq!((meter.total(), CoordinateSystem::beside(&path)), (Some(meter.done()), None));
    fs::write(folder.join("coast.prj"), r#"PROJCS["UTM",GEOGCS["WGS 84"],UNIT["metre",1]]"#).unwrap();
    assert_eq!(read_outline(&path, &meter).unwrap().coordinates.unit(), LengthUnit::Metre);
    assert_eq!(read(&path, &meter).unwrap().coordinates.unit(), LengthUnit::Metre);
    fs::write(&path, file(&[point(1, [0.0; 2])])).unwrap();
    let sentence = read_outline(&path, &meter).unwrap_err().to_string();
    assert!(sentence.contains("a domain needs a Polygon") && sentence.contains("it has Point"), "{sentence}");
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn broken_records_are_refused_with_a_sentence() {
    let mut reversed = parts(3, &[&square(0.0, 1.0, true), &square(0.0, 1.0, true)]);
    reversed[48..52].copy_from_slice(&(-5i32).to_le_bytes());
    let mut huge = parts(5, &[&square(0.0, 1.0, true)]);
    huge[36..44].copy_from_slice(&[0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f]);
    let mut many = points(8, &[[0.0; 2]]);
    many[36..40].copy_from_slice(&i32::MAX.to_le_bytes());
    for (record, says) in [
        (vec![1, 0], "record 1 is too short"),
        (31i32.to_le_bytes().to_vec(), "MultiPatch"),
        (99i32.to_le_bytes().to_vec(), "unknown type 99"),
        (point(1, [f64::NAN, 0.0]), "not finite"),
        (parts(3, &[&[[0.0; 2]]]), "a line with one point"),
        (reversed, "has -5 points"),
        (huge, "announces 2,147,483,647 points"),
        (many, "announces 2,147,483,647 points"),
    ] {
        let sentence = said(&file(&[record]));
        assert!(sentence.contains(says) && sentence.ends_with('.'), "{sentence}");
    }
    assert!(said(&file(&[])).contains("there is no point, line or polygon"));
    assert!(said(&[0; 100]).contains("not a shapefile"));
    let mut endless = file(&[point(1, [0.0; 2])]);
    endless[24..28].copy_from_slice(&i32::MAX.to_be_bytes());
    assert!(said(&endless).contains("ends too early"));
}

#[test]
fn every_cut_is_an_error() {
    let whole =
        file(&[point(1, [1.0, 2.0]), parts(15, &[&square(0.0, 4.0, true), &square(1.0, 2.0, false)])]);
    for end in 0..whole.len() {
        assert!(read_from(&whole[..end], Path::new("a.shp")).is_err(), "cut at {end}");
    }
}

#[test]
fn only_what_can_meet_a_rectangle_is_read() {
    let with_extent = |kind: i32, ring: &[[f64; 2]]| {
        let mut record = parts(kind, &[ring]);
        let extent = bounds(&ring.iter().map(|&at| at.into()).collect::<Vec<DVec2>>());
        record[4..36].copy_from_slice(&coordinates_of(&[extent.min.into(), extent.max.into()]));
        record
    };
    let west = [[-179.5, 0.0], [-179.0, 0.0], [-179.0, 1.0], [-179.5, 0.0]];
    let records = [
        with_extent(5, &square(1.0, 2.0, true)),
        with_extent(3, &square(5.0, 6.0, true)),
        with_extent(15, &west),
        points(8, &[[100.0, 50.0]]),
    ];
    let near = |west: f64, east: f64| {
        let read = parse(&*file(&records), Some(Rect::new(dvec2(west, 0.0), dvec2(east, 9.0)))).unwrap();
        [read.polygons.len(), read.lines.len(), read.points.len()]
    };
    assert_eq!(near(0.0, 3.0), [1, 0, 1]);
    assert_eq!(near(4.0, 7.0), [0, 1, 1]);
    assert_eq!(near(170.0, 190.0), [1, 0, 1], "after a whole turn");
    let cut = &file(&records)[..300];
    let error = parse(cut, Some(Rect::new(dvec2(50.0, 50.0), dvec2(51.0, 51.0)))).unwrap_err();
    assert!(matches!(error.flaw, Flaw::CutOff), "{error:?}");
}
