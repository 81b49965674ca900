//! Meshes within an error of a surface, as files have them, against the samples of the grid.

use crate::folder::Folder;

/// A grid of heights by row from the south, with pixels of side 1 from the origin on.
struct Grid {
    columns: usize,
    heights: Vec<f64>,
}

impl Grid {
    fn new([columns, rows]: [usize; 2], height: impl Fn(f64, f64) -> f64) -> Self {
        let place = |n: usize| ((n % columns) as f64 + 0.5, (n / columns) as f64 + 0.5);
        // As a file has it, with three decimals, and as the program reads it.
        let rounded = |n| f64::from(((1000.0 * height(place(n).0, place(n).1)).round() / 1000.0) as f32);
        Self { columns, heights: (0..columns * rows).map(rounded).collect() }
    }

    fn text(&self) -> String {
        let rows = self.heights.len() / self.columns;
        let mut text =
            format!("ncols {}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize 1\n", self.columns);
        for row in self.heights.chunks(self.columns).rev() {
            text += &row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
            text.push('\n');
        }
        text
    }

    /// Returns the largest difference of a sample from the triangle that it is in, and how many samples are
    /// in one.
    fn error(&self, nodes: &[[f64; 3]], triangles: &[[usize; 3]]) -> (f64, usize) {
        let (mut largest, mut is_in) = (0.0_f64, vec![false; self.heights.len()]);
        for corners in triangles.iter().map(|triangle| triangle.map(|node| nodes[node])) {
            let [a, b, c] = corners;
            let cross = |p: [f64; 3], q: [f64; 3], x: f64, y: f64| {
                (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])
            };
            let whole = cross(a, b, c[0], c[1]);
            for (place, &height) in self.heights.iter().enumerate() {
                let (x, y) = ((place % self.columns) as f64 + 0.5, (place / self.columns) as f64 + 0.5);
                let parts =
                    [cross(b, c, x, y), cross(c, a, x, y), cross(a, b, x, y)].map(|part| part / whole);
                if parts.iter().all(|part| *part >= -1e-12) {
                    let of_mesh: f64 = (0..3).map(|n| parts[n] * corners[n][2]).sum();
                    largest = largest.max((of_mesh - height).abs());
                    is_in[place] = true;
                }
            }
        }
        (largest, is_in.iter().filter(|is_in| **is_in).count())
    }
}

/// Nodes with their heights, and triangles, of a file of SMS.
fn two_dm(text: &str) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
    let rows = |word: &'static str| {
        text.lines().filter(move |line| line.starts_with(word)).map(|line| {
            line.split_whitespace().skip(2).map(|number| number.parse().unwrap()).collect::<Vec<f64>>()
        })
    };
    let nodes = rows("ND ").map(|row| [row[0], row[1], row[2]]).collect();
    let triangles = rows("E3T ").map(|row| [0, 1, 2].map(|n| row[n] as usize - 1)).collect();
    (nodes, triangles)
}

