//! Weirs in the files of ADCIRC, read by a reader that knows only the format: pairs of nodes at one place on
//! both sides of a crack, and the boundary around them.

use std::collections::{BTreeMap, BTreeSet};

use crate::folder::Folder;
use crate::runs::seeds;
use meshbrush_io::io::Meter;
use meshbrush_io::io::project::Project;
use meshbrush_io::io::recipe::{OpenedRecipe, RecipeFiles, open};

/// A string of nodes; of a weir the nodes at its front.
#[derive(Clone, Debug, Default)]
struct BoundaryList {
    kind: u32,
    name: String,
    nodes: Vec<usize>,
    /// Of a weir for each node the one at the back, and three numbers.
    backs: Vec<(usize, [f64; 3])>,
}

/// What a `fort.14` has. Numbers start at zero.
#[derive(Clone, Debug, Default)]
struct Grid {
    nodes: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    open: Vec<BoundaryList>,
    land: Vec<BoundaryList>,
}

impl Grid {
    fn read(text: &str) -> Self {
        let mut lines = text.lines().skip(1);
        let mut row = |count: usize| -> Vec<f64> {
            let words = lines.next().unwrap().split_whitespace().take(count);
            words.map(|word| word.parse().unwrap()).collect()
        };
        let sizes = row(2);
        let nodes = (1..=sizes[1] as usize).map(|id| {
            let row = row(4);
            assert_eq!(row[0] as usize, id);
            [row[1], row[2], row[3]]
        });
        let nodes = nodes.collect();
        let triangles = (1..=sizes[0] as usize).map(|id| {
            let row = row(5);
            assert_eq!([row[0] as usize, row[1] as usize], [id, 3]);
            [row[2], row[3], row[4]].map(|node| node as usize - 1)
        });
        let triangles = triangles.collect();
        let rest: Vec<&str> = lines.collect();
        let mut rest = rest.into_iter();
        let open = lists(&mut rest);
        let land = lists(&mut rest);
        assert_eq!(rest.next(), None);
        Self { nodes, triangles, open, land }
    }

    fn weirs(&self) -> impl Iterator<Item = &BoundaryList> {
        self.land.iter().filter(|list| matches!(list.kind, 4 | 24))
    }

    fn at(&self, node: usize) -> [u64; 2] {
        [self.nodes[node][0].to_bits(), self.nodes[node][1].to_bits()]
    }

    /// The edges of triangles with the domain on the left, and nothing on the right.
    fn boundary(&self) -> BTreeSet<[usize; 2]> {
        let edges = || self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let all: BTreeSet<[usize; 2]> = edges().collect();
        assert_eq!(all.len(), edges().count(), "an edge twice in one direction");
        all.iter().copied().filter(|&[a, b]| !all.contains(&[b, a])).collect()
    }

    /// The mesh with nodes at one place joined: the nodes that come first, and the triangles with these.
    fn joined(&self) -> (Vec<[f64; 3]>, Vec<[usize; 3]>) {
        let mut first: BTreeMap<[u64; 2], usize> = BTreeMap::new();
        let own: Vec<usize> =
            (0..self.nodes.len()).map(|node| *first.entry(self.at(node)).or_insert(node)).collect();
        let kept = own.iter().enumerate().take_while(|(node, own)| node == *own).count();
        assert_eq!(first.len(), kept, "the doubled nodes are the last ones");
        let triangles = self.triangles.iter().map(|corners| corners.map(|node| own[node])).collect();
        (self.nodes[..kept].to_vec(), triangles)
    }

