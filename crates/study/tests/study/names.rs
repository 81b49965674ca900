//! The letters that lines of code and data of a step use have a place on the canvas.

use std::collections::BTreeSet;
use std::sync::Arc;

use meshbrush_mesh::geometry::{Lattice, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh, Progress};
use meshbrush_study::steps::{NamedPlace, StepAction, StepPlayer, StepRecorder};

fn player() -> StepPlayer {
    let lattice = Lattice::covering(Rect::UNIT, 0.25, 10_000).unwrap();
    let mesh = Mesh::coarse_grid(&lattice, |_| true, &Limits::default()).unwrap();
    let mut recorder = StepRecorder::new(mesh, Limits::default(), 10_000);
    let extent = lattice.extent().x;
    let rule = |element: &meshbrush_mesh::mesh::Element<'_>| {
        let level = element.triangle.level();
        let near = |x: u32| element.corners.iter().any(|corner| corner.x.abs_diff(x) < extent / 30);
        (near(extent / 3) && level < 5) || (near(0) && level < 6)
    };
    while recorder.advance(rule, 1000).unwrap() == Progress::More {}
    StepPlayer::new(Arc::new(recorder.finish()))
}

/// Letters that stand for a number of a triangle or a node in a line of an algorithm.
fn letters_in(line: &str) -> BTreeSet<&str> {
    const LETTERS: [&str; 16] = [
        "i_b", "ī_b", "ī", "v_b[1]", "v_b[2]", "v_b[3]", "v[1]", "v[2]", "v[3]", "n_b[1]", "n_b[2]", "n[1]",
        "n[2]", "β", "N_x", "j",
    ];
    let words = line.split(|c: char| " (),".contains(c));
    let parts = words.flat_map(|word| {
        [word, word.trim_start_matches("T[").trim_start_matches("N[").trim_end_matches(']')]
    });
    parts
        .filter_map(|part| {
            LETTERS.into_iter().find(|letter| *letter == part || part == format!("{letter}]").as_str())
        })
        .collect()
}

#[test]
fn every_letter_of_the_current_lines_is_named_where_it_is() {
    let mut player = player();
    let mut seen = BTreeSet::new();
    for position in 1..=player.len() {
        player.go_to(position);
        let step = *player.step().unwrap();
        let labels: Vec<(NamedPlace, String)> = player.names().labels().collect();
        let names: BTreeSet<String> = labels
            .iter()
            .flat_map(|(_, text)| text.split(" = ").map(str::to_owned).collect::<Vec<_>>())
            .collect();
        let (algorithm, lines) = step.lines();
        // At the end, N_x and N_t are only counts.
        let lines = if step.action == StepAction::Finish { 1..1 } else { lines };
        for line in &algorithm.lines()[lines.start - 1..lines.end - 1] {
            for letter in letters_in(line) {
                // A neighbour that is the boundary is no triangle.
                let is_boundary = letter.starts_with('n')
                    && player
                        .changes()
                        .iter()
                        .any(|change| change.before.is_some_and(|row| row[4..6].contains(&-1)));
                assert!(names.contains(letter) || is_boundary, "{letter} of {line}: {names:?} at {step:?}");
                seen.insert(letter.to_owned());
            }
        }
        for (place, text) in &labels {
            let number = text.rsplit(" = ").next().unwrap();
            match place {
                NamedPlace::Triangle(triangle) => assert_eq!(number, triangle.to_string()),
                NamedPlace::Node(node) => assert_eq!(number, node.to_string()),
                NamedPlace::Boundary(_) => assert_eq!(number, "−1"),
            }
            assert!(!player.points_of(*place).is_empty());
        }
    }
    assert!(seen.len() >= 14, "{seen:?}");
}

#[test]
fn letters_stand_at_the_triangles_and_nodes_that_the_lines_mean() {
    let mut player = player();
    let mut pairs = 0;
    for position in 1..=player.len() {
        player.go_to(position);
        let step = *player.step().unwrap();
        let at = |name: &str| {
            let known = player.names();
            let found = known.labels().find(|(_, text)| text.split(" = ").any(|one| one == name));
            found.map(|(place, _)| place)
        };
        if step.triangle > 0 {
            assert_eq!(at("i").or(at("i = j")), Some(NamedPlace::Triangle(step.triangle)));
        }
        match (step.action, step.across) {
            (StepAction::Bisect, Some(across)) => {
                pairs += 1;
                assert_eq!(at("i_b"), Some(NamedPlace::Triangle(across)));
                let new = player.rows().len() as u32;
                assert_eq!([at("ī"), at("ī_b")], [new - 1, new].map(|n| Some(NamedPlace::Triangle(n))));
                let node = step.new_node.unwrap();
                assert_eq!(at("N_x"), Some(NamedPlace::Node(node)));
                // v[1] and v[k + 1] are the ends of the edge that N_x halves.
                let [Some(a), Some(b)] = [at("v[1]"), at(&format!("v[{}]", step.k + 1))] else { panic!() };
                let [a, b, middle] = [a, b, NamedPlace::Node(node)].map(|place| player.points_of(place)[0]);
                assert_eq!(a.midpoint(b), middle);
            }
            (StepAction::UpdateNeighbours(_), None) => {
                let Some(place @ NamedPlace::Boundary(_)) = at("β") else { panic!("{step:?}") };
                let ends = player.points_of(place);
                let last = player.nodes().last().unwrap();
                assert_eq!(ends[0].midpoint(ends[1]), *last, "the halved edge");
            }
            (StepAction::Divisible, None) => assert!(matches!(at("i_b"), Some(NamedPlace::Boundary(_)))),
            _ => {}
        }
        if step.triangle > 0 && !matches!(step.action, StepAction::Bisect | StepAction::UpdateNeighbours(_)) {
            let row = player.rows()[step.triangle as usize - 1];
            let nodes = [row[0], row[1], row[2]].map(|node| Some(NamedPlace::Node(node as u32)));
            assert_eq!(["v₁", "v₂", "v₃"].map(at), nodes, "{step:?}");
        }
    }
    assert!(pairs > 20);
}