#[test]
fn files_are_within_the_error_and_a_smaller_one_needs_another_mesh() {
    let folder = Folder::new("surface");
    let surfaces: [Box<dyn Fn(f64, f64) -> f64>; 5] = [
        Box::new(|x, y| 0.3 * x - 0.2 * y),
        Box::new(|x, y| 8.0 * (0.2 * x).sin() * (0.15 * y).cos()),
        Box::new(|x, y| if x + y > 40.0 { 10.0 } else { 0.0 }),
        Box::new(|x, y| 50.0 / (1.0 + (x - 11.0).hypot(y - 17.0))),
        Box::new(|x, y| ((x * 12.9898 + y * 78.233).sin() * 43758.5453).fract()),
    ];
    let sizes = [[33, 33], [40, 25], [17, 49], [29, 31], [24, 18]];
    for (number, (surface, size)) in surfaces.iter().zip(sizes).enumerate() {
        let grid = Grid::new(size, surface);
        folder.file("heights.asc", grid.text());
        for (options, error) in [("", 0.5), ("--domain 1,2,16,16 --spacing 3", 1.0)] {
            let run = |goal: String| {
                let ran = folder
                    .run(format!("mesh --surface heights.asc {goal} {options} -o m.2dm --json --checks"));
                (ran.json(), two_dm(&folder.read("m.2dm")))
            };
            let (said, (nodes, triangles)) = run(format!("--max-error {error}"));
            let (largest, samples) = grid.error(&nodes, &triangles);
            let of_all = if options.is_empty() { grid.heights.len() } else { 15 * 14 };
            assert_eq!(samples, of_all, "surface {number}");
            let printed = said["max_error"].as_f64().unwrap();
            assert!(
                largest <= error + 1e-9 && (largest - printed).abs() < 1e-9,
                "{number}: {largest} {printed}"
            );
            assert!(
                said["rms_error"].as_f64().unwrap() <= printed
                    && said["worst"].as_array().unwrap().len() == 2
            );
            let hash = |said: &serde_json::Value| said["hash"].as_str().unwrap().to_owned();
            if printed > 0.0 {
                assert_eq!(hash(&run(format!("--max-error {printed}")).0), hash(&said));
                assert_ne!(hash(&run(format!("--max-error {}", printed.next_down())).0), hash(&said));
            }
            let count = said["triangles"].as_u64().unwrap();
            let (counted, _) = run(format!("--at-most {count}"));
            assert!(counted["triangles"].as_u64().unwrap() <= count);
            assert!(counted["max_error"].as_f64().unwrap() <= printed);
        }
    }
}

#[test]
fn another_error_in_a_mask_and_other_layers_count_too() {
    let folder = Folder::new("surface-mask");
    let grid = Grid::new([64, 64], |x, y| 8.0 * (0.3 * x).sin() * (0.2 * y).cos());
    folder.file("heights.asc", grid.text());
    folder.file(
        "both.toml",
        "[domain]\nbounds = [0, 0, 64, 64]\n[mesh]\nspacing = 16\n\
         [[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\nformula = \"if(y > 48, 1, inf)\"\n\
         [[layer]]\nkind = \"surface\"\nfile = \"heights.asc\"\nwithin = 4\n\
         [[layer]]\nkind = \"surface\"\nfile = \"heights.asc\"\nwithin = 0.2\n\
         mask = [[[[0, 0], [20, 0], [20, 20], [0, 20]]]]\n",
    );
    let ran = folder.run("mesh both.toml -o m.2dm --json --checks");
    assert_eq!(ran.json()["violations"], 0);
    let (nodes, triangles) = two_dm(&folder.read("m.2dm"));
    let within = |bounds: [f64; 4]| -> Vec<[usize; 3]> {
        let is_in = |node: &usize| {
            let [x, y, _] = nodes[*node];
            x >= bounds[0] && x <= bounds[2] && y >= bounds[1] && y <= bounds[3]
        };
        triangles.iter().copied().filter(|triangle| triangle.iter().all(is_in)).collect()
    };
    let fine = within([0.0, 0.0, 19.0, 19.0]);
    let (error, samples) = grid.error(&nodes, &fine);
    assert!(error <= 0.2 + 1e-9 && samples > 250, "{error} at {samples}");
    let (coarse, _) = grid.error(&nodes, &triangles);
    assert!(coarse > 1.0 && coarse <= 4.0 + 1e-9, "{coarse}");
    let short = within([0.0, 49.0, 64.0, 64.0]);
    let longest = |triangle: &[usize; 3]| {
        let [a, b, c] = triangle.map(|node| nodes[node]);
        [(a, b), (b, c), (c, a)]
            .map(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1]))
            .into_iter()
            .fold(0.0, f64::max)
    };
    assert!(short.len() > 1000 && short.iter().all(|triangle| longest(triangle) <= 1.0 + 1e-9));
}