    /// Checks what holds for any mesh with weirs. Returns the boundary edges beside doubled nodes that no list
    /// has: those at tips and where weirs meet.
    fn check(&self) -> BTreeSet<[usize; 2]> {
        let (mut left, all) = (self.boundary(), self.boundary());
        let mut take = |edge: [usize; 2], name: &str| assert!(left.remove(&edge), "{name}: {edge:?}");
        for list in self.open.iter().chain(&self.land) {
            assert!(list.nodes.len() > 1, "{}: {:?}", list.name, list.nodes);
            list.nodes.windows(2).for_each(|ends| take([ends[0], ends[1]], &list.name));
            let ends = [list.nodes[list.nodes.len() - 1], list.nodes[0]];
            // An island does not repeat its first node, nor does a boundary that is open all around.
            if list.kind % 10 == 1 || (list.kind == 0 && all.contains(&ends)) {
                take(ends, &list.name);
            }
            for (&front, (back, _)) in list.nodes.iter().zip(&list.backs) {
                assert!(front != *back && self.nodes[front] == self.nodes[*back], "{}: a pair", list.name);
            }
            list.backs.windows(2).for_each(|ends| take([ends[1].0, ends[0].0], &list.name));
        }
        let mut partner: BTreeMap<usize, usize> = BTreeMap::new();
        for list in self.weirs() {
            for (&front, &(back, _)) in list.nodes.iter().zip(&list.backs) {
                for (node, other) in [(front, back), (back, front)] {
                    assert_eq!(*partner.entry(node).or_insert(other), other, "a node in two pairs");
                }
            }
        }
        let mut open: Vec<usize> = self.open.iter().flat_map(|list| list.nodes.clone()).collect();
        let count = open.len();
        open.sort_unstable();
        open.dedup();
        assert_eq!(open.len(), count, "an open node twice");
        // What is left are both sides of edges of a crack.
        let places: BTreeSet<[[u64; 2]; 2]> =
            left.iter().map(|&edge| edge.map(|node| self.at(node))).collect();
        assert!(places.iter().all(|&[a, b]| places.contains(&[b, a])), "an edge of the boundary in no list");
        left
    }
}

/// Reads how many strings there are, and the strings.
fn lists<'a>(lines: &mut impl Iterator<Item = &'a str>) -> Vec<BoundaryList> {
    let mut line = || lines.next().unwrap();
    let first = |line: &str| line.split_whitespace().next().unwrap().parse::<usize>().unwrap();
    let (count, total) = (first(line()), first(line()));
    let mut all = Vec::new();
    for _ in 0..count {
        let (head, name) = line().split_once(": ").unwrap();
        let head: Vec<&str> = head.split_whitespace().collect();
        let mut list =
            BoundaryList { kind: head[1].parse().unwrap(), name: name.into(), ..Default::default() };
        for _ in 0..head[0].parse().unwrap() {
            let row: Vec<f64> = line().split_whitespace().map(|word| word.parse().unwrap()).collect();
            list.nodes.push(row[0] as usize - 1);
            match row[1..] {
                [] => assert!(!matches!(list.kind, 4 | 24)),
                [back, height, low, high] => list.backs.push((back as usize - 1, [height, low, high])),
                _ => panic!("{row:?}"),
            }
        }
        all.push(list);
    }
    assert_eq!(all.iter().map(|list| list.nodes.len() + list.backs.len()).sum::<usize>(), total);
    all
}

