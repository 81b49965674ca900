//! Every format that meshes are written in, read back by a reader that knows only the format.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::io::Read;

use flate2::read::ZlibDecoder;
use glam::{DVec2, DVec3, Vec3, dvec2};
use meshbrush_core::domain::MeshBoundary;
use meshbrush_io::io::{
    CellShape, JoinedCells, MeshData, MeshFormat, MeshSource, Meter, NodeValues, Provenance, csv, glb, msh,
    node, obj, ply, png, sms, stl, svg, vtu,
};
use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Extract, Limits, Mesh, NodeId, TriangleId};
use meshbrush_mesh::text::LengthUnit;
use meshbrush_render::colormap::{Colormap, Ground, LevelColors};

/// A mesh read from a file.
#[derive(Debug, Default)]
struct Found {
    nodes: Vec<DVec2>,
    /// The third coordinate of each node.
    heights: Vec<f64>,
    triangles: Vec<[usize; 3]>,
    levels: Vec<u32>,
    targets: Vec<f64>,
    quantities: Vec<f64>,
    /// The marker of each node: 0 off the boundary.
    markers: Vec<usize>,
    parts: Vec<u32>,
}

/// A mesh that was written, with its data.
struct Sample {
    mesh: Mesh,
    targets: Vec<f64>,
    quantities: Vec<NodeValues>,
    heights: Option<Vec<f64>>,
    boundary: MeshBoundary,
    parts: Vec<u32>,
    joined: JoinedCells,
    provenance: Provenance,
}

/// A command with all characters that formats must escape.
const COMMAND: &str = "meshbrush mesh --target 'x < 1 & \"y\" > 2' ?> --quantity ä\n-o m";

impl Sample {
    fn new(bounds: Rect, spacing: f64, inside: impl Fn(DVec2) -> bool, finest: f64) -> Self {
        let limits = Limits::default();
        let mut mesh =
            Mesh::coarse_grid(&Lattice::covering(bounds, spacing, 1_000_000).unwrap(), inside, &limits)
                .unwrap();
        let focus = bounds.min + 0.3 * bounds.size();
        let target = |p: DVec2| finest + 0.3 * (p - focus).length();
        mesh.refine(&limits, |e| e.world_corners().iter().any(|&p| e.diameter() > target(p))).unwrap();
        let nodes = || (0..mesh.raw_nodes().len()).map(|n| mesh.world(NodeId::from_index(n)));
        let targets = nodes().map(target).collect();
        let height =
            NodeValues { name: "height".into(), values: nodes().map(|p| p.x * 1e-9 - p.y).collect() };
        let (boundary, parts) = (MeshBoundary::from_mesh(&mesh.extract()), mesh.extract().part_numbers());
        let provenance = Provenance::new(MeshSource::Command(COMMAND), mesh.fingerprint(), "x, y");
        let surface = nodes().map(|p| libm::sin(3.0 * p.x) - 0.1 * p.y).collect();
        let (quantities, heights) = (vec![height], Some(surface));
        let joined = JoinedCells::default();
        Self { targets, quantities, heights, boundary, parts, joined, provenance, mesh }
    }

    /// Returns a square without heights, a rectangle whose cells are not square, and a ring with a hole.
    fn all() -> Vec<Self> {
        let oblong = Rect::new(dvec2(-3.25, 100.0), dvec2(4.5, 103.3));
        let ring = |p: DVec2| (0.5..=1.2).contains(&p.length());
        vec![
            Self { heights: None, ..Self::new(Rect::UNIT, 0.25, |_| true, 0.01) },
            Self::new(oblong, 1.1, |_| true, 0.05),
            Self::new(Rect::around(DVec2::ZERO, 1.0), 0.1, ring, 0.02),
        ]
    }

    /// Returns a square with enough triangles for arrays of several blocks.
    fn fine() -> Self {
        Self::new(Rect::UNIT, 0.005, |_| true, 0.001)
    }

    fn data(&self) -> MeshData<'_> {
        let Self { targets, quantities, heights, boundary, parts, joined, provenance, .. } = self;
        let heights = heights.as_deref();
        MeshData {
            target_diameter: targets,
            quantities,
            heights,
            boundary,
            lines: &[],
            parts,
            cells: CellShape::Triangles,
            joined,
            parts_for: None,
            provenance,
        }
    }

    /// Returns the names of the pieces, in the order of their markers.
    fn names(&self) -> Vec<&str> {
        self.boundary.pieces().list().iter().map(|piece| piece.name.as_str()).collect()
    }

    /// Fails unless an edge of the boundary may have this name at its position.
    fn assert_named(&self, ends: [usize; 2], name: &str) {
        let [a, b] = ends.map(|node| self.mesh.world(NodeId::from_index(node)));
        let Rect { min, max } = self.mesh.lattice().bounds();
        let sides = [
            (a.y == min.y && b.y == min.y, "open south"),
            (a.x == max.x && b.x == max.x, "open east"),
            (a.y == max.y && b.y == max.y, "open north"),
            (a.x == min.x && b.x == min.x, "open west"),
        ];
        match sides.into_iter().find(|(on, _)| *on) {
            Some((_, side)) => assert!(name.starts_with(side), "{name} at {a}"),
            // A ring around the middle of the frame: outside it is mainland.
            None if a.length() < 0.8 => assert_eq!(name, "island 1", "at {a}"),
            None => assert!(name.starts_with("mainland"), "{name} at {a}"),
        }
    }

    /// Fails unless each node has the lowest marker of the edges at it.
    fn assert_markers(&self, markers: &[usize]) {
        let mut expected = vec![usize::MAX; markers.len()];
        for (edge, &piece) in self.mesh.extract().boundary_edges().zip(self.boundary.piece_of_edge()) {
            self.assert_named(edge.ends, self.names()[piece as usize]);
            for node in edge.ends {
                expected[node] = expected[node].min(piece as usize + 1);
            }
        }
        expected.iter_mut().filter(|marker| **marker == usize::MAX).for_each(|marker| *marker = 0);
        assert_eq!(markers, expected);
    }

    fn written(
        &self,
        write: impl FnOnce(&mut Vec<u8>, &Extract, &MeshData) -> std::io::Result<()>,
    ) -> Vec<u8> {
        let mut file = Vec::new();
        write(&mut file, &self.mesh.extract(), &self.data()).unwrap();
        file
    }

    /// Returns the area of all triangles, from the coarse triangles that were kept.
    fn area(&self) -> f64 {
        let lattice = self.mesh.lattice();
        let [columns, rows] = lattice.cells().map(f64::from);
        let extent = lattice.bounds().size();
        self.mesh.coarse_triangles() as f64 * extent.x * extent.y / (2.0 * columns * rows)
    }

    fn height(&self, node: usize) -> f64 {
        self.heights.as_ref().map_or(0.0, |heights| heights[node])
    }

    fn assert_same(&self, found: &Found) {
        assert_eq!(found.nodes.len(), self.mesh.raw_nodes().len());
        assert_eq!(found.triangles.len(), self.mesh.raw_triangle_count());
        let mut counts = vec![0; self.mesh.level_counts().len()];
        for &level in &found.levels {
            counts[level as usize] += 1;
        }
        assert_eq!(counts, self.mesh.level_counts());
        for (n, &place) in found.nodes.iter().enumerate() {
            assert_eq!(place, self.mesh.world(NodeId::from_index(n)));
        }
        let heights: Vec<f64> = (0..found.nodes.len()).map(|n| self.height(n)).collect();
        // Some formats have none.
        assert!(found.heights.is_empty() || found.heights == heights);
        assert_eq!(found.targets, self.targets);
        self.assert_well_made(found, 1e-9);
    }

    /// Checks that the triangles are anticlockwise, cover the area, and have their longest edge first.
    fn assert_well_made(&self, found: &Found, tolerance: f64) {
        let mut covered = 0.0;
        for corners in &found.triangles {
            let [a, b, c] = corners.map(|n| found.nodes[n]);
            let area = 0.5 * (b - a).perp_dot(c - a);
            assert!(area > 0.0, "{corners:?} does not run anticlockwise");
            assert!(a.distance(b) > 1.2 * b.distance(c).max(c.distance(a)), "{corners:?}");
            covered += area;
        }
        assert!((covered / self.area() - 1.0).abs() < tolerance, "{covered} of {}", self.area());
    }
}