/// The third coordinates of the nodes of an `.obj`.
fn heights_of_obj(text: &str) -> Vec<f64> {
    let rows = text.lines().filter(|line| line.starts_with("v "));
    rows.map(|line| line.rsplit(' ').next().unwrap().parse().unwrap()).collect()
}

#[test]
fn the_height_is_the_third_coordinate_and_0_where_it_is_flat() {
    let folder = Folder::new("surface-third");
    folder.file("heights.asc", Grid::new([20, 20], |x, y| 100.0 + x * y).text());
    let mesh = "mesh --surface heights.asc --max-error 3";
    assert_eq!(folder.run(format!("{mesh} -o m.obj -o m.2dm -o m.msh")).status, 0);
    let (nodes, _) = two_dm(&folder.read("m.2dm"));
    let heights: Vec<f64> = nodes.iter().map(|node| node[2]).collect();
    assert!(heights.iter().all(|height| *height >= 99.0));
    assert_eq!(heights_of_obj(&folder.read("m.obj")), heights);
    let flat = folder.run(format!("{mesh} --flat -o m.obj -o m.2dm -o m.vtu"));
    assert_eq!((flat.status, flat.err.contains("--flat")), (0, false), "{}", flat.err);
    assert!(heights_of_obj(&folder.read("m.obj")).iter().all(|height| *height == 0.0));
    assert!(two_dm(&folder.read("m.2dm")).0.iter().all(|node| node[2] == 0.0));
    // A quantity that a person asks for is z in .2dm, and a surface of their own is one everywhere.
    folder.run(format!("{mesh} --quantity 7 --quantity surface=5 -o m.2dm -o m.obj"));
    assert!(two_dm(&folder.read("m.2dm")).0.iter().all(|node| node[2] == 7.0));
    assert!(heights_of_obj(&folder.read("m.obj")).iter().all(|height| *height == 5.0));
    // Recipes say it too, where a format can have heights.
    let recipe = "[[layer]]\nkind = \"surface\"\nfile = \"heights.asc\"\nwithin = 3\n[[output]]\nfile = ";
    folder.file("flat.toml", format!("{recipe}\"r.obj\"\nflat = true\n"));
    assert_eq!(folder.run("mesh flat.toml").status, 0);
    assert!(heights_of_obj(&folder.read("r.obj")).iter().all(|height| *height == 0.0));
    folder.file("none.toml", format!("{recipe}\"r.csv\"\nflat = true\n"));
    let refused = folder.run("mesh none.toml");
    assert!(refused.status != 0 && refused.err.contains("flat"), "{}", refused.err);
    let idle = folder.run(format!("{mesh} --flat -o m.csv"));
    assert!(idle.err.contains("--flat changes nothing"), "{}", idle.err);
}

#[test]
fn far_from_values_a_node_has_the_height_of_the_nodes_around_it() {
    let folder = Folder::new("surface-far");
    folder.file("heights.asc", Grid::new([10, 10], |_, _| 250.0).text());
    let ran =
        folder.run("mesh --domain 0,0,400,10 --spacing 10 --surface heights.asc --max-error 1 -o m.obj");
    assert!(ran.err.contains("64 pixels") && ran.err.contains("around"), "{}", ran.err);
    assert!(heights_of_obj(&folder.read("m.obj")).iter().all(|height| *height == 250.0));
}