fn distance(p: [f64; 3], [a, b]: [[f64; 2]; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [p[0] - a[0], p[1] - a[1]];
    let share = (along[0] * to[0] + along[1] * to[1]) / (along[0] * along[0] + along[1] * along[1]);
    let share = share.clamp(0.0, 1.0);
    f64::hypot(to[0] - share * along[0], to[1] - share * along[1])
}

/// A recipe with these lines, over a square of water that is 20 deep.
fn recipe(lines: &str) -> String {
    format!(
        "[domain]\nbounds = [0, 0, 1, 1]\n\n[mesh]\nspacing = 0.1\n\n[[layer]]\nkind = \"formula\"\nquantity = \"diameter\"\n\
         formula = \"0.04\"\n\n{lines}\n"
    )
}

fn weir(name: &str, points: &str, more: &str) -> String {
    format!("[[line]]\nname = \"{name}\"\npoints = {points}\ntype = \"weir\"\n{more}\n\n")
}

/// Writes the mesh of a recipe with these lines for ADCIRC, and returns it with what was said.
fn written(folder: &Folder, lines: &str, options: &str) -> (Grid, String) {
    folder.file("weirs.toml", recipe(lines));
    let ran = folder.run(format!("mesh weirs.toml --quantity depth=20 -o weirs.14 {options}"));
    assert_eq!(ran.status, 0, "{}", ran.err);
    (Grid::read(&folder.read("weirs.14")), ran.err)
}

/// Checks that the mesh with nodes at one place joined is that of the same lines without weirs.
fn check_joined(folder: &Folder, grid: &Grid, lines: &str) {
    let without: String = lines
        .lines()
        .filter(|line| {
            !["type", "crest", "subcritical", "supercritical"].iter().any(|key| line.starts_with(key))
        })
        .map(|line| format!("{line}\n"))
        .collect();
    folder.file("plain.toml", recipe(&without));
    let ran = folder.run("mesh plain.toml --quantity depth=20 -o plain.14");
    assert_eq!(ran.status, 0, "{}", ran.err);
    let plain = Grid::read(&folder.read("plain.14"));
    assert_eq!(plain.weirs().count(), 0);
    assert_eq!(plain.check(), BTreeSet::new());
    assert_eq!(grid.joined(), (plain.nodes, plain.triangles));
}

const BEND: [[f64; 2]; 3] = [[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]];

#[test]
fn a_weir_is_a_crack_with_pairs_of_nodes_on_both_sides() {
    let folder = Folder::new("weirs-crack");
    let lines = weir("dike", "[[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]", "crest = 2.5\nsubcritical = 0.8");
    let (grid, said) = written(&folder, &lines, "--quantity manning=if(x>0.5,0.02,0.03)");
    let left = grid.check();
    check_joined(&folder, &grid, &lines);
    let weirs: Vec<&BoundaryList> = grid.weirs().collect();
    let [dike] = weirs[..] else { panic!("{weirs:?}") };
    assert_eq!((dike.kind, &*dike.name), (24, "dike"));
    assert!(dike.nodes.len() > 15, "{}", dike.nodes.len());
    let numbers: BTreeSet<[u64; 3]> = dike.backs.iter().map(|(_, row)| row.map(f64::to_bits)).collect();
    assert_eq!(numbers, BTreeSet::from([[2.5f64, 0.8, 1.0].map(f64::to_bits)]));
    // The pairs are on the line, and the ends of the line are single nodes.
    for &node in &dike.nodes {
        let off = BEND.windows(2).map(|ends| distance(grid.nodes[node], [ends[0], ends[1]]));
        assert!(off.fold(f64::INFINITY, f64::min) < 2e-9);
    }
    let doubled = |at: [f64; 2]| {
        grid.nodes.iter().filter(|node| f64::hypot(node[0] - at[0], node[1] - at[1]) < 2e-9).count()
    };
    assert_eq!(BEND.map(doubled), [1, 2, 1]);
    assert_eq!(left.len(), 4, "both sides of the edges at the tips: {left:?}");
    // No triangle has nodes of both sides.
    let fronts: BTreeSet<usize> = dike.nodes.iter().copied().collect();
    let backs: BTreeSet<usize> = dike.backs.iter().map(|(back, _)| *back).collect();
    assert!(fronts.is_disjoint(&backs));
    for triangle in &grid.triangles {
        let has = |side: &BTreeSet<usize>| triangle.iter().any(|node| side.contains(node));
        assert!(!(has(&fronts) && has(&backs)), "{triangle:?}");
    }
    // The front is on the left: the domain there is on the left of the line.
    let front = grid
        .triangles
        .iter()
        .find(|triangle| dike.nodes.windows(2).any(|ends| ends.iter().all(|node| triangle.contains(node))));
    let middle = front.unwrap().iter().fold([0.0; 2], |sum, &node| {
        [sum[0] + grid.nodes[node][0] / 3.0, sum[1] + grid.nodes[node][1] / 3.0]
    });
    let side = BEND.windows(2).map(|ends| {
        let [a, b] = [ends[0], ends[1]];
        let off = distance([middle[0], middle[1], 0.0], [a, b]);
        (off, (b[0] - a[0]) * (middle[1] - a[1]) - (b[1] - a[1]) * (middle[0] - a[0]))
    });
    assert!(side.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap().1 > 0.0);
    assert!(!said.contains("gap") && !said.contains("left out"), "{said}");
    // Attributes have a value at each of the nodes.
    let attributes = folder.read("weirs.13");
    assert_eq!(attributes.lines().nth(1), Some(&*grid.nodes.len().to_string()));
    let others = attributes.lines().skip(8);
    let ours: BTreeSet<usize> =
        others.map(|line| line.split_whitespace().next().unwrap().parse::<usize>().unwrap() - 1).collect();
    let (low, high): (Vec<usize>, Vec<usize>) = (0..grid.nodes.len()).partition(|&n| grid.nodes[n][0] > 0.5);
    assert!(ours == low.iter().copied().collect() || ours == high.into_iter().collect());
}

#[test]
fn a_weir_that_ends_on_the_boundary_opens_it() {
    let folder = Folder::new("weirs-outline");
    // From the west side, which is open, to the east side, which is land, and one from the north, also land.
    let lines = weir("dam", "[[0, 0.4], [0.5, 0.45], [1, 0.4]]", "crest = 1")
        + &weir("groyne", "[[0.3, 1.2], [0.3, 0.8]]", "crest = 1.5");
    let land = [[0.5, 0.0], [1.0, 0.5], [0.5, 1.0]].map(|at| format!("{{ at = {at:?}, type = \"land\" }}"));
    let types = format!("bounds = [0, 0, 1, 1]\ntypes = [{}]", land.join(", "));
    let text = recipe(&lines).replace("bounds = [0, 0, 1, 1]", &types);
    folder.file("a.toml", text);
    let ran = folder.run("mesh a.toml --quantity depth=20 -o a.14");
    assert_eq!(ran.status, 0, "{}", ran.err);
    let grid = Grid::read(&folder.read("a.14"));
    let left = grid.check();
    assert_eq!(left.len(), 2, "the tip of the groyne: {left:?}");
    assert_eq!(grid.weirs().count(), 2);
    let dam = grid.weirs().find(|list| list.name == "dam").unwrap();
    let ends = [0, dam.nodes.len() - 1].map(|n| [dam.nodes[n], dam.backs[n].0]);
    assert_eq!(ends.map(|[front, _]| grid.nodes[front][0].round()), [0.0, 1.0]);
    // One string of the boundary ends at one node of the pair, and another begins at the other.
    for [front, back] in ends {
        let strings = || grid.open.iter().chain(&grid.land).filter(|list| list.backs.is_empty());
        let begins: Vec<usize> = strings().map(|list| list.nodes[0]).collect();
        let stops: Vec<usize> = strings().map(|list| list.nodes[list.nodes.len() - 1]).collect();
        let parted = [[front, back], [back, front]];
        assert!(
            parted.into_iter().any(|[from, to]| begins.contains(&from) && stops.contains(&to)),
            "{begins:?} {stops:?} {front} {back}"
        );
    }
    assert_eq!(grid.open.len(), 2, "the open side is parted: {:?}", grid.open);
    let at_sea = |list: &&BoundaryList| list.nodes.iter().all(|&node| grid.nodes[node][0].abs() < 1e-9);
    assert!(grid.open.iter().filter(at_sea).count() == 2);
}

#[test]
fn weirs_may_be_closed_meet_and_touch_islands() {
    let folder = Folder::new("weirs-many");
    let lines = weir("ring", "[[0.6, 0.6], [0.85, 0.6], [0.7, 0.85]]", "closed = true\ncrest = 3")
        + &weir("long", "[[0.1, 0.2], [0.9, 0.2]]", "crest = 2")
        + &weir("branch", "[[0.5, 0.2], [0.5, 0.5]]", "crest = 2")
        + &weir("again", "[[0.2, 0.2], [0.4, 0.2]]", "crest = 7");
    let (grid, said) = written(&folder, &lines, "");
    let left = grid.check();
    check_joined(&folder, &grid, &lines);
    let named = |name: &str| grid.weirs().filter(|list| list.name == name).collect::<Vec<_>>();
    let [ring] = named("ring")[..] else { panic!() };
    assert!(ring.nodes.first() == ring.nodes.last() && ring.backs.first() == ring.backs.last());
    assert_eq!(named("long").len(), 2, "parted where the branch begins");
    assert_eq!((named("branch").len(), named("again").len()), (1, 0));
    assert!(said.contains("Weirs meet at one place at x = 0.5, y = 0.2"), "{said}");
    assert!(
        said.contains("“again”: 5 edges that an earlier weir has") || said.contains("“again”:"),
        "{said}"
    );
    // Three tips, and three edges where three weirs meet, each with two sides.
    assert_eq!(left.len(), 2 * (3 + 3), "{left:?}");
    // An island whose shore a weir touches is no closed string any more.
    let island = r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1],[0,1],[0,0]],[[0.4,0.4],[0.4,0.6],[0.6,0.6],[0.6,0.4],[0.4,0.4]]]}"#;
    folder.file("island.geojson", island);
    let text = recipe(&weir("mole", "[[0.5, 0.5], [0.85, 0.52]]", "crest = 4"))
        .replace("bounds = [0, 0, 1, 1]", "region = \"island.geojson\"\nboundary_diameter = 0.05");
    folder.file("b.toml", text);
    let ran = folder.run("mesh b.toml --quantity depth=20 -o b.14 -o b.gr3");
    assert_eq!(ran.status, 0, "{}", ran.err);
    let grid = Grid::read(&folder.read("b.14"));
    assert_eq!(grid.check().len(), 2);
    assert_eq!(grid.weirs().count(), 1);
    assert!(grid.land.iter().all(|list| list.kind % 10 != 1), "{:?}", grid.land);
    assert!(ran.err.contains("b.gr3 has no place for crests: the weir is edges"), "{}", ran.err);
}