fn numbers<T: std::str::FromStr>(line: &str) -> Vec<T> {
    line.split_whitespace().map(|word| word.parse().ok().expect(word)).collect()
}

#[test]
fn vtu_reads_back() {
    for sample in Sample::all() {
        let file = sample.written(vtu::write);
        let found = read_vtu(&file);
        sample.assert_same(&found);
        assert_eq!(found.quantities, sample.quantities[0].values);
        sample.assert_markers(&found.markers);
        assert_eq!(found.parts, sample.parts);
        let text = String::from_utf8_lossy(&file);
        let names = text.split("Name=\"boundary_names\"").nth(1).unwrap();
        let (head, names) = names.split('<').next().unwrap().split_once('>').unwrap();
        let bytes: Vec<u8> = numbers(names);
        assert!(head.contains(&format!("NumberOfTuples=\"{}\"", bytes.len())));
        assert_eq!(String::from_utf8(bytes).unwrap().lines().collect::<Vec<_>>(), sample.names());
    }
}

fn read_vtu(file: &[u8]) -> Found {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let start = file.windows(mark.len()).position(|w| w == mark).unwrap() + mark.len();
    let header = std::str::from_utf8(&file[..start]).unwrap();
    assert!(
        header.contains(
            "byte_order=\"LittleEndian\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\""
        )
    );
    let attribute = |element: &str, name: &str| {
        let after = element.split(&format!(" {name}=\"")).nth(1)?;
        Some(after.split('"').next()?.to_owned())
    };
    let array = |name: &str, kind: &str| -> Vec<u8> {
        let named = |element: &&str| attribute(element, "Name").as_deref() == Some(name);
        let element = header.split('<').find(named).unwrap();
        assert_eq!(attribute(element, "type").unwrap(), kind);
        let at = start + attribute(element, "offset").unwrap().parse::<usize>().unwrap();
        decompressed(&file[at..])
    };
    let floats = |name| -> Vec<f64> {
        array(name, "Float64").chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
    };
    let small = |name| -> Vec<u32> {
        array(name, "UInt32").chunks(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect()
    };
    let whole = |name| -> Vec<usize> {
        array(name, "Int64").chunks(8).map(|b| i64::from_le_bytes(b.try_into().unwrap()) as usize).collect()
    };
    let points = floats("Points");
    let nodes: Vec<DVec2> = points.chunks(3).map(|p| dvec2(p[0], p[1])).collect();
    let triangles: Vec<[usize; 3]> = whole("connectivity").chunks(3).map(|t| t.try_into().unwrap()).collect();
    assert_eq!(whole("offsets"), (1..=triangles.len()).map(|n| 3 * n).collect::<Vec<_>>());
    assert!(array("types", "UInt8").iter().all(|&kind| kind == 5));
    let piece = header.split('<').find(|e| e.starts_with("Piece")).unwrap();
    assert_eq!(attribute(piece, "NumberOfPoints").unwrap(), nodes.len().to_string());
    assert_eq!(attribute(piece, "NumberOfCells").unwrap(), triangles.len().to_string());
    assert!(file.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
    Found {
        nodes,
        heights: points.chunks(3).map(|p| p[2]).collect(),
        triangles,
        levels: array("level", "UInt8").iter().map(|&level| level.into()).collect(),
        targets: floats("target_diameter"),
        quantities: floats("height"),
        markers: small("boundary").into_iter().map(|marker| marker as usize).collect(),
        parts: small("part"),
    }
}

/// Returns the blocks of a compressed array. Each must be as long as the table in the file says.
fn decompressed(array: &[u8]) -> Vec<u8> {
    let word = |n: usize| u64::from_le_bytes(array[8 * n..][..8].try_into().unwrap()) as usize;
    let (blocks, whole, last) = (word(0), word(1), word(2));
    let mut at = 8 * (3 + blocks);
    let mut bytes = Vec::new();
    for block in 0..blocks {
        let before = bytes.len();
        let mut decoder = ZlibDecoder::new(&array[at..at + word(3 + block)]);
        decoder.read_to_end(&mut bytes).unwrap();
        assert_eq!(decoder.total_in() as usize, word(3 + block));
        at += word(3 + block);
        let expected = if block + 1 == blocks && last > 0 { last } else { whole };
        assert_eq!(bytes.len() - before, expected);
    }
    bytes
}

#[test]
fn vtu_marks_the_boundary_and_is_smaller_than_its_arrays() {
    let sample = Sample::fine();
    let file = sample.written(vtu::write);
    let found = read_vtu(&file);
    sample.assert_same(&found);
    let (nodes, triangles) = (found.nodes.len(), found.triangles.len());
    assert!(24 * nodes > 2 * 262_144, "several blocks are wanted");
    assert!(file.len() < (45 * nodes + 38 * triangles) / 3, "{} bytes for {triangles}", file.len());
    let bounds = sample.mesh.lattice().bounds();
    for (place, marker) in found.nodes.iter().zip(found.markers) {
        let on_boundary = place.x == bounds.min.x
            || place.x == bounds.max.x
            || place.y == bounds.min.y
            || place.y == bounds.max.y;
        assert_eq!(marker > 0, on_boundary, "{place}");
    }
}

#[test]
fn csv_reads_back() {
    for sample in Sample::all() {
        let file = String::from_utf8(sample.written(csv::write)).unwrap();
        let mut lines = file.lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let column = |name: &str| header.iter().position(|&h| h == name).unwrap();
        let three = |name: &str| [1, 2, 3].map(|i| column(&format!("{name}{i}")));
        let count = sample.mesh.raw_nodes().len();
        let mut found =
            Found { nodes: vec![DVec2::NAN; count], targets: vec![f64::NAN; count], ..Found::default() };
        let mut across = Vec::new();
        for line in lines {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(fields.len(), header.len());
            let float = |column: usize| -> f64 { fields[column].parse().unwrap() };
            let corners: [usize; 3] = three("v").map(|c| fields[c].parse().unwrap());
            for (i, &corner) in corners.iter().enumerate() {
                found.nodes[corner] = dvec2(float(three("x")[i]), float(three("y")[i]));
                found.targets[corner] = float(three("target")[i]);
                assert_eq!(float(three("height")[i]), sample.quantities[0].values[corner]);
            }
            assert_eq!(fields[column("triangle")], found.triangles.len().to_string());
            found.triangles.push(corners);
            found.levels.push(fields[column("level")].parse().unwrap());
            across.push(three("n").map(|c| fields[c].parse::<usize>().ok()));
            assert_eq!(fields[column("part")], "0");
            for (n, b) in three("n").into_iter().zip(three("b")) {
                let marker: usize = fields[b].parse().unwrap();
                assert_eq!(marker == 0, !fields[n].is_empty());
                let ends = [corners[b - three("b")[0]], corners[(b - three("b")[0] + 1) % 3]];
                marker.checked_sub(1).inspect(|&piece| sample.assert_named(ends, sample.names()[piece]));
            }
        }
        sample.assert_same(&found);
        // Neighbour i lies across the edge from corner i to the next.
        let edges = |t: [usize; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        assert_neighbours(&found.triangles, &across, edges);
    }
}

#[test]
fn node_ele_and_neigh_read_back() {
    for sample in Sample::all() {
        let text = |bytes| without_comments(&String::from_utf8(bytes).unwrap());
        let nodes = text(sample.written(node::write));
        let elements = text(sample.written(node::write_elements));
        let neighbours = text(sample.written(node::write_neighbours));
        let mut found = Found::default();
        assert_eq!(numbers::<usize>(nodes.lines().next().unwrap())[1..], [2, 2, 1]);
        for (n, line) in nodes.lines().skip(1).enumerate() {
            let row = numbers::<f64>(line);
            assert_eq!((row[0], row.len()), ((n + 1) as f64, 6), "numbers start at one");
            found.nodes.push(dvec2(row[1], row[2]));
            found.targets.push(row[3]);
            assert_eq!(row[4], sample.quantities[0].values[n]);
            found.markers.push(row[5] as usize);
        }
        assert_eq!(
            numbers::<usize>(elements.lines().next().unwrap()),
            [sample.mesh.raw_triangle_count(), 3, 1]
        );
        for (n, line) in elements.lines().skip(1).enumerate() {
            let row = numbers::<usize>(line);
            assert_eq!(row[0], n + 1);
            found.triangles.push([row[1] - 1, row[2] - 1, row[3] - 1]);
            found.levels.push(row[4] as u32);
        }
        sample.assert_same(&found);
        let across: Vec<[Option<usize>; 3]> = neighbours
            .lines()
            .skip(1)
            .map(|line| numbers::<i64>(line)[1..].to_vec())
            .map(|row| [row[0], row[1], row[2]].map(|n| usize::try_from(n - 1).ok()))
            .collect();
        // Neighbour i lies opposite corner i.
        let opposite = |t: [usize; 3]| [[t[1], t[2]], [t[2], t[0]], [t[0], t[1]]];
        let boundary = assert_neighbours(&found.triangles, &across, opposite);
        sample.assert_markers(&found.markers);

        let edges = text(sample.written(node::write_edges));
        assert_eq!(numbers::<usize>(edges.lines().next().unwrap()), [sample.mesh.edges().count(), 1]);
        let rows: Vec<Vec<usize>> = edges.lines().skip(1).map(numbers).collect();
        assert!(rows.iter().enumerate().all(|(n, row)| row[0] == n + 1 && row.len() == 4));
        let rows: Vec<_> = rows.iter().map(|row| [row[0], row[1] - 1, row[2] - 1, row[3]]).collect();
        let listed: Vec<_> =
            rows.iter().map(|row| (NodeId::from_index(row[1]), NodeId::from_index(row[2]))).collect();
        assert_eq!(listed, sample.mesh.edges().collect::<Vec<_>>());
        let marked: HashSet<[usize; 2]> =
            rows.iter().filter(|row| row[3] > 0).map(|row| [row[1], row[2]]).collect();
        assert_eq!(marked, boundary.into_iter().collect());
        for row in rows.iter().filter(|row| row[3] > 0) {
            sample.assert_named([row[1], row[2]], sample.names()[row[3] - 1]);
        }
    }
}

#[test]
fn two_dm_reads_back_with_its_boundary() {
    for sample in Sample::all() {
        let (found, strings, names) = read_2dm(&String::from_utf8(sample.written(sms::write)).unwrap());
        assert_eq!(found.nodes.len(), sample.mesh.raw_nodes().len());
        assert_eq!(found.triangles.len(), sample.mesh.raw_triangle_count());
        assert_eq!(found.quantities, sample.quantities[0].values);
        sample.assert_well_made(&found, 1e-9);
        assert_strings_follow_the_boundary(&sample.mesh, &strings);
        assert_eq!(names.len(), strings.len());
        for (name, string) in names.iter().zip(&strings) {
            string.windows(2).for_each(|edge| sample.assert_named([edge[0], edge[1]], name));
            assert_eq!(string.first() == string.last(), name.starts_with("island"), "{name}");
        }
    }
}

#[test]
fn a_nodestring_stays_at_one_piece_of_the_outside() {
    // The mesh lacks the six triangles around each of two nodes; the two hexagons touch in the node between
    // them.
    let left_out = [dvec2(0.375, 0.5), dvec2(0.625, 0.5)];
    let sample = Sample::new(Rect::UNIT, 0.125, |p| !left_out.contains(&p), 0.5);
    let (_, strings, _) = read_2dm(&String::from_utf8(sample.written(sms::write)).unwrap());
    assert_strings_follow_the_boundary(&sample.mesh, &strings);
    let mut edges: Vec<usize> = strings.iter().map(|string| string.len() - 1).collect();
    edges.sort_unstable();
    assert_eq!(edges, [6, 6, 8, 8, 8, 8]);
}

/// Returns the mesh, its nodestrings, and their names.
fn read_2dm(file: &str) -> (Found, Vec<Vec<usize>>, Vec<String>) {
    assert!(file.starts_with("MESH2D\nMESHNAME \"Meshbrush\"\nNUM_MATERIALS_PER_ELEM 1\n"));
    let mut found = Found::default();
    let (mut strings, mut string, mut names) = (Vec::new(), Vec::new(), Vec::new());
    for line in file.lines().skip(3) {
        let (card, rest) = line.split_once(' ').unwrap();
        if let ("#", Some((word, name))) = (card, rest.split_once(": ")) {
            if word.starts_with("nodestring") {
                names.push(name.to_owned());
                assert_eq!(word, format!("nodestring {}", names.len()));
            }
            continue;
        }
        match (card, &numbers::<f64>(rest)[..]) {
            ("E3T", &[id, a, b, c, 1.0]) => {
                found.triangles.push([a, b, c].map(|node| node as usize - 1));
                assert_eq!(id, found.triangles.len() as f64);
            }
            ("ND", &[id, x, y, z]) => {
                found.nodes.push(dvec2(x, y));
                found.quantities.push(z);
                assert_eq!(id, found.nodes.len() as f64);
            }
            ("NS", &[ref nodes @ .., last, id]) if last < 0.0 => {
                string.extend(nodes.iter().map(|&node| node as usize - 1));
                assert!(!string.is_empty(), "py2dm wants two nodes in the first line");
                string.push(-last as usize - 1);
                strings.push(std::mem::take(&mut string));
                assert_eq!(id, strings.len() as f64);
            }
            ("NS", nodes) => string.extend(nodes.iter().map(|&node| node as usize - 1)),
            other => panic!("{other:?} is not expected"),
        }
    }
    assert!(string.is_empty());
    (found, strings, names)
}

/// Checks that the lines together contain each boundary edge once, with the domain to the left.
fn assert_strings_follow_the_boundary(mesh: &Mesh, strings: &[Vec<usize>]) {
    let mut drawn: Vec<[usize; 2]> =
        strings.iter().flat_map(|string| string.windows(2).map(|edge| [edge[0], edge[1]])).collect();
    let mut expected: Vec<[usize; 2]> = mesh.extract().boundary_edges().map(|edge| edge.ends).collect();
    drawn.sort_unstable();
    expected.sort_unstable();
    assert_eq!(drawn, expected);
}

#[test]
fn stl_reads_back() {
    for sample in Sample::all() {
        let file = sample.written(stl::write);
        let triangles = sample.mesh.raw_triangle_count();
        assert_eq!(file.len(), 84 + 50 * triangles);
        assert!(!file.starts_with(b"solid"));
        assert_eq!(file[80..84], (triangles as u32).to_le_bytes());
        let mut found = Found::default();
        for facet in file[84..].chunks(50) {
            let values: Vec<f32> =
                facet[..48].chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
            assert_eq!(facet[48..], [0, 0]);
            let [normal, a, b, c] = [0, 3, 6, 9].map(|n| Vec3::from_slice(&values[n..]));
            assert!(normal.distance((b - a).cross(c - a).normalize()) < 1e-2 && normal.z > 0.0, "{normal}");
            let corners = sample.mesh.extract().cell(TriangleId::from_index(found.triangles.len())).corners;
            assert_eq!([a, b, c].map(|p| p.z), corners.map(|node| sample.height(node) as f32));
            found.triangles.push([0, 1, 2].map(|corner| found.nodes.len() + corner));
            found.nodes.extend(values[3..].chunks(3).map(|p| dvec2(p[0].into(), p[1].into())));
        }
        sample.assert_well_made(&found, 1e-5);
    }
}

#[test]
fn stl_refuses_a_mesh_with_triangles_too_small_for_its_numbers() {
    let far = Rect::new(dvec2(5e6, 5e6), dvec2(5e6 + 1.0, 5e6 + 1.0));
    let sample = Sample::new(far, 0.25, |_| true, 0.01);
    let failed = stl::write(&mut Vec::new(), &sample.mesh.extract(), &sample.data()).unwrap_err();
    assert!(failed.to_string().contains("x = 5000"), "{failed}");
}

/// Checks that neighbours share exactly the edges that they should; returns the edges without a neighbour.
fn assert_neighbours(
    triangles: &[[usize; 3]],
    across: &[[Option<usize>; 3]],
    edges: impl Fn([usize; 3]) -> [[usize; 2]; 3],
) -> Vec<[usize; 2]> {
    let mut owner = HashMap::new();
    for (t, &corners) in triangles.iter().enumerate() {
        for edge in edges(corners) {
            assert_eq!(owner.insert(edge, t), None);
        }
    }
    let mut boundary = Vec::new();
    for (t, &corners) in triangles.iter().enumerate() {
        for (j, [from, to]) in edges(corners).into_iter().enumerate() {
            assert_eq!(across[t][j], owner.get(&[to, from]).copied());
            boundary.extend(across[t][j].is_none().then_some([from, to]));
        }
    }
    boundary
}

#[test]
fn msh_reads_back_with_its_boundary() {
    for sample in Sample::all() {
        let file = String::from_utf8(sample.written(msh::write)).unwrap();
        let (found, boundary) = read_msh(&file);
        sample.assert_same(&found);
        assert_eq!(found.quantities, sample.quantities[0].values);
        // Around the boundary and every hole, each node is left as often as it is reached.
        let mut degree = HashMap::new();
        for (ends, name) in &boundary {
            sample.assert_named(*ends, name);
        }
        let boundary: Vec<[usize; 2]> = boundary.into_iter().map(|(ends, _)| ends).collect();
        for [from, to] in &boundary {
            *degree.entry(from).or_insert(0) += 1;
            *degree.entry(to).or_insert(0) -= 1;
        }
        assert!(degree.values().all(|&d| d == 0));
        let around: f64 = boundary.iter().map(|&[a, b]| 0.5 * found.nodes[a].perp_dot(found.nodes[b])).sum();
        assert!((around / sample.area() - 1.0).abs() < 1e-9);
    }
}

/// Returns the mesh, and its boundary edges with the names of their physical groups.
fn read_msh(file: &str) -> (Found, Vec<([usize; 2], String)>) {
    let section = |name: &str| -> Vec<&str> {
        let body = file.split(&format!("${name}\n")).nth(1).unwrap();
        body.split(&format!("$End{name}\n")).next().unwrap().lines().collect()
    };
    let values = |name: &str, label: &str| -> Vec<f64> {
        let body = file.split(&format!("${name}\n1\n\"{label}\"\n1\n0\n3\n0\n1\n")).nth(1).unwrap();
        let body = body.split(&format!("$End{name}")).next().unwrap();
        let count: usize = body.lines().next().unwrap().parse().unwrap();
        let rows: Vec<Vec<f64>> = body.lines().skip(1).map(numbers).collect();
        assert!(rows.iter().enumerate().all(|(n, row)| row[0] == (n + 1) as f64));
        assert_eq!(rows.len(), count);
        rows.iter().map(|row| row[1]).collect()
    };
    assert_eq!(section("MeshFormat"), ["4.1 0 8"]);
    let names = section("PhysicalNames");
    assert_eq!(names[0], (names.len() - 1).to_string());
    assert_eq!(names[names.len() - 1], "2 1 \"domain\"");
    let curves: Vec<(usize, &str)> = names[1..names.len() - 1]
        .iter()
        .map(|line| line.strip_prefix("1 ").unwrap().split_once(' ').unwrap())
        .map(|(tag, name)| (tag.parse().unwrap(), name.trim_matches('"')))
        .collect();
    let entities: Vec<Vec<f64>> = section("Entities").iter().map(|line| numbers(line)).collect();
    assert_eq!(entities[0], [0.0, curves.len() as f64, 1.0, 0.0]);
    for (row, (tag, _)) in entities[1..].iter().zip(&curves) {
        let tag = *tag as f64;
        assert_eq!((row[0], &row[7..]), (tag, &[1.0, tag, 0.0][..]), "the physical group, and no points");
    }
    let surface = &entities[curves.len() + 1];
    assert_eq!(surface[7..10], [1.0, 1.0, curves.len() as f64]); // physical group 1, and its boundary
    assert!(surface[10..].iter().zip(&curves).all(|(&curve, (tag, _))| curve == *tag as f64));

    let rows = section("Nodes");
    let count = numbers::<usize>(rows[0])[1];
    assert_eq!(numbers::<usize>(rows[0]), [1, count, 1, count]);
    assert_eq!(numbers::<usize>(rows[1]), [2, 1, 0, count]);
    assert_eq!(rows.len(), 2 + 2 * count);
    let places: Vec<Vec<f64>> = rows[2 + count..].iter().map(|line| numbers(line)).collect();
    let heights: Vec<f64> = places.iter().map(|p| p[2]).collect();
    let range =
        [heights.iter().copied().fold(f64::INFINITY, f64::min), heights.iter().copied().fold(-1e9, f64::max)];
    assert_eq!([surface[3], surface[6]], range, "the box around the surface");
    let nodes = places.iter().map(|p| dvec2(p[0], p[1])).collect();

    let rows: Vec<Vec<usize>> = section("Elements").iter().map(|line| numbers(line)).collect();
    let (blocks, all) = (rows[0][0], rows[0][1]);
    assert_eq!((blocks, rows[0][2], rows[0][3]), (1 + curves.len(), 1, all));
    assert_eq!(rows[1][..3], [2, 1, 2]);
    let (triangle_rows, mut rest) = rows[2..].split_at(rows[1][3]);
    let mut lines = Vec::new();
    for (tag, name) in &curves {
        assert_eq!(rest[0][..3], [1, *tag, 1]);
        let (block, others) = rest[1..].split_at(rest[0][3]);
        for (line, tag) in block.iter().zip(triangle_rows.len() + lines.len() + 1..) {
            assert_eq!(line[0], tag);
            lines.push(([line[1] - 1, line[2] - 1], (*name).to_owned()));
        }
        rest = others;
    }
    assert!(rest.is_empty() && triangle_rows.iter().zip(1..).all(|(row, tag)| row[0] == tag));
    assert_eq!(triangle_rows.len() + lines.len(), all);
    assert!(values("ElementData", "part").iter().all(|&part| part == 0.0));
    let levels: Vec<u32> = values("ElementData", "level").iter().map(|&level| level as u32).collect();
    assert_eq!(levels.len(), all);
    let found = Found {
        nodes,
        heights,
        triangles: triangle_rows.iter().map(|t| [t[1] - 1, t[2] - 1, t[3] - 1]).collect(),
        levels: levels[..triangle_rows.len()].to_vec(),
        targets: values("NodeData", "target_diameter"),
        quantities: values("NodeData", "height"),
        ..Found::default()
    };
    (found, lines)
}

#[test]
fn binary_msh_has_the_numbers_of_the_text() {
    for sample in Sample::all() {
        let text = String::from_utf8(sample.written(msh::write)).unwrap();
        let binary = sample.written(msh::write_binary);
        let (words, found) = read_binary_msh(&binary);
        let mut expected: Vec<f64> = Vec::new();
        let mut expected_words = Vec::new();
        let mut section = String::new();
        for line in text.lines() {
            match line.strip_prefix('$') {
                Some(name) if !name.starts_with("End") => section = name.to_owned(),
                Some(_) => {}
                None if ["Entities", "Nodes", "Elements"].contains(&&*section) => {
                    expected.extend(numbers::<f64>(line))
                }
                None if section.ends_with("Data") && line.contains(' ') => {
                    expected.extend(numbers::<f64>(line))
                }
                None => {}
            }
            if section == "PhysicalNames" || section == "Comments" {
                expected_words.push(line.to_owned());
            }
        }
        assert_eq!(words, expected_words);
        assert!(found == expected, "{} and {} numbers", found.len(), expected.len());
    }
}

/// Returns the lines of names and comments, and all numbers of the other sections except counts of data.
fn read_binary_msh(file: &[u8]) -> (Vec<String>, Vec<f64>) {
    let (mut at, mut words, mut found) = (0, Vec::new(), Vec::new());
    let line = |at: &mut usize| {
        let length = file[*at..].iter().position(|&byte| byte == b'\n').unwrap();
        *at += length + 1;
        std::str::from_utf8(&file[*at - length - 1..*at - 1]).unwrap()
    };
    let read = |at: &mut usize, kinds: &str, found: &mut Vec<f64>| -> f64 {
        for kind in kinds.chars() {
            let width = if kind == 'i' { 4 } else { 8 };
            let bytes = &file[*at..*at + width];
            *at += width;
            found.push(match kind {
                'i' => i32::from_le_bytes(bytes.try_into().unwrap()).into(),
                'u' => u64::from_le_bytes(bytes.try_into().unwrap()) as f64,
                _ => f64::from_le_bytes(bytes.try_into().unwrap()),
            });
        }
        *found.last().unwrap()
    };
    while at < file.len() {
        let name = line(&mut at).strip_prefix('$').expect("a section begins").to_owned();
        match name.as_str() {
            "MeshFormat" => {
                assert_eq!(line(&mut at), "4.1 1 8");
                assert_eq!(read(&mut at, "i", &mut Vec::new()), 1.0);
            }
            "PhysicalNames" | "Comments" => {
                words.push(format!("${name}"));
                loop {
                    let text = line(&mut at);
                    words.push(text.to_owned());
                    if text.starts_with("$End") {
                        break;
                    }
                }
                continue;
            }
            "Entities" => {
                read(&mut at, "uuuu", &mut found);
                let curves = found[found.len() - 3];
                for _ in 0..=curves as usize {
                    let groups = read(&mut at, "iffffffu", &mut found);
                    (0..groups as usize).for_each(|_| _ = read(&mut at, "i", &mut found));
                    let bounds = read(&mut at, "u", &mut found);
                    (0..bounds as usize).for_each(|_| _ = read(&mut at, "i", &mut found));
                }
            }
            "Nodes" => {
                read(&mut at, "uuuu", &mut found);
                let count = read(&mut at, "iiiu", &mut found) as usize;
                (0..count).for_each(|_| _ = read(&mut at, "u", &mut found));
                (0..count).for_each(|_| _ = read(&mut at, "fff", &mut found));
            }
            "Elements" => {
                read(&mut at, "uuuu", &mut found);
                let blocks = found[found.len() - 4] as usize;
                for _ in 0..blocks {
                    let count = read(&mut at, "iiiu", &mut found) as usize;
                    let kinds = if found[found.len() - 2] == 1.0 { "uuu" } else { "uuuu" };
                    (0..count).for_each(|_| _ = read(&mut at, kinds, &mut found));
                }
            }
            _ => {
                let head: Vec<&str> = (0..8).map(|_| line(&mut at)).collect();
                let count: usize = head[7].parse().unwrap();
                (0..count).for_each(|_| _ = read(&mut at, "if", &mut found));
            }
        }
        assert_eq!(line(&mut at), "");
        assert_eq!(line(&mut at), format!("$End{name}"));
    }
    (words, found)
}

fn without_comments(text: &str) -> String {
    text.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect()
}

#[test]
fn files_say_where_they_come_from() {
    let sample = &Sample::all()[0];
    let fingerprint = sample.mesh.fingerprint().to_string();
    let command = COMMAND.replace('\n', " ");
    let lines = [
        concat!("program: Meshbrush ", env!("CARGO_PKG_VERSION")).to_owned(),
        format!("command: {command}"),
        format!("fingerprint: {fingerprint}"),
        "coordinates: x, y".to_owned(),
    ];
    let comments: String = lines.iter().map(|line| format!("# {line}\n")).collect();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    assert!(text(sample.written(obj::write)).starts_with(&comments));
    assert!(text(sample.written(sms::write)).contains(&comments));
    for written in [node::write, node::write_elements, node::write_neighbours, node::write_edges] {
        assert!(text(sample.written(written)).ends_with(&comments));
    }
    assert!(
        text(sample.written(msh::write))
            .contains(&format!("$Comments\n{}\n$EndComments\n", lines.join("\n")))
    );
    let stl = sample.written(stl::write);
    let title = std::str::from_utf8(&stl[..80]).unwrap().trim_end();
    assert_eq!(title, format!("Meshbrush {}, fingerprint {fingerprint}", env!("CARGO_PKG_VERSION")));
    let vtu = sample.written(vtu::write);
    let header = String::from_utf8_lossy(&vtu);
    let instruction = header.split("<?meshbrush\n").nth(1).unwrap().split("\n?>").next().unwrap();
    assert_eq!(instruction, lines.join("\n").replace("?>", "? >"));

    let colors = LevelColors::new(Colormap::Viridis, Ground::Dark, 12);
    let (size, background, edges) = ([80, 60], Some([1, 2, 3]), true);
    let style = svg::SvgStyle {
        size,
        fills: svg::SvgFills::Levels(colors.as_table()),
        background,
        edges,
        path: &[],
        path_colors: [[0; 3]; 2],
        marks: &[],
        mark_colors: [[0; 3]; 2],
        unit: None,
        map: None,
        shapes: &[],
    };
    let svg = text(sample.written(|out, mesh, data| svg::write(out, mesh, &style, data.provenance)));
    let description = svg.split("<desc>").nth(1).unwrap().split("</desc>").next().unwrap();
    let escaped = lines.join("\n").replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    assert_eq!(description.trim_end(), escaped);
    let mut picture = Vec::new();
    png::write_described(&mut picture, [1, 1], &[9; 4], None, &sample.provenance).unwrap();
    let picture = String::from_utf8_lossy(&picture);
    assert!(picture.contains(&format!("tEXtFingerprint\0{fingerprint}")), "{picture}");
    assert!(picture.contains(&command), "{picture}");
}

#[test]
fn obj_reads_back() {
    for sample in Sample::all() {
        let file = String::from_utf8(sample.written(obj::write)).unwrap();
        let mut found = Found::default();
        let mut level = None;
        for line in file.lines() {
            let (kind, rest) = line.split_once(' ').unwrap();
            match kind {
                "#" => {}
                "v" => {
                    let p = numbers::<f64>(rest);
                    found.heights.push(p[2]);
                    found.nodes.push(dvec2(p[0], p[1]));
                }
                "vt" => found.targets.push(numbers(rest)[0]),
                "g" => level = rest.strip_prefix("level_").map(|level| level.parse().unwrap()),
                "f" => {
                    let corner = |word: &str| {
                        let (place, texture) = word.split_once('/').unwrap();
                        assert_eq!(place, texture);
                        place.parse::<usize>().unwrap() - 1
                    };
                    let corners: Vec<usize> = rest.split(' ').map(corner).collect();
                    found.triangles.push(corners.try_into().unwrap());
                    found.levels.push(level.unwrap());
                }
                other => panic!("{other} is not expected"),
            }
        }
        sample.assert_same(&found);
    }
}

#[test]
fn ply_reads_back() {
    for sample in Sample::all() {
        let file = sample.written(ply::write);
        let end = file.windows(11).position(|bytes| bytes == b"end_header\n").unwrap() + 11;
        let header = std::str::from_utf8(&file[..end]).unwrap();
        let (nodes, triangles) = (sample.mesh.raw_nodes().len(), sample.mesh.raw_triangle_count());
        let lines: Vec<&str> = header.lines().filter(|line| !line.starts_with("comment")).collect();
        let expected = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {nodes}\nproperty double x\nproperty double y\n\
             property double z\nproperty double quality\nproperty double height\nelement face {triangles}\n\
             property list uchar uint vertex_indices\nend_header"
        );
        assert_eq!(lines.join("\n"), expected);
        let (vertices, faces) = file[end..].split_at(40 * nodes);
        let mut found = Found::default();
        for vertex in vertices.chunks(40) {
            let values: Vec<f64> =
                vertex.chunks(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect();
            found.nodes.push(dvec2(values[0], values[1]));
            found.heights.push(values[2]);
            found.targets.push(values[3]);
            found.quantities.push(values[4]);
        }
        assert_eq!(faces.len(), 13 * triangles);
        for face in faces.chunks(13) {
            assert_eq!(face[0], 3);
            let corner = |n: usize| u32::from_le_bytes(face[n..n + 4].try_into().unwrap()) as usize;
            found.triangles.push([1, 5, 9].map(corner));
        }
        // The format has no levels: they are those of the mesh.
        found.levels = sample.mesh.extract().triangles().iter().map(|triangle| triangle.level()).collect();
        assert_eq!(found.quantities, sample.quantities[0].values);
        sample.assert_same(&found);
    }
}

#[test]
fn glb_reads_back() {
    let far = Rect::new(dvec2(5e6, 6e6), dvec2(5e6 + 8.0, 6e6 + 4.0));
    for sample in Sample::all().into_iter().chain([Sample::new(far, 1.0, |_| true, 0.1)]) {
        let file = sample.written(glb::write);
        let (text, binary) = read_glb(&file);
        let (nodes, triangles) = (sample.mesh.raw_nodes().len(), sample.mesh.raw_triangle_count());
        let extras = &text["nodes"][0]["extras"];
        let origin = [0, 1, 2].map(|axis| extras["origin"][axis].as_f64().unwrap());
        assert_eq!(extras["metres_per_unit"], serde_json::json!([1.0, 1.0]));
        let floats: Vec<f32> =
            binary.chunks(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect();
        let vector = |n: usize| Vec3::from_slice(&floats[3 * n..]).as_dvec3();
        let mut found = Found::default();
        for node in 0..nodes {
            let (p, expected) = (vector(node), sample.mesh.world(NodeId::from_index(node)));
            found.nodes.push(dvec2(p.x, -p.z));
            let place = dvec2(origin[0] + p.x, origin[1] - p.z);
            assert!(place.distance(expected) < 1e-5, "{place} {expected}");
            assert!((origin[2] + p.y - sample.height(node)).abs() < 1e-6);
            for (axis, value) in p.to_array().into_iter().enumerate() {
                let bound = |key: &str| text["accessors"][0][key][axis].as_f64().unwrap();
                assert!(bound("min") <= value && value <= bound("max"));
            }
        }
        let indices: Vec<usize> = binary[24 * nodes..]
            .chunks(4)
            .map(|b| u32::from_le_bytes(b.try_into().unwrap()) as usize)
            .collect();
        found.triangles = indices.chunks(3).map(|corners| corners.try_into().unwrap()).collect();
        assert_eq!(found.triangles.len(), triangles);
        let mut sums = vec![DVec3::ZERO; nodes];
        for corners in &found.triangles {
            let [a, b, c] = corners.map(vector);
            corners.iter().for_each(|&node| sums[node] += (b - a).cross(c - a));
        }
        for (node, sum) in sums.iter().enumerate() {
            let normal = vector(nodes + node);
            assert!(normal.distance(sum.normalize()) < 1e-3 && normal.y > 0.0, "{normal} {sum}");
        }
        sample.assert_well_made(&found, 1e-4);
    }
}

/// Returns the description of a file and its numbers.
fn read_glb(file: &[u8]) -> (serde_json::Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&file[..4], word(4), word(8)), (&b"glTF"[..], 2, file.len()));
    let length = word(12);
    assert_eq!((&file[16..20], length % 4), (&b"JSON"[..], 0));
    let text: serde_json::Value = serde_json::from_slice(&file[20..20 + length]).unwrap();
    let binary = &file[28 + length..];
    assert_eq!((&file[24 + length..28 + length], word(20 + length)), (&b"BIN\0"[..], binary.len()));
    assert_eq!(text["buffers"][0]["byteLength"], binary.len());
    let views = text["bufferViews"].as_array().unwrap();
    let whole: u64 = views.iter().map(|view| view["byteLength"].as_u64().unwrap()).sum();
    assert_eq!(whole as usize, binary.len());
    (text, binary)
}

#[test]
fn glb_is_in_metres() {
    let sample = Sample::new(Rect::new(dvec2(10.0, 59.5), dvec2(11.0, 60.5)), 0.5, |_| true, 0.1);
    for (unit, width, height) in [
        (LengthUnit::Metre, 1.0, 1.0),
        (LengthUnit::Kilometre, 1e3, 1e3),
        // Half of what it is at the equator.
        (LengthUnit::Degree, 55_597.5, 111_195.1),
    ] {
        let provenance = sample.provenance.clone().with_unit(unit);
        let file = sample
            .written(|out, mesh, data| glb::write(out, mesh, &MeshData { provenance: &provenance, ..*data }));
        let (text, _) = read_glb(&file);
        let bound = |key: &str, axis: usize| text["accessors"][0][key][axis].as_f64().unwrap();
        for (axis, expected) in [(0, width), (2, height)] {
            let extent = bound("max", axis) - bound("min", axis);
            assert!((extent / expected - 1.0).abs() < 1e-5, "{unit:?}: {extent}");
        }
    }
}

#[test]
fn two_dm_has_the_surface_as_z_where_there_is_no_other_quantity() {
    let sample = Sample { quantities: Vec::new(), ..Sample::all().remove(1) };
    let (found, ..) = read_2dm(&String::from_utf8(sample.written(sms::write)).unwrap());
    assert_eq!(Some(found.quantities), sample.heights);
}

#[test]
fn targets_are_read_by_the_formats_that_have_them_only() {
    let sample = Sample::all().remove(0);
    let folder = std::env::temp_dir().join(format!("meshbrush-targets-{}", std::process::id()));
    for format in MeshFormat::all().flat_map(|format| [Some(format), format.binary()]).flatten() {
        let written = |target_diameter: &[f64]| {
            let data = MeshData { target_diameter, ..sample.data() };
            let files =
                format.write(&folder.join("m.file"), &sample.mesh.extract(), &data, &Meter::default());
            files.unwrap().into_iter().map(|file| std::fs::read(file).unwrap()).collect::<Vec<_>>()
        };
        std::fs::create_dir_all(&folder).unwrap();
        let default = written(&sample.targets);
        match format.has_targets() {
            true => assert!(default != written(&vec![0.125; sample.targets.len()]), "{format:?}"),
            false => assert!(default == written(&[]), "{format:?}"),
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}

#[test]
fn files_are_the_same_for_any_number_of_threads() {
    let sample = Sample::fine();
    let (extract, data, meter) = (sample.mesh.extract(), sample.data(), Meter::default());
    for format in MeshFormat::all().flat_map(|format| [Some(format), format.binary()]).flatten() {
        let on_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut bytes = Vec::new();
            pool.install(|| format.write_to(&mut bytes, &extract, &data, &meter).map(Result::unwrap));
            bytes
        };
        let expected = on_threads(1);
        for threads in [2, 3, 8] {
            assert!(on_threads(threads) == expected, "{format:?}, {threads} threads");
        }
    }
}

#[test]
fn svg_shows_every_triangle_and_every_edge_once() {
    let colors = LevelColors::new(Colormap::Viridis, Ground::Dark, 12);
    for sample in Sample::all() {
        let style = svg::SvgStyle {
            size: [800, 600],
            fills: svg::SvgFills::Levels(colors.as_table()),
            background: Some([1, 2, 3]),
            edges: true,
            path: &[],
            path_colors: [[0; 3]; 2],
            marks: &[],
            mark_colors: [[0; 3]; 2],
            unit: None,
            map: None,
            shapes: &[],
        };
        let file = String::from_utf8(
            sample.written(|out, mesh, data| svg::write(out, mesh, &style, data.provenance)),
        )
        .unwrap();
        let view_box = numbers::<f64>(file.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap());
        let bounds = sample.mesh.lattice().bounds();
        let scale = bounds.size() / dvec2(view_box[2], view_box[3]);
        let mut found = Found::default();
        let mut node_at: BTreeMap<[i64; 2], usize> = BTreeMap::new();
        let (mut drawn_edges, mut edges) = (0, HashSet::new());
        for path in file.split("<path ").skip(1) {
            let data = path.split(" d=\"").nth(1).unwrap().split('"').next().unwrap();
            let scale_of = |rest: &str| rest.split(')').next().unwrap().parse().unwrap();
            let enlarged: i64 = path.split("scale(").nth(1).map_or(1, scale_of);
            let mut lines = path_points(data);
            lines.iter_mut().flatten().flatten().for_each(|step| *step *= enlarged);
            let Some(id) = path.strip_prefix("id=\"level-") else {
                for line in lines.iter().flat_map(|line| line.windows(2)) {
                    let mut ends = [line[0], line[1]];
                    ends.sort_unstable();
                    edges.insert(ends);
                    drawn_edges += 1;
                }
                continue;
            };
            let level: u32 = id.split('"').next().unwrap().parse().unwrap();
            let [r, g, b, _] = colors.of(level as u8);
            assert!(path.contains(&format!("fill=\"#{r:02x}{g:02x}{b:02x}\"")));
            for corners in lines {
                let triangle: Vec<usize> = corners
                    .iter()
                    .map(|&place| {
                        *node_at.entry(place).or_insert_with(|| {
                            let place = dvec2(place[0] as f64, view_box[3] - place[1] as f64);
                            found.nodes.push(bounds.min + place * scale);
                            found.nodes.len() - 1
                        })
                    })
                    .collect();
                // The line is drawn over the apex, in either direction.
                let [a, apex, b] = triangle.try_into().unwrap();
                let turn = (found.nodes[b] - found.nodes[a]).perp_dot(found.nodes[apex] - found.nodes[a]);
                found.triangles.push(if turn > 0.0 { [a, b, apex] } else { [b, a, apex] });
                found.levels.push(level);
            }
        }
        assert_eq!(found.nodes.len(), sample.mesh.raw_nodes().len());
        assert_eq!(found.triangles.len(), sample.mesh.raw_triangle_count());
        let at_level = |l: usize| found.levels.iter().filter(|&&level| level as usize == l).count();
        let counts = sample.mesh.level_counts();
        assert_eq!((0..counts.len()).map(at_level).collect::<Vec<_>>(), counts);
        assert_eq!((drawn_edges, edges.len()), (sample.mesh.edges().count(), sample.mesh.edges().count()));
        sample.assert_well_made(&found, 1e-9);
    }
}

/// Returns the corners of each piece of a path of M, m, h, v, l and z.
fn path_points(data: &str) -> Vec<Vec<[i64; 2]>> {
    let mut pieces: Vec<Vec<[i64; 2]>> = Vec::new();
    let mut at = [0, 0];
    for (start, letter) in data.match_indices(|c: char| c.is_ascii_alphabetic()) {
        let rest = &data[start + 1..];
        let rest = rest.split(|c: char| c.is_ascii_alphabetic()).next().unwrap();
        let steps = numbers::<i64>(&rest.replace('-', " -"));
        let step = match (letter, &steps[..]) {
            ("M" | "m" | "l", &[dx, dy]) => [dx, dy],
            ("h", &[dx]) => [dx, 0],
            ("v", &[dy]) => [0, dy],
            ("z", &[]) => {
                at = pieces.last().unwrap()[0];
                continue;
            }
            other => panic!("{other:?} is not expected"),
        };
        at = [at[0] + step[0], at[1] + step[1]];
        if letter.eq_ignore_ascii_case("m") {
            pieces.push(Vec::new());
        }
        pieces.last_mut().unwrap().push(at);
    }
    pieces
}
