//! Quantities beside the depth: the attributes of ADCIRC, the variables of TELEMAC.

use std::fs;
use std::path::Path;

use glam::dvec2;
use meshbrush_io::io::{MeshFormat, Meter, NodeValues, fort13, fort14, selafin};

use super::{Case, Seen, cases, frame, read_grid};

/// What a SELAFIN file has.
pub struct Selafin {
    pub seen: Seen,
    /// IPOBO.
    pub places: Vec<i32>,
    pub title: String,
    /// The variables after the ground, by their names.
    pub further: Vec<(String, Vec<f64>)>,
}

/// Reads the records of a SELAFIN file.
pub fn read_selafin(file: &[u8]) -> Selafin {
    let (mut records, mut at) = (Vec::new(), 0);
    let length = |at: usize| i32::from_be_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    while at < file.len() {
        let bytes = length(at);
        records.push(&file[at + 4..at + 4 + bytes]);
        assert_eq!(length(at + 4 + bytes), bytes, "the lengths before and after a record");
        at += 8 + bytes;
    }
    let ints = |record: &[u8]| -> Vec<i32> {
        record.chunks(4).map(|b| i32::from_be_bytes(b.try_into().unwrap())).collect()
    };
    let reals = |record: &[u8]| -> Vec<f64> {
        record.chunks(8).map(|b| f64::from_be_bytes(b.try_into().unwrap())).collect()
    };
    let count = ints(records[1])[0] as usize;
    let names = &records[2..2 + count];
    let [parameters, sizes, corners, places, x, y, time, ref values @ ..] = records[2 + count..] else {
        panic!("{} records", records.len())
    };
    let [title, variables] = [records[0], records[1]];
    assert_eq!(values.len(), count);
    assert_eq!((title.len(), &title[72..]), (80, &b"SERAFIND"[..]));
    assert_eq!(
        (ints(variables), ints(parameters)),
        (vec![count as i32, 0], vec![1, 0, 0, 0, 0, 0, 0, 0, 0, 0])
    );
    assert_eq!(std::str::from_utf8(names[0]).unwrap(), format!("{:16}{:16}", "BOTTOM", "M"));
    let corners: Vec<usize> = ints(corners).into_iter().map(|node| node as usize - 1).collect();
    let seen = Seen {
        nodes: reals(x).into_iter().zip(reals(y)).map(|(x, y)| dvec2(x, y)).collect(),
        depths: reals(values[0]).into_iter().map(|z| -z).collect(),
        triangles: corners.chunks(3).map(|corners| corners.try_into().unwrap()).collect(),
    };
    assert_eq!(ints(sizes), [seen.triangles.len() as i32, seen.nodes.len() as i32, 3, 1]);
    assert_eq!(reals(time), [0.0]);
    let name = |record: &&[u8]| std::str::from_utf8(record).unwrap().trim_end().to_owned();
    let further = names.iter().map(name).zip(values.iter().map(|record| reals(record))).skip(1).collect();
    Selafin { seen, places: ints(places), title: String::from_utf8(title[..72].to_vec()).unwrap(), further }
}

/// Returns the attributes of a `fort.13` with the values of all nodes, as ADCIRC reads them.
fn read_attributes(text: &str, nodes: usize) -> Vec<(String, Vec<f64>)> {
    let mut lines = text.lines().skip(1);
    let mut line = || lines.next().unwrap();
    assert_eq!(line().parse::<usize>().unwrap(), nodes);
    let count: usize = line().parse().unwrap();
    let mut heads = Vec::new();
    for _ in 0..count {
        let (name, unit, columns, default) = (line(), line(), line(), line());
        assert_eq!((unit, columns), ("1", "1"));
        heads.push((name.to_owned(), default.parse::<f64>().unwrap()));
    }
    let mut found = Vec::new();
    for (name, default) in heads {
        assert_eq!(line(), name);
        let (mut values, listed) = (vec![default; nodes], line().parse::<usize>().unwrap());
        let mut last = 0;
        for _ in 0..listed {
            let (node, value) = line().split_once(' ').unwrap();
            let (node, value) = (node.parse::<usize>().unwrap(), value.parse::<f64>().unwrap());
            assert!(node > last && value != default, "each node once, in order");
            (values[node - 1], last) = (value, node);
        }
        // No value is more common than the default.
        let times = |value: f64| values.iter().filter(|other| **other == value).count();
        assert!(values.iter().all(|value| times(*value) <= times(default)));
        found.push((name, values));
    }
    assert_eq!(lines.next(), None);
    found
}