#[test]
fn crests_come_from_numbers_profiles_and_grids() {
    let folder = Folder::new("weirs-crests");
    // A grid of heights 3 + 2 x + y, linear between the centres of its pixels.
    let (columns, rows) = (24, 16);
    let height = |x: f64, y: f64| 3.0 + 2.0 * x + y;
    let mut text = format!(
        "ncols {columns}\nnrows {rows}\nxllcorner -0.1\nyllcorner -0.1\ncellsize 0.1\nNODATA_value -99\n"
    );
    for row in 0..rows {
        let y = -0.1 + 0.1 * (f64::from(rows - row) - 0.5);
        let values = (0..columns).map(|column| height(-0.1 + 0.1 * (f64::from(column) + 0.5), y).to_string());
        text += &(values.collect::<Vec<_>>().join(" ") + "\n");
    }
    folder.file("crest.asc", &text);
    let lines = weir("grid", "[[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]", "crest = \"crest.asc\"")
        + &weir("profile", "[[0.2, 0.8], [0.6, 0.8]]", "crest = [[0, 1], [0.5, 2], [1, 1.5]]");
    let (grid, _) = written(&folder, &lines, "");
    grid.check();
    let [of_grid, of_profile] = grid.weirs().collect::<Vec<_>>()[..] else { panic!() };
    for (&node, (_, [crest, low, high])) in of_grid.nodes.iter().zip(&of_grid.backs) {
        let [x, y, _] = grid.nodes[node];
        assert!((crest - height(x, y)).abs() < 1e-3, "{crest} at {x}, {y}");
        assert_eq!([*low, *high], [1.0, 1.0]);
    }
    for (&node, (_, [crest, ..])) in of_profile.nodes.iter().zip(&of_profile.backs) {
        let share = (grid.nodes[node][0] - 0.2) / 0.4;
        let expected = if share < 0.5 { 1.0 + 2.0 * share } else { 2.0 - (share - 0.5) };
        assert!((crest - expected).abs() < 1e-7, "{crest} at a share of {share}");
    }
    let heights = |list: &BoundaryList| {
        list.backs.iter().map(|(_, row)| row[0].to_bits()).collect::<BTreeSet<_>>().len()
    };
    assert!(heights(of_grid) > 10 && heights(of_profile) > 5);
    // Saved as a recipe, the crest is a profile, and the file the same but for its first line.
    let OpenedRecipe { document, .. } = open(&folder.0.join("weirs.toml"), &Meter::default()).unwrap();
    let saved = folder.0.join("saved.toml");
    RecipeFiles::new(&Project::of(&document), &saved).write(&Meter::default()).unwrap();
    assert_eq!(folder.run("mesh saved.toml --quantity depth=20 -o saved.14").status, 0);
    let body = |name: &str| folder.read(name).split_once('\n').unwrap().1.to_owned();
    assert_eq!(body("saved.14"), body("weirs.14"));
}

