//! `--parts-for`: the parts are even and compact, and the edges between them are counted from the files alone.

use std::collections::HashMap;

use crate::folder::Folder;

const MESH: &str = "--spacing 0.25 --target 0.02+0.3*abs(hypot(x-0.5,y-0.5)-0.3)";

fn numbers(line: &str) -> Vec<usize> {
    line.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

/// Returns the cells of a file of SCHISM or ADCIRC, and of each its middle.
fn cells(folder: &Folder, name: &str) -> (Vec<Vec<usize>>, Vec<[f64; 2]>) {
    let text = folder.read(name);
    let counts = numbers(text.lines().nth(1).unwrap());
    let place = |line: &str| -> Vec<f64> {
        line.split_whitespace().skip(1).take(2).map(|word| word.parse().unwrap()).collect()
    };
    let nodes: Vec<Vec<f64>> = text.lines().skip(2).take(counts[1]).map(place).collect();
    let rows = text.lines().skip(2 + counts[1]).take(counts[0]).map(numbers);
    let cells: Vec<Vec<usize>> = rows.map(|row| row[2..].iter().map(|node| node - 1).collect()).collect();
    let middle = |cell: &Vec<usize>| {
        [0, 1].map(|axis| cell.iter().map(|&node| nodes[node][axis]).sum::<f64>() / cell.len() as f64)
    };
    let middles = cells.iter().map(middle).collect();
    (cells, middles)
}

/// Returns the smallest and largest part, and the edges between two parts.
fn figures(cells: &[Vec<usize>], owners: &[usize], parts: usize) -> [usize; 3] {
    assert_eq!(cells.len(), owners.len());
    let mut counts = vec![0; parts];
    owners.iter().for_each(|&owner| counts[owner] += 1);
    let (mut sides, mut cut): (HashMap<[usize; 2], usize>, _) = (HashMap::new(), 0);
    for (cell, &owner) in cells.iter().zip(owners) {
        for k in 0..cell.len() {
            let (from, to) = (cell[k], cell[(k + 1) % cell.len()]);
            match sides.insert([from.min(to), from.max(to)], owner) {
                Some(other) if other != owner => cut += 1,
                _ => {}
            }
        }
    }
    [*counts.iter().min().unwrap(), *counts.iter().max().unwrap(), cut]
}

#[test]
fn parts_are_even_and_their_cut_edges_are_counted() {
    let folder = Folder::new("partition");
    for (cells_option, parts) in [("triangles", 7), ("squares", 7), ("triangles", 64)] {
        let summary =
            folder.json("mesh", format!("{MESH} -o sea.gr3 --cells {cells_option} --parts-for {parts}"));
        let (cells, middles) = cells(&folder, "sea.gr3");
        let text = folder.read("partition.prop");
        let rows: Vec<Vec<usize>> = text.lines().map(numbers).collect();
        assert!(
            rows.iter().zip(1..).all(|(row, number)| row.len() == 2 && row[0] == number),
            "as SCHISM reads"
        );
        let owners: Vec<usize> = rows.iter().map(|row| row[1]).collect();
        let [smallest, largest, cut] = figures(&cells, &owners, parts);
        assert!(largest - smallest <= 1, "{smallest} to {largest}");
        let told = &summary["partition"];
        for (key, value) in
            [("parts", parts), ("smallest", smallest), ("largest", largest), ("cut_edges", cut)]
        {
            assert_eq!(told[key], value, "{key}, {cells_option}");
        }
        assert_eq!(told["file"], "partition.prop");
        // A square of triangles with as many of them has four sides of √(cells of a part).
        let compact = 2.0 * parts as f64 * (cells.len() as f64 / parts as f64).sqrt();
        assert!((cut as f64) < 0.8 * compact, "{cut}, and {compact} for squares");
        // Each part is near its middle.
        for part in [0, parts - 1] {
            let own: Vec<[f64; 2]> =
                (0..cells.len()).filter(|&cell| owners[cell] == part).map(|cell| middles[cell]).collect();
            let width = [0, 1].map(|axis| {
                let values = || own.iter().map(|p| p[axis]);
                values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
            });
            assert!(width[0] * width[1] < 0.7, "{width:?}");
        }
    }
}

#[test]
fn other_formats_have_a_file_as_metis_writes_it() {
    let folder = Folder::new("partition-metis");
    let ran = folder.run(format!("mesh {MESH} -o sea.14 -o sea.nc -o sea.png --size 100 --parts-for 4"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    assert!(ran.err.contains("wrote sea.14.part.4: 4 parts of "), "{}", ran.err);
    let owners =
        |name: &str| folder.read(name).lines().map(|line| line.parse().unwrap()).collect::<Vec<usize>>();
    let (cells, _) = cells(&folder, "sea.14");
    let [smallest, largest, _] = figures(&cells, &owners("sea.14.part.4"), 4);
    assert!(largest - smallest <= 1);
    // Delft3D-FM gets squares: fewer cells.
    assert!(owners("sea.nc.part.4").len() < cells.len());
    // UGRID has the same numbers in a variable: whole numbers of four bytes, the highest first.
    let bytes = folder.bytes("sea.nc");
    let row: Vec<u8> = owners("sea.nc.part.4")
        .iter()
        .flat_map(|&owner| u32::try_from(owner).unwrap().to_be_bytes())
        .collect();
    let has = |part: &[u8]| bytes.windows(part.len()).any(|window| window == part);
    assert!(has(b"idomain") && has(&row));
    let undivided = folder.run(format!("mesh {MESH} -o sea.nc"));
    assert!(undivided.err.contains(" are too short for Delft3D-FM, "), "{}", undivided.err);
    let bytes = folder.bytes("sea.nc");
    assert!(!bytes.windows(7).any(|window| window == b"idomain"));
    let other = folder.run(format!("mesh {MESH} -o sea.disv"));
    assert!(other.err.contains(" are shorter than 0.09 of the width of their cells, "), "{}", other.err);
    assert!(!folder.has("sea.png.part.4"));
    for (options, sentence) in [
        ("--parts-for 0", "0 is not in 1.."),
        ("-o sea.14 --parts-for 5000000", "5000000 parts cannot be made of "),
        ("-o sea.14 --parts-for 4 --sequence 2", "--parts-for 4: it is for one mesh"),
        ("-o - --format gr3 --parts-for 4", "--parts-for 4: its file stands beside that of the mesh"),
    ] {
        let code = if options.contains("5000000") { 1 } else { 2 };
        let ran = folder.run(format!("mesh {MESH} {options}"));
        assert!(ran.status == code && ran.err.contains(sentence), "{options}: {}", ran.err);
    }
}
