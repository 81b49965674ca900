//! Values at the nodes from grids, against means that look at every triangle for every pixel.

use std::collections::BTreeMap;

use crate::folder::Folder;

/// The corner of a grid: no centre of a pixel is on an edge, or as near to one corner of a triangle as to
/// another.
const WEST: f64 = -2.007;
const SOUTH: f64 = -2.013;
/// Columns, rows, and the side of a pixel.
const COLUMNS: usize = 88;
const ROWS: usize = 68;
const PIXEL: f64 = 0.5;
/// The class of pixels without a value.
const NONE: i32 = -9999;
/// Classes of land cover and their values.
const CLASSES: &str = "class,manning,remark\n11,0.02,water\n41,0.1,forest\n81,0.035,pasture\n";

fn value_of(class: i32) -> Option<f64> {
    [(11, 0.02), (41, 0.1), (81, 0.035)]
        .into_iter()
        .find(|&(known, _)| known == class)
        .map(|(_, value)| value)
}

/// Stripes of classes, of which 99 is in no table, and a gap of eight columns.
fn class(column: usize, row: usize) -> i32 {
    match (column, (3 * column + 7 * row * row) % 11) {
        (50..58, _) => NONE,
        (_, 0..4) => 11,
        (_, 4..8) => 41,
        (_, 8) => 99,
        _ => 81,
    }
}

fn grid(value: impl Fn(usize, usize) -> i32) -> String {
    let head =
        format!("ncols {COLUMNS}\nnrows {ROWS}\nxllcorner {WEST}\nyllcorner {SOUTH}\ncellsize {PIXEL}\n");
    let row = |row| (0..COLUMNS).map(|column| format!("{} ", value(column, row))).collect::<String>() + "\n";
    head + &format!("NODATA_value {NONE}\n") + &(0..ROWS).rev().map(row).collect::<String>()
}

/// Nodes with their last attribute but the marker, and triangles, of Triangle's files.
fn read(folder: &Folder, name: &str) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let rows = |ending: &str| -> Vec<Vec<f64>> {
        let text = folder.read(&format!("{name}.{ending}"));
        let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
        lines.map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect()).collect()
    };
    let nodes = rows("node").iter().map(|row| [row[1], row[2], row[row.len() - 2]]).collect();
    let triangles = rows("ele").iter().map(|row| [1, 2, 3].map(|n| row[n] as usize - 1)).collect();
    (nodes, triangles)
}

/// Returns the weights of the corners at a point of a triangle.
fn weights(corners: [[f64; 3]; 3], [x, y]: [f64; 2]) -> [f64; 3] {
    let [[ax, ay, _], [bx, by, _], [cx, cy, _]] = corners;
    let whole = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    let b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / whole;
    let c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / whole;
    [1.0 - b - c, b, c]
}