#[test]
fn what_a_weir_cannot_be_is_said() {
    let folder = Folder::new("weirs-said");
    let points = "[[0.2, 0.3], [0.8, 0.3]]";
    let plain = format!("[[line]]\nname = \"a\"\npoints = {points}\n");
    for (lines, sentence) in [
        (format!("{plain}crest = 2"), "this is for a weir, and the line is none"),
        (format!("{plain}supercritical = 2"), "this is for a weir, and the line is none"),
        (format!("{plain}type = \"weir\""), "a weir needs `crest`"),
        (format!("{plain}type = \"dike\""), "dike"),
        (weir("a", points, "crest = nan"), "a crest of NaN is no height"),
        (weir("a", points, "crest = [[0.5, 1], [0.2, 1]]"), "has the share 0.2"),
        (weir("a", points, "crest = []"), "is empty"),
        (weir("a", points, "crest = true"), "a crest is a height in metres"),
        (weir("a", points, "crest = 2\nsubcritical = -1"), "a coefficient of -1"),
        (weir("a", points, "crest = \"gone.asc\""), "gone.asc"),
    ] {
        folder.file("bad.toml", recipe(&lines));
        let ran = folder.run("mesh bad.toml");
        assert!(ran.status != 0 && ran.err.contains(sentence), "{lines}: {}", ran.err);
    }
    // ADCIRC ends where a crest is below the ground.
    folder.file("low.toml", recipe(&weir("low", points, "crest = -3")));
    let ran = folder.run("mesh low.toml --quantity depth=2 -o low.14");
    assert!(
        ran.status == 1 && ran.err.contains("is not above the ground, and that of \"low\""),
        "{}",
        ran.err
    );
    assert!(!folder.has("low.14") && folder.run("mesh low.toml --quantity depth=4 -o low.14").status == 0);
    // A gap, a weir along the outline, and one that is too short.
    let lines = weir("gap", "[[0.2, 0.5], [0.5, 0.5], [0.5, 0.501], [0.8, 0.501]]", "crest = 2")
        + &weir("side", "[[0.1, 0], [0.6, 0]]", "crest = 2")
        + &weir("short", "[[0.3, 0.7], [0.34, 0.7]]", "crest = 2")
        + &weir("away", "[[3, 3], [4, 4]]", "crest = 2");
    let (grid, said) = written(&folder, &lines, "");
    grid.check();
    for sentence in [
        "The weir “gap” has a gap at x = 0.5",
        "The weir “side”:",
        "on the boundary cannot be a weir inside",
        "The weir “short”:",
        "a weir needs three edges",
        "The weir “away” has no edge in the mesh",
    ] {
        assert!(said.contains(sentence), "{sentence}: {said}");
    }
    let names: BTreeSet<&str> = grid.weirs().map(|list| &*list.name).collect();
    assert_eq!(names, BTreeSet::from(["gap"]));
}

