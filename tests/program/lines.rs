//! Lines along which meshes have edges: in the answer of the program, and in files, which are read here by
//! themselves.

use std::collections::BTreeMap;

use crate::folder::Folder;
use serde_json::Value;

/// A breakwater with a bend, and a small island.
const LINES: &str = r#"{"type":"GeometryCollection","geometries":[
    {"type":"LineString","coordinates":[[0.2,0.3],[0.55,0.4],[0.7,0.75]]},
    {"type":"Polygon","coordinates":[[[0.2,0.7],[0.4,0.7],[0.3,0.85],[0.2,0.7]]]}]}"#;

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.file("walls.geojson", LINES);
    folder
}

/// The nodes and the nodestrings of a `.2dm`, by their names.
fn nodestrings(text: &str) -> (Vec<[f64; 2]>, BTreeMap<String, Vec<usize>>) {
    let mut names = BTreeMap::new();
    let (mut nodes, mut strings, mut open) = (Vec::new(), BTreeMap::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[0] {
            "#" if words.get(1) == Some(&"nodestring") => {
                let (number, name) = line.trim_start_matches("# nodestring ").split_once(": ").unwrap();
                names.insert(number.parse::<usize>().unwrap(), name.to_owned());
            }
            "ND" => nodes.push([words[2], words[3]].map(|word| word.parse().unwrap())),
            "NS" => {
                let numbers = words[1..].iter().map(|word| word.parse::<i64>().unwrap());
                for (place, number) in numbers.enumerate() {
                    if number > 0 {
                        open.push(number as usize - 1);
                        continue;
                    }
                    open.push(-number as usize - 1);
                    let id: usize = words[place + 2].parse().unwrap();
                    strings.insert(names[&id].clone(), std::mem::take(&mut open));
                    break;
                }
            }
            _ => {}
        }
    }
    (nodes, strings)
}

fn distance(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [p[0] - a[0], p[1] - a[1]];
    let share = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
    let share = share.clamp(0.0, 1.0);
    f64::hypot(to[0] - share * along[0], to[1] - share * along[1])
}