#[test]
fn models_of_a_mesh_in_degrees_are_in_metres() {
    let folder = Folder::new("surface-degrees");
    folder.file(
        "sea.geojson",
        r#"{"type":"Polygon","coordinates":[[[10,50],[10.2,50],[10.2,50.1],[10,50.1],[10,50]]]}"#,
    );
    let mesh = "mesh --region sea.geojson --projection auto --spacing 5000 --surface 0.01*x --max-error 1";
    let ran = folder.run(format!("{mesh} -o m.obj -o m.csv"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    let text = folder.read("m.obj");
    assert!(text.contains("# unit: m") && !text.contains("longitude"), "{}", &text[..400]);
    let xs: Vec<f64> = text
        .lines()
        .filter(|line| line.starts_with("v "))
        .map(|line| line.split(' ').nth(1).unwrap().parse().unwrap())
        .collect();
    let extent = xs.iter().fold(f64::MIN, |a, b| a.max(*b)) - xs.iter().fold(f64::MAX, |a, b| a.min(*b));
    assert!((extent / 14_330.0 - 1.0).abs() < 0.02, "{extent}");
    folder.run(format!("{mesh} --flat -o m.obj"));
    assert!(folder.read("m.obj").contains("longitude"));
}

#[test]
fn errors_of_a_raster_count_in_place_of_the_largest() {
    let folder = Folder::new("surface-errors");
    let grid = Grid::new([40, 40], |x, y| 8.0 * (0.3 * x).sin() * (0.2 * y).cos());
    folder.file("heights.asc", grid.text());
    // The left half asks for 0.2, and the right one for nothing.
    let row = "0.2 -9\n".repeat(2);
    let header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 20\nNODATA_value -9\n";
    folder.file("errors.asc", format!("{header}{row}"));
    folder.file(
        "errors.toml",
        "[[layer]]\nkind = \"surface\"\nfile = \"heights.asc\"\nwithin = 3\n[[layer]]\nkind = \"raster\"\n\
         file = \"errors.asc\"\nas = \"error\"\n",
    );
    let mesh = "mesh --surface heights.asc --error-raster errors.asc --json";
    let ran = folder.run(format!("{mesh} --max-error 3 -o m.2dm"));
    assert!(!ran.err.contains("The mesh is"), "{}", ran.err);
    assert_eq!(folder.run("mesh errors.toml --json").json()["hash"], ran.json()["hash"]);
    let errors = || {
        let (nodes, triangles) = two_dm(&folder.read("m.2dm"));
        let left = triangles.iter().copied().filter(|corners| corners.iter().all(|n| nodes[*n][0] < 20.0));
        let left: Vec<[usize; 3]> = left.collect();
        [grid.error(&nodes, &left).0, grid.error(&nodes, &triangles).0]
    };
    let [left, all] = errors();
    assert!(left <= 0.2 + 1e-6 && all > 0.5 && all <= 3.0 + 1e-9, "{left} {all}");
    let count = ran.json()["triangles"].as_u64().unwrap();
    let counted = folder.run(format!("{mesh} --at-most {count} -o m.2dm"));
    let [counted_left, counted_all] = errors();
    assert!(counted.json()["triangles"].as_u64().unwrap() <= count);
    assert!(counted_left <= 0.2 + 1e-6 && counted_all <= all, "{counted_left} {counted_all}");
    let why = folder.run("why 5.3,7.1 --surface heights.asc --error-raster errors.asc --max-error 3 --domain 0,0,40,40 --spacing 40");
    assert!(why.out.contains("and 0.2000 is allowed"), "{}", why.out);
    folder.file("zero.asc", header.replace("NODATA_value -9\n", "") + "0 1\n1 1\n");
    let refused = folder.run("mesh --surface heights.asc --max-error 3 --error-raster zero.asc");
    assert!(refused.status != 0 && refused.err.contains("the error is 0"), "{}", refused.err);
}

#[test]
fn samples_without_a_value_are_counted_and_can_be_left_out() {
    let folder = Folder::new("surface-nodata");
    let grid = Grid::new([20, 20], |x, y| 10.0 + 0.3 * x * y);
    // A block of 6 × 4 pixels at the left has no value.
    let is_missing = |row: usize, column: usize| (8..12).contains(&row) && column < 6;
    let rows = grid.text();
    let (header, rows): (Vec<&str>, Vec<&str>) =
        (rows.lines().take(5).collect(), rows.lines().skip(5).collect());
    let rows = rows.iter().enumerate().map(|(row, line)| {
        let value = |(column, text): (usize, &str)| {
            if is_missing(row, column) { "-9999".into() } else { text.to_owned() }
        };
        line.split(' ').enumerate().map(value).collect::<Vec<_>>().join(" ") + "\n"
    });
    let text = format!("{}\nNODATA_value -9999\n{}", header.join("\n"), rows.collect::<String>());
    folder.file("heights.asc", text);
    let mesh = "mesh --surface heights.asc --max-error 1 --json";
    let whole = folder.run(mesh);
    assert!(whole.err.contains("24 of 400 samples"), "{}", whole.err);
    assert_eq!(whole.json()["missing_samples"], 24);
    assert!((whole.json()["missing_share"].as_f64().unwrap() - 0.06).abs() < 1e-12);
    let outside = folder.run(format!("{mesh} --outside-nodata"));
    assert_eq!(outside.json()["missing_samples"], 0, "{}", outside.err);
    // The outline closes along the sides of the raster, and corners are cut.
    let area = outside.json()["region_area"].as_f64().unwrap();
    assert!((area - 376.0).abs() < 1.0, "{area}");
    let same = folder.run(format!("{mesh} --outside-nodata --region heights.asc"));
    assert_eq!(same.json()["hash"], outside.json()["hash"]);
    folder.file(
        "m.toml",
        "[domain]\nregion = \"heights.asc\"\noutside_nodata = true\n[[layer]]\nkind = \"surface\"\n\
         file = \"heights.asc\"\nwithin = 1\n",
    );
    assert_eq!(folder.run("mesh m.toml --json").json()["hash"], outside.json()["hash"]);
    folder.file("none.asc", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value 1\n1 1\n");
    for (options, part) in [
        ("--surface x*y --max-error 1 --outside-nodata", "--outside-nodata needs a grid"),
        ("--region none.asc --outside-nodata", "no pixel has a value"),
        ("--region heights.asc --outside-nodata --contour 3", "--contour"),
        ("--surface heights.asc --max-error 1 --outside-nodata --domain 0,0,1,1", "--domain"),
    ] {
        let ran = folder.run(format!("mesh {options}"));
        assert!(ran.status != 0 && ran.err.contains(part), "{options}: {}", ran.err);
    }
}

/// What is known of a raster ends at its outermost centres: so does its domain, and in one that goes on to the
/// sides of the pixels, the surface goes on as it is.
#[test]
fn the_border_of_a_raster_takes_no_more_triangles_than_its_inside() {
    let folder = Folder::new("surface-border");
    let surface =
        |x: f64, y: f64| (7.0 * x / 203.0).sin() * (5.0 * y / 203.0).cos() + 0.3 * (x * y / 2000.0).sin();
    folder.file("heights.asc", Grid::new([203, 167], surface).text());
    let mesh =
        |more: &str| folder.run(format!("mesh --surface heights.asc --max-error 0.3 --json {more}")).json();
    let [free, to_sides] = [mesh(""), mesh("--domain 0,0,203,167 --spacing 8")];
    let number = |summary: &serde_json::Value, key: &str| summary[key].as_f64().unwrap();
    assert!((number(&free, "area") - 202.0 * 166.0).abs() < 1e-6, "{}", free["area"]);
    let [inside, all] =
        [&free, &to_sides].map(|summary| number(summary, "triangles") / number(summary, "area"));
    assert!(all < 1.05 * inside, "{all} triangles by area with the border, {inside} without");
}

#[test]
fn what_cannot_be_met_is_said() {
    let folder = Folder::new("surface-refused");
    folder.file("heights.asc", Grid::new([8, 8], |x, y| x * y).text());
    folder.file("pixel.asc", Grid::new([1, 1], |_, _| 3.0).text());
    for (options, parts) in [
        ("--surface heights.asc", &["--max-error", "--at-most"][..]),
        ("--surface heights.asc --max-error 0", &["--max-error 0", "positive"]),
        ("--surface heights.asc --max-error=-2", &["--max-error -2", "positive"]),
        ("--surface heights.asc --max-error nan", &["--max-error"]),
        ("--surface heights.asc --at-most 0", &["--at-most 0", "one triangle"]),
        ("--surface heights.asc --max-error 1 --at-most 9", &["--max-error", "--at-most"]),
        ("--max-error 1", &["--surface"]),
        ("--surface x+ --max-error 1", &["--surface x+", "^"]),
        ("--surface none.asc --max-error 1", &["none.asc"]),
    ] {
        let ran = folder.run(format!("mesh {options}"));
        let said = &ran.err;
        assert!(ran.status != 0, "{options}");
        assert!(parts.iter().all(|part| said.contains(part)), "{options}: {said}");
    }
    // The mesh that the coarse grid needs is made all the same, as in Python and in the window.
    let input = "--domain 0,0,8,8 --spacing 1 --surface heights.asc --json --at-most";
    let [more, enough] = [60, 128].map(|most| folder.run(format!("mesh {input} {most}")));
    assert_eq!(
        (more.status, more.json()["triangles"].as_u64(), &more.json()["hash"]),
        (0, Some(128), &enough.json()["hash"])
    );
    let says = |ran: &crate::folder::Ran| {
        ["at most 60 triangles", "128 already"].iter().all(|part| ran.err.contains(part))
    };
    assert!(says(&more) && !enough.err.contains("cannot be made"), "{}", more.err);
    // One pixel has no slope, and a jump ends: the program says where.
    let one = folder.run("mesh --surface pixel.asc --max-error 1 --json");
    assert_eq!(one.json()["max_error"], 0.0);
    let jump =
        folder.run(["mesh", "--surface", "if(x + 0.3*y > 0.61, 1, 0)", "--max-error", "0.1", "--json"]);
    assert!(jump.json()["triangles"].as_u64().unwrap() < 200_000);
}

#[test]
fn norms_and_curves_of_errors() {
    let folder = Folder::new("surface-norms");
    let run = |more: &str| {
        folder.run(format!("mesh --surface exp(-x*x-4*y*y) --domain -2,-2,2,2 --spacing 1 {more}"))
    };
    for (norm, key) in [("max", "max_error"), ("l2", "rms_error"), ("h1", "gradient_error")] {
        let within = run(&format!("--max-error 0.02 --norm {norm} --json"));
        assert!(within.json()[key].as_f64().unwrap() <= 0.02, "{norm}");
        let counted = run(&format!("--at-most 3000 --norm {norm} --json"));
        let of =
            |other: &str| run(&format!("--at-most 3000 --norm {other} --json")).json()[key].as_f64().unwrap();
        let own = counted.json()[key].as_f64().unwrap();
        // Each norm is the best one for its error, or near it.
        assert!(own <= 1.15 * of("max").min(of("l2")).min(of("h1")), "{norm}");
    }
    let ran = run("--max-error 0.02 --norm l2 --error-curve curve.csv");
    assert!(ran.err.contains("best possible"), "{}", ran.err);
    let rows = folder.read("curve.csv");
    assert!(rows.lines().count() > 20 && rows.contains("Uniform mesh"), "{rows}");
    let refused = |options: &str, sentence: &str| {
        let ran = folder.run(format!("mesh {options}"));
        assert!(ran.err.contains(sentence), "{}", ran.err);
    };
    refused("--target 0.3 --domain 0,0,1,1 --error-curve c.csv", "no visible layer is one");
    refused("--surface x --max-error 1 --domain 0,0,1,1 --error-curve c.png", "use .svg or .csv");
    refused("--surface x --max-error 1 --norm l3 --domain 0,0,1,1", "possible values: max, l2, h1");
}

/// The picture of a run, in its colours: red, green and blue by pixel.
fn picture(folder: &Folder, name: &str) -> ([u32; 2], Vec<[u8; 3]>) {
    let file = std::io::BufReader::new(std::fs::File::open(folder.0.join(name)).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut bytes).unwrap();
    ([frame.width, frame.height], bytes.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect())
}

#[test]
fn pictures_show_the_surface_in_space() {
    let folder = Folder::new("space");
    folder.file("heights.asc", Grid::new([33, 25], |x, y| 8.0 * (0.2 * x).sin() * (0.15 * y).cos()).text());
    let run = |options: &str| {
        let size = if options.contains("--size") { "" } else { "--size 400" };
        let ran = folder.run(format!("mesh --surface heights.asc --max-error 0.5 -o m.png {size} {options}"));
        assert_eq!(ran.status, 0, "{options}: {}", ran.err);
        (picture(&folder, "m.png"), ran.err)
    };
    let ((size, default), said) = run("--view space");
    assert!(said.contains("m.png, with heights times 0.2"), "{said}");
    assert!(size[0] == 400 && (150..350).contains(&size[1]), "{size:?}");
    let ground = default[0];
    let drawn = default.iter().filter(|pixel| **pixel != ground).count();
    assert!(drawn > default.len() / 4 && drawn < default.len() * 9 / 10, "{drawn} of {}", default.len());
    assert_eq!(run("--view space --azimuth 20 --altitude 40").0.1, default, "the usual direction");
    for other in ["--azimuth 200", "--altitude 15", "--exaggeration 1"] {
        assert_ne!(run(&format!("--view space {other}")).0.1, default, "{other}");
    }
    // From above and without relief it is the plan, within its margin.
    let ((from_above, _), _) =
        run("--view space --altitude 90 --azimuth 0 --exaggeration 1e-6 --size 400x300");
    assert_eq!(from_above, [400, 300]);

    folder.file(
        "space.toml",
        "[[layer]]\nkind = \"surface\"\nfile = \"heights.asc\"\nwithin = 0.5\n\
         [[output]]\nfile = \"r.png\"\nsize = \"400\"\nview = \"space\"\nazimuth = 200\n",
    );
    assert_eq!(folder.run("mesh space.toml").status, 0);
    assert_eq!(picture(&folder, "r.png"), run("--view space --azimuth 200").0, "as by options");
}

#[test]
fn pictures_that_cannot_be_in_space_are_refused() {
    let folder = Folder::new("space-refused");
    folder.file("heights.asc", Grid::new([8, 8], |x, y| x * y).text());
    let surface = "mesh --surface heights.asc --max-error 1";
    for (options, parts) in [
        (format!("{surface} -o m.svg --view space"), &["--view space", ".png"][..]),
        (format!("{surface} -o m.png --view space --altitude 4"), &["--altitude", "4", "5 to 90"]),
        (format!("{surface} -o m.png --view space --altitude=-1"), &["--altitude", "5 to 90"]),
        (format!("{surface} -o m.png --view space --azimuth nan"), &["--azimuth", "angle"]),
        (format!("{surface} -o m.png --view space --exaggeration 0"), &["--exaggeration", "positive"]),
        (format!("{surface} -o m.png --azimuth 10"), &["--azimuth", "--view space"]),
        ("mesh --domain 0,0,1,1 --spacing 0.1 -o m.png --view space".into(), &["heights", "--surface"]),
    ] {
        let ran = folder.run(&*options);
        assert!(ran.status != 0 && !folder.has("m.png"), "{options}");
        assert!(parts.iter().all(|part| ran.err.contains(part)), "{options}: {}", ran.err);
    }
    let recipe = |keys: &str, file: &str| {
        let text = format!(
            "[[layer]]\nkind = \"surface\"\nfile = \"heights.asc\"\nwithin = 1\n[[output]]\nfile = \"{file}\"\n{keys}\n"
        );
        folder.file("m.toml", text);
        folder.run("mesh m.toml").err
    };
    assert!(recipe("view = \"space\"", "m.svg").contains(".png"));
    assert!(recipe("view = \"space\"", "m.vtu").contains("for pictures"));
    assert!(recipe("view = \"moon\"", "m.png").contains("use plan or space"));
    assert!(recipe("azimuth = 3", "m.png").contains("views in space"));
}