#[test]
fn meshes_without_weirs_and_other_formats_stay_as_they_are() {
    let folder = Folder::new("weirs-others");
    let lines = weir("dike", "[[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]", "crest = 2.5");
    folder.file("weir.toml", recipe(&lines));
    folder.file("line.toml", recipe(&lines.replace("type = \"weir\"\ncrest = 2.5\n", "")));
    let files = ["2dm", "gr3", "slf", "nc", "msh", "vtu", "mesh"];
    let outputs = |name: &str| files.map(|ending| format!("-o {name}.{ending}")).join(" ");
    let answers = ["weir", "line"].map(|name| {
        let answer = folder.json("mesh", format!("{name}.toml --quantity depth=20 {}", outputs("same")));
        let read = files.map(|ending| folder.bytes(&format!("same.{ending}")));
        (answer["hash"].clone(), answer["lines"].clone(), read)
    });
    let [(hash, lines, of_weir), (other, others, of_line)] = answers;
    assert_eq!((hash, lines), (other, others));
    for ((one, other), ending) in of_weir.iter().zip(&of_line).zip(files) {
        // The header has the command, and so the name of the recipe.
        assert_eq!(one.len(), other.len(), "{ending}");
        let differing = one.iter().zip(other).filter(|(a, b)| a != b).count();
        assert!(differing <= 64, "{ending}: {differing} bytes");
    }
}