#[test]
fn nodes_have_the_means_of_the_values_of_classes_in_their_cells() {
    let folder = Folder::new("quantity-grid");
    folder.file("cover.asc", grid(class));
    folder.file("n.csv", CLASSES);
    let options = "--domain 0,0,40,30 --spacing 6.2 --target 1.1+0.2*hypot(x-9,y-8) --quantity-grid manning=cover.asc \
                   --quantity-table manning=n.csv";
    let ran = folder.run(format!("mesh {options} -o sea.node"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    let (nodes, triangles) = read(&folder, "sea");
    let mut sums: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    let mut lacking = 0;
    for (column, row) in (0..COLUMNS).flat_map(|column| (0..ROWS).map(move |row| (column, row))) {
        let at = [(column, WEST), (row, SOUTH)].map(|(n, from)| (n as f64 + 0.5) * PIXEL + from);
        let half = 0.5 * PIXEL;
        let is_within = (-half..40.0 + half).contains(&at[0]) && (-half..30.0 + half).contains(&at[1]);
        lacking += usize::from(is_within && class(column, row) == 99);
        let Some(value) = value_of(class(column, row)) else { continue };
        for corners in &triangles {
            let parts = weights(corners.map(|node| nodes[node]), at);
            if parts.iter().all(|part| *part > 0.0) {
                let best = (0..3).max_by(|&a, &b| parts[a].total_cmp(&parts[b])).unwrap();
                let sum = sums.entry(corners[best]).or_default();
                *sum = (sum.0 + value, sum.1 + 1.0);
            }
        }
    }
    for (node, (sum, count)) in &sums {
        let [x, y, value] = nodes[*node];
        assert!((value - sum / count).abs() < 1e-12, "{x}, {y}: {value} {sum} {count}");
    }
    let with_pixels = sums.len();
    let alone = nodes.iter().enumerate().filter(|(node, _)| !sums.contains_key(node));
    for (_, [x, y, value]) in alone {
        // That of the pixel at the node, or of the nearest one.
        let [column, row] = [x - WEST, y - SOUTH].map(|at| (at / PIXEL) as usize);
        match value_of(class(column, row)) {
            Some(own) => assert_eq!(*value, own, "{x}, {y}"),
            None => assert!([0.02, 0.1, 0.035].contains(value), "{x}, {y}: {value}"),
        }
    }
    assert!(with_pixels > 100 && with_pixels < nodes.len(), "{with_pixels} of {}", nodes.len());
    let classes = format!("n.csv lacks 1 class of cover.asc (99): {lacking} pixels in the rectangle");
    assert!(ran.err.contains(&classes), "{classes}: {}", ran.err);
    assert!(
        ran.err.contains("nodes are where cover.asc has no value; they have that of the nearest"),
        "{}",
        ran.err
    );
    // A recipe says the same, and the file does not depend on the number of threads.
    folder.file(
        "sea.toml",
        "[domain]\nbounds = [0, 0, 40, 30]\n[mesh]\nspacing = 6.2\n[[layer]]\nkind = \"formula\"\nquantity = \
         \"diameter\"\nformula = \"1.1+0.2*hypot(x-9,y-8)\"\n[[output]]\nfile = \"recipe.node\"\ngrids = [{ name = \
         \"manning\", file = \"cover.asc\", table = \"n.csv\" }]\n",
    );
    let ran = folder.run("mesh sea.toml --threads 1");
    assert!(ran.status == 0 && ran.err.contains(&classes), "{}", ran.err);
    assert_eq!(read(&folder, "recipe"), (nodes, triangles));
}

#[test]
fn classes_are_not_mixed_where_a_grid_is_projected() {
    let folder = Folder::new("quantity-projected");
    folder.file("sea.geojson", r#"{"type":"Polygon","coordinates":[[[4,50],[6,50],[6,51],[4,51],[4,50]]]}"#);
    let row = |_| "1 ".repeat(105) + &"3 ".repeat(105) + "\n";
    let head = "ncols 210\nnrows 110\nxllcorner 3.95\nyllcorner 49.95\ncellsize 0.01\n";
    folder.file("cover.asc", head.to_owned() + &(0..110).map(row).collect::<String>());
    folder.file("n.csv", "1;0,02\n3;0,1\n");
    let options = "--region sea.geojson --projection auto --spacing 20000 --target 5000 -o sea.node";
    let ran = folder.run(format!("mesh {options} --quantity-grid n=cover.asc --quantity-table n=n.csv"));
    assert!(ran.status == 0 && !ran.err.contains("lacks"), "{}", ran.err);
    let (nodes, _) = read(&folder, "sea");
    let west = nodes.iter().filter(|[x, ..]| *x < 4.95).all(|[.., n]| *n == 0.02);
    let east = nodes.iter().filter(|[x, ..]| *x > 5.05).all(|[.., n]| *n == 0.1);
    assert!(west && east && nodes.iter().all(|[.., n]| (0.02..=0.1).contains(n)) && nodes.len() > 300);
    // A grid of values is linear between its pixels.
    folder.run(format!("mesh {options} --quantity-grid n=cover.asc"));
    let (nodes, _) = read(&folder, "sea");
    assert!(nodes.iter().all(|[x, _, n]| if *x < 4.95 { *n == 1.0 } else { *x <= 5.05 || *n == 3.0 }));
}

/// Returns the third numbers of the nodes of `.gr3`.
fn third_numbers(text: &str) -> Vec<f64> {
    let nodes: usize = text.lines().nth(1).unwrap().split(' ').nth(1).unwrap().parse().unwrap();
    text.lines().skip(2).take(nodes).map(|line| line.split(' ').nth(3).unwrap().parse().unwrap()).collect()
}

#[test]
fn schism_has_a_quantity_in_the_file_of_its_name() {
    let folder = Folder::new("quantity-schism");
    let mesh = "mesh --domain 0,0,4,3 --spacing 1 --quantity depth=5+x --quantity manning=0.02+y/100 --quantity drag=x*y";
    let ran = folder.run(format!("{mesh} -o hgrid.gr3 -o manning.gr3 -o drag.gr3 -o out.node"));
    assert!(ran.status == 0 && !ran.err.contains("no place"), "{}", ran.err);
    let text = folder.read("out.node");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect())
        .collect();
    let values =
        |value: fn(f64, f64) -> f64| rows.iter().map(|row| value(row[1], row[2])).collect::<Vec<_>>();
    assert_eq!(third_numbers(&folder.read("hgrid.gr3")), values(|x, _| 5.0 + x));
    assert_eq!(third_numbers(&folder.read("manning.gr3")), values(|_, y| 0.02 + y / 100.0));
    assert_eq!(third_numbers(&folder.read("drag.gr3")), values(|x, y| x * y));
    let title = folder.read("drag.gr3").lines().next().unwrap().to_owned();
    assert!(title.ends_with("; values at the nodes: drag"), "{title}");
    // But for the values the files are alike.
    let rest =
        |name: &str| folder.read(name).lines().skip(2 + rows.len()).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(rest("drag.gr3"), rest("hgrid.gr3"));
    // What a file has no place for is said, and so is a file that SCHISM would misread.
    let ran = folder.run(format!("{mesh} -o hgrid.gr3 -o drag.gr3 -o sea.mesh -o sea.2dm -o sea.vtu"));
    for sentence in [
        "hgrid.gr3 has no place for manning. SCHISM reads each from a file of its name: -o manning.gr3.",
        "sea.mesh has no place for manning, drag.",
        "sea.2dm has no place for manning, drag.",
    ] {
        assert!(ran.err.contains(sentence), "{sentence}: {}", ran.err);
    }
    assert!(!ran.err.contains("sea.vtu has no place"), "{}", ran.err);
    let ran = folder.run("mesh --spacing 0.5 -o manning.gr3");
    assert!(ran.status == 2 && ran.err.contains("SCHISM reads the quantity manning there"), "{}", ran.err);
    // In a sequence the names have numbers.
    folder.run(format!("{mesh} -o manning.gr3 --sequence 2"));
    assert_eq!(third_numbers(&folder.read("manning_1.gr3")), values(|_, y| 0.02 + y / 100.0));
}

#[test]
fn adcirc_has_its_attributes_beside_the_mesh() {
    let folder = Folder::new("quantity-adcirc");
    let mesh = "mesh --domain 0,0,4,3 --spacing 1 --quantity manning=if(x>3.5,0.1,0.02) --quantity depth=7";
    let ran = folder.run(format!("{mesh} -o sea.14"));
    assert!(ran.err.contains("wrote sea.14") && ran.err.contains("wrote sea.13"), "{}", ran.err);
    let text = folder.read("sea.13");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], folder.read("sea.14").lines().next().unwrap());
    assert_eq!((lines[1], lines.len()), ("20", 13));
    assert_eq!(
        lines[2..9],
        ["1", "mannings_n_at_sea_floor", "1", "1", "0.02", "mannings_n_at_sea_floor", "4"]
    );
    let at_east = |line: &&str| line.split_whitespace().nth(1).and_then(|x| x.parse().ok()) == Some(4.0);
    let written = folder.read("sea.14");
    let nodes = written.lines().skip(2).take(20).filter(at_east);
    let values: Vec<String> =
        nodes.map(|line| format!("{} 0.1", line.split_whitespace().next().unwrap())).collect();
    assert_eq!((&lines[9..], values.len()), (&values.iter().map(String::as_str).collect::<Vec<_>>()[..], 4));
    let ran = folder.run(format!("{mesh} -o - --format fort14"));
    assert!(ran.err.contains("standard output has no place for manning"), "{}", ran.err);
    // The file beside it must not be one that is read.
    folder.file("cover.asc", grid(|_, _| 1));
    folder.file("table.13", "class,value\n1,0.02\n");
    let of_table = "--quantity-grid n=cover.asc --quantity-table n=table.13";
    let ran = folder.run(format!("mesh --domain 0,0,4,3 --spacing 1 {of_table} -o table.14"));
    assert!(ran.status == 2 && ran.err.contains("table.13"), "{}", ran.err);
    assert!(!folder.has("table.14") && folder.read("table.13").starts_with("class"));
}