/// A case with Manning's n of three values, and a number of its own for each node.
fn with_friction(mut case: Case) -> Case {
    let nodes = case.extract.nodes().len();
    let manning = (0..nodes).map(|node| [0.02, 0.035, 0.035, 0.1][node % 4]).collect();
    let wind = (0..nodes).map(|node| 1.0 / (3.0 + node as f64)).collect();
    case.quantities.push(NodeValues { name: "manning".into(), values: manning });
    case.quantities.push(NodeValues { name: "wind_reduction_factor".into(), values: wind });
    case.quantities.push(NodeValues { name: "surface".into(), values: vec![2.0; nodes] });
    case
}

/// The quantities that are neither the depth nor the surface, under the names that a solver has for them.
fn expected(case: &Case, name_of: impl Fn(&str) -> String) -> Vec<(String, Vec<f64>)> {
    let further = case.quantities.iter().filter(|of| of.name != "depth" && of.name != "surface");
    further.map(|of| (name_of(&of.name), of.values.clone())).collect()
}

#[test]
fn adcirc_has_the_other_quantities_as_attributes_beside_the_mesh() {
    for case in cases().into_iter().chain([frame()]).map(with_friction) {
        let text = case.text(fort13::write);
        let name =
            |own: &str| if own == "manning" { "mannings_n_at_sea_floor".to_owned() } else { own.to_owned() };
        assert_eq!(read_attributes(&text, case.extract.nodes().len()), expected(&case, name));
        let (seen, ..) = read_grid(&case.text(fort14::write));
        assert_eq!((seen, text.lines().next()), (case.expected(), case.text(fort14::write).lines().next()));
    }
}

#[test]
fn the_file_of_attributes_is_there_only_where_there_are_some() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("attributes");
    let _ = fs::remove_dir_all(&folder); // absent at the first run
    fs::create_dir_all(&folder).unwrap();
    let format = MeshFormat::named("fort14").unwrap();
    let (mut case, path, meter) = (with_friction(frame()), folder.join("sea.14"), Meter::default());
    let files = format.write(&path, &case.extract, &case.data(), &meter).unwrap();
    assert_eq!(files, [path.clone(), folder.join("sea.13")]);
    let bytes: u64 = files.iter().map(|file| fs::metadata(file).unwrap().len()).sum();
    assert_eq!(format.exact_bytes(&case.extract, &case.data(), &meter).unwrap(), bytes);
    case.quantities.retain(|quantity| quantity.name == "surface");
    assert_eq!(format.write(&path, &case.extract, &case.data(), &meter).unwrap(), [path]);
}

#[test]
fn telemac_has_the_other_quantities_as_variables() {
    for case in cases().into_iter().chain([frame()]).map(with_friction) {
        let Selafin { seen, further, .. } = read_selafin(&case.written(selafin::write));
        assert_eq!(seen, case.expected());
        let name = |own: &str| match own {
            "manning" => "BOTTOM FRICTION".to_owned(),
            "wind_reduction_factor" => "WIND REDUCTION F".to_owned(),
            own => own.to_uppercase(),
        };
        assert_eq!(further, expected(&case, name));
    }
    let mut case = with_friction(frame());
    case.quantities[0].name = "wind_reduction_for_ships".into();
    let error = case.refused(selafin::write);
    assert!(error.contains("the quantity wind_reduction_factor would be WIND REDUCTION F there"), "{error}");
}