#[test]
fn finer_meshes_of_a_sequence_have_the_same_weirs() {
    let folder = Folder::new("weirs-sequence");
    let lines = weir("dike", "[[0.2, 0.3], [0.55, 0.4], [0.7, 0.75]]", "crest = [[0, 1], [1, 2]]");
    folder.file("a.toml", recipe(&lines));
    let ran = folder.run("mesh a.toml --quantity depth=20 -o a.14 --sequence 3");
    assert_eq!(ran.status, 0, "{}", ran.err);
    let mut before = 0;
    for number in 1..=3 {
        let grid = Grid::read(&folder.read(&format!("a_{number}.14")));
        assert_eq!(grid.check().len(), 4);
        let [dike] = grid.weirs().collect::<Vec<_>>()[..] else { panic!() };
        assert!(number == 1 || dike.nodes.len() == 2 * before + 1, "{} after {before}", dike.nodes.len());
        before = dike.nodes.len();
        assert!(dike.backs.windows(2).all(|pair| pair[0].1[0] < pair[1].1[0]), "the crest rises");
    }
}

#[test]
fn random_weirs_that_cross_each_other_and_the_boundary_are_cracks() {
    let folder = Folder::new("weirs-random");
    let mut pairs = 0;
    for seed in seeds(8) {
        let mut random = fastrand::Rng::with_seed(seed);
        let mut place = || format!("[{}, {}]", 1.2 * random.f64() - 0.1, 1.2 * random.f64() - 0.1);
        let lines: String = (0..4)
            .map(|n| {
                let points: Vec<String> = (0..2 + n % 3).map(|_| place()).collect();
                let closed = if n == 3 { "closed = true\ncrest = 2" } else { "crest = 1" };
                weir(&format!("weir {n}"), &format!("[{}]", points.join(", ")), closed)
            })
            .collect();
        let (grid, _) = written(&folder, &lines, "");
        grid.check();
        check_joined(&folder, &grid, &lines);
        pairs += grid.weirs().map(|list| list.backs.len()).sum::<usize>();
    }
    assert!(pairs > 100, "{pairs}");
}