#[test]
fn grids_that_cannot_be_used_are_said_before_the_mesh_is_made() {
    let folder = Folder::new("quantity-wrong");
    folder.file("cover.asc", grid(|_, _| 11));
    folder.file("small.asc", "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.01\n1 2\n3 4\n");
    folder.file("n.csv", CLASSES);
    for (options, sentence) in [
        (
            "--quantity-grid cover.asc",
            "--quantity-grid cover.asc: write NAME=FILE, as in manning=landcover.tif.",
        ),
        ("--quantity-grid n=none.asc", "--quantity-grid n=none.asc: none.asc: there is no such file."),
        ("--quantity-grid n=cover.txt", "a raster ends in .png"),
        ("--quantity-grid level=cover.asc", "the name level is taken"),
        ("--quantity n=x --quantity-grid n=cover.asc", "the name n is taken"),
        (
            "--quantity-table n=n.csv",
            "--quantity-table n=n.csv: there is no grid of n. Name one with --quantity-grid n=FILE.",
        ),
        ("--quantity-grid n=cover.asc --quantity-table n=n.csv", "must name the columns class and value"),
        ("--quantity-grid n=small.asc", "The quantity n, of small.asc:"),
    ] {
        let ran = folder.run(format!("mesh --domain 0,0,40,30 --spacing 10 {options} -o a.vtu"));
        assert!(ran.status != 0 && ran.err.contains(sentence), "{options}: {}", ran.err);
        assert!(!folder.has("a.vtu"));
    }
    let over = folder.run("mesh --domain 0,0,40,30 --spacing 10 --quantity-grid n=cover.asc -o n.csv");
    assert_eq!(over.status, 0, "{}", over.err);
    let over = folder
        .run("mesh --domain 0,0,40,30 --spacing 10 --quantity-grid n=cover.asc --format csv -o cover.asc");
    assert!(over.status != 0, "{}", over.err);
    folder.file("a.toml", "[mesh]\nspacing = 0.5\n[[output]]\nfile = \"a.vtu\"\ngrids = [{ name = \"n\", file = \"no.asc\" }]\n");
    let ran = folder.run("mesh a.toml");
    assert!(
        ran.status != 0 && ran.err.contains("a.toml, line 5") && ran.err.contains("no.asc"),
        "{}",
        ran.err
    );
}