#[test]
fn lines_of_a_file_are_on_edges_and_reach_the_files_with_their_names() {
    let folder = folder("lines-files");
    let options = "--spacing 0.1 --target 0.04 --lines walls.geojson -o a.2dm -o a.msh -o a.msh2";
    let answer = folder.json("mesh", options);
    let lines = answer["lines"].as_array().unwrap();
    assert_eq!(lines.len(), 2, "{answer}");
    for (line, length) in
        lines.iter().zip([0.35_f64.hypot(0.1) + 0.15_f64.hypot(0.35), 0.2 + 2.0 * 0.1_f64.hypot(0.15)])
    {
        let of = |key: &str| line[key].as_f64().unwrap();
        assert!(
            (of("length") - length).abs() < 1e-12 && (of("length_on_edges") - length).abs() < 1e-8,
            "{line}"
        );
        assert!(of("farthest") < 1e-8 && line["unresolved"] == Value::Array(vec![]), "{line}");
    }
    let (nodes, strings) = nodestrings(&folder.read("a.2dm"));
    let wall = [[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]];
    let string = &strings["walls 1"];
    let off = |&node: &usize| {
        let sides = [[wall[0], wall[1]], [wall[1], wall[2]]];
        sides.into_iter().map(|side| distance(nodes[node], side)).fold(f64::INFINITY, f64::min)
    };
    assert!(string.len() > 10 && string.iter().map(off).fold(0.0, f64::max) < 2e-9);
    let island = &strings["walls 2"];
    assert_eq!((island.first(), island.len() > 10), (island.last(), true), "a closed line");
    // Each step of a string is an edge of a triangle.
    let text = folder.read("a.2dm");
    let triangles: Vec<Vec<usize>> = text
        .lines()
        .filter(|line| line.starts_with("E3T"))
        .map(|line| {
            line.split_whitespace().skip(2).take(3).map(|word| word.parse::<usize>().unwrap() - 1).collect()
        })
        .collect();
    for pair in string.windows(2).chain(island.windows(2)) {
        let beside = triangles.iter().filter(|triangle| pair.iter().all(|node| triangle.contains(node)));
        assert_eq!(beside.count(), 2, "{pair:?}");
    }
    for file in ["a.msh", "a.msh2"] {
        let text = folder.read(file);
        assert!(text.contains("\"walls 1\"") && text.contains("\"walls 2\""), "{file}");
    }
    let groups = |text: &str| text.lines().filter(|line| line.split(' ').nth(1) == Some("1")).count();
    let elements = folder.read("a.msh2");
    let elements = elements.split("$Elements").nth(1).unwrap();
    let mut sides: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for triangle in &triangles {
        let [a, b, c] = triangle[..] else { panic!("{triangle:?}") };
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *sides.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    let around = sides.values().filter(|&&count| count == 1).count();
    assert_eq!(groups(elements), around + string.len() + island.len() - 2, "edges of curves");
}

#[test]
fn recipes_have_lines_and_those_of_options_are_added() {
    let folder = folder("lines-recipe");
    let mesh = "[mesh]\nspacing = 0.1\n\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"0.04\"\n";
    folder.file("a.toml", format!("{mesh}\n[[line]]\nfile = \"walls.geojson\"\n"));
    let walls = r#"[[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]"#;
    let island = r#"[[0.2, 0.7], [0.4, 0.7], [0.3, 0.85]]"#;
    let in_place = format!(
        "{mesh}\n[[line]]\nname = \"walls 2\"\npoints = {island}\nclosed = true\n\n[[line]]\nname = \"walls 1\"\npoints = {walls}\n"
    );
    folder.file("b.toml", in_place);
    let nodes = |options: &str| {
        let answer = folder.json("mesh", format!("{options} -o a.vtu"));
        (answer["nodes"].clone(), answer["triangles"].clone(), answer["statistics"].clone())
    };
    // In another order, with the same edges.
    assert_eq!(nodes("a.toml"), nodes("b.toml"));
    assert_eq!(nodes("a.toml"), nodes("--spacing 0.1 --target 0.04 --lines walls.geojson"));
    let added = folder.json("mesh", "b.toml --lines walls.geojson");
    assert_eq!(added["lines"].as_array().unwrap().len(), 4);
    for (line, sentence) in [
        ("name = \"a\"", "a line needs `points` or `file`"),
        ("points = [[0, 0]]", "a line needs 2 points at least"),
        ("points = [[0, 0], [1, 1]]\nfile = \"walls.geojson\"", "a line has `points` or `file`, not both"),
        ("file = \"gone.geojson\"", "gone.geojson"),
        ("file = \"walls.geojson\"\nclosed = true", "polygons are closed lines"),
    ] {
        folder.file("bad.toml", format!("{mesh}\n[[line]]\n{line}\n"));
        let ran = folder.run("mesh bad.toml");
        assert!(ran.status != 0 && ran.err.contains(sentence), "{line}: {}", ran.err);
    }
}

#[test]
fn what_the_mesh_cannot_resolve_is_listed_with_its_place() {
    let folder = Folder::new("lines-coarse");
    let line =
        r#"{"type":"LineString","coordinates":[[0.1,0.5],[0.5,0.5],[0.5,0.501],[0.9,0.501],[1.5,0.501]]}"#;
    folder.file("step.geojson", line);
    let answer = folder.json("mesh", "--spacing 0.1 --target 0.1 --lines step.geojson");
    let line = &answer["lines"][0];
    let parts = line["unresolved"].as_array().unwrap();
    assert!(line["length_on_edges"].as_f64() < line["length"].as_f64() && !parts.is_empty(), "{line}");
    let reasons: Vec<&str> = parts.iter().map(|part| part["reason"].as_str().unwrap()).collect();
    assert!(reasons.contains(&"it is not in the domain"), "{reasons:?}");
    let text = folder.run("mesh --spacing 0.1 --target 0.1 --lines step.geojson");
    assert!(text.err.contains("line “step”:"), "{}", text.err);
    folder.file("points.geojson", r#"{"type":"Point","coordinates":[0.1,0.5]}"#);
    let ran = folder.run("mesh --lines points.geojson");
    assert!(ran.status == 1 && ran.err.contains("has no lines and no polygons"), "{}", ran.err);
}

/// A name or value, and points.
type Polyline = (String, Vec<[f64; 2]>);

/// The blocks of a file of polylines of Delft3D-FM: the names, and the points.
fn polylines(text: &str) -> Vec<Polyline> {
    let mut lines = text.lines();
    let mut blocks = Vec::new();
    while let Some(name) = lines.next() {
        assert!(!name.starts_with(['*', '#']) && !name.trim().is_empty(), "{name:?}");
        blocks.push((name.to_owned(), points(&mut lines, "2")));
    }
    blocks
}

/// The lines of a line set of BlueKenue: their values, and the points; and the comments of the header.
fn line_set(text: &str) -> (Vec<Polyline>, Vec<&str>) {
    let (header, body) = text.split_once(":EndHeader\n").unwrap();
    assert_eq!(header.lines().next().unwrap().split_whitespace().next(), Some(":FileType"));
    let (keywords, comments): (Vec<&str>, Vec<&str>) = header.lines().partition(|line| line.starts_with(':'));
    assert!(
        comments.iter().all(|line| line.starts_with('#')) && keywords[0].contains(" i2s ASCII EnSim 1.0")
    );
    let mut lines = body.lines().peekable();
    let mut all = Vec::new();
    while let Some(head) = lines.peek() {
        let value = head.split_whitespace().nth(1).unwrap().to_owned();
        all.push((value.clone(), points(&mut lines, &value)));
    }
    (all, comments)
}

/// Reads a line with a number of points and another word, and then the points.
fn points<'a>(lines: &mut impl Iterator<Item = &'a str>, second: &str) -> Vec<[f64; 2]> {
    let head: Vec<&str> = lines.next().unwrap().split_whitespace().collect();
    assert_eq!((head.len(), head[1]), (2, second));
    let point = |line: &str| {
        let at: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        <[f64; 2]>::try_from(at).unwrap()
    };
    (0..head[0].parse().unwrap()).map(|_| point(lines.next().unwrap())).collect()
}

/// A mesh with a line that leaves the domain and comes back, and one without an end.
const TWO_LINES: &str = r#"[mesh]
spacing = 0.1

[[layer]]
kind = "formula"
quantity = "diameter"
formula = "0.04"

[[line]]
name = "* mole\n1"
points = [[0.2, 0.3], [0.55, 0.4], [0.7, -0.3], [0.9, 0.4]]

[[line]]
name = "ring"
points = [[0.2, 0.7], [0.4, 0.7], [0.3, 0.85]]
closed = true
"#;

#[test]
fn lines_are_beside_the_meshes_of_telemac_and_delft3d() {
    let folder = Folder::new("lines-companions");
    folder.file("a.toml", TWO_LINES);
    let ran = folder.run("mesh a.toml -o a.2dm -o a.slf -o a.nc -o plain.nc");
    assert_eq!(ran.status, 0, "{}", ran.err);
    for file in ["a.i2s", "a_thd.pli", "plain_thd.pli"] {
        assert!(ran.err.contains(file), "{file} is not said: {}", ran.err);
    }
    let (nodes, strings) = nodestrings(&folder.read("a.2dm"));
    let along = |name: &str| strings[name].iter().map(|&node| nodes[node]).collect::<Vec<_>>();
    let text = folder.read("a.i2s");
    let (set, comments) = line_set(&text);
    let [first, second, ring] = &set[..] else { panic!("{set:?}") };
    assert_eq!([&*first.0, &*second.0, &*ring.0], ["1", "1", "2"]);
    assert!(comments.contains(&"# line 1: * mole 1") && comments.contains(&"# line 2: ring"), "{comments:?}");
    assert_eq!(ring.1, along("ring"), "the nodes to the last digit");
    assert!(ring.1.len() > 10 && ring.1.first() == ring.1.last());
    assert_eq!(second.1, along("* mole 1"), "the last string of that name");
    assert!(first.1.len() > 10 && second.1.len() > 4);
    let blocks = polylines(&folder.read("a_thd.pli"));
    let names: Vec<&str> = blocks.iter().map(|(name, _)| &**name).collect();
    assert_eq!(names, ["mole 1 (1)", "mole 1 (2)", "ring"]);
    assert!(blocks.iter().map(|(_, points)| points).eq(set.iter().map(|(_, points)| points)));
    // A mesh without lines has no such file.
    folder.file("none.toml", TWO_LINES.split("[[line]]").next().unwrap());
    assert_eq!(folder.run("mesh none.toml -o b.slf -o b.nc").status, 0);
    assert!(!folder.has("b.i2s") && !folder.has("b_thd.pli"));
}

#[test]
fn no_quadrilateral_has_an_edge_along_a_line_inside_it() {
    let folder = Folder::new("lines-squares");
    // Along diagonals of the squares of the mesh, and along their sides.
    let line = |name: &str, points: &str| format!("[[line]]\nname = \"{name}\"\npoints = {points}\n\n");
    let across = line("across", "[[0.2, 0.2], [0.6, 0.6], [0.9, 0.3]]");
    let text = format!("[mesh]\nspacing = 0.1\n\n{across}{}", line("straight", "[[0.1, 0.8], [0.7, 0.8]]"));
    folder.file("a.toml", text);
    assert_eq!(folder.run("mesh a.toml --cells squares -o a.2dm").status, 0);
    let text = folder.read("a.2dm");
    let (nodes, strings) = nodestrings(&text);
    let cells = text.lines().filter(|line| line.starts_with('E'));
    let cells: Vec<Vec<usize>> = cells
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            words[2..words.len() - 1].iter().map(|word| word.parse::<usize>().unwrap() - 1).collect()
        })
        .collect();
    let squares = cells.iter().filter(|cell| cell.len() == 4).count();
    assert!(squares > 50, "{squares} squares");
    for name in ["across", "straight"] {
        for pair in strings[name].windows(2) {
            let is_side = |cell: &&Vec<usize>| {
                let corners = (0..cell.len()).map(|k| [cell[k], cell[(k + 1) % cell.len()]]);
                corners.into_iter().any(|ends| ends.iter().all(|end| pair.contains(end)))
            };
            let beside = cells.iter().filter(is_side).count();
            assert_eq!(beside, 2, "{name}: {:?}", pair.iter().map(|&node| nodes[node]).collect::<Vec<_>>());
        }
    }
}
