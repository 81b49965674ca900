//! Algorithms 10 to 12 one step at a time: the arrays at every step, forwards and backwards.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::literal::Report;
use meshbrush_mesh::geometry::{Lattice, LatticePoint, Rect};
use meshbrush_mesh::mesh::{Limits, Mesh, Progress, fingerprint_of};
use meshbrush_study::steps::{
    Algorithm, NeighbourCase, Recording, ReportRow, RowChange, StepAction, StepPlayer, StepRecorder,
};

/// Cells per side, and the grid nodes that are outside the domain.
const DOMAINS: [(i64, &[(i64, i64)]); 6] = [
    (1, &[]),
    (4, &[]),
    (1, &[(0, 0)]),
    (4, &[(0, 0), (4, 4)]),
    (5, &[(2, 2)]),
    (6, &[(1, 1), (3, 2), (5, 5), (0, 4)]),
];

/// A rule by level and corners.
type Rule = Box<dyn Fn(u32, [LatticePoint; 3]) -> bool>;

/// Deep levels near two places, at the right rim and on a thin strip: by the vertices, as in the report.
fn rule(extent: u32, random: &mut fastrand::Rng) -> Rule {
    let place = |random: &mut fastrand::Rng| random.u32(0..=32) * (extent / 32);
    let places = [(); 2].map(|()| [place(random), place(random)]);
    let (strip, half_width) = (2 * place(random), random.u32(0..extent / 16));
    let wanted = move |c: LatticePoint| {
        let near = |p: [u32; 2]| c.x.abs_diff(p[0]) + c.y.abs_diff(p[1]) < extent / 20;
        if places.into_iter().any(near) {
            9
        } else if (c.x + c.y).abs_diff(strip) < half_width {
            8
        } else {
            2 + 3 * u32::from(c.x == extent)
        }
    };
    Box::new(move |level, corners| corners.into_iter().any(|corner| level < wanted(corner)))
}

/// Returns a coarse mesh, and that of the report.
fn coarse_pair(n_e: i64, removed: &[(i64, i64)]) -> (Mesh, Report) {
    let whole = |x: f64| (x * n_e as f64).round() as i64;
    let lattice = Lattice::covering(Rect::UNIT, 1.0 / n_e as f64, 1_000_000).unwrap();
    let keeps = |p: glam::DVec2| !removed.contains(&(whole(p.x), whole(p.y)));
    let mesh = Mesh::coarse_grid(&lattice, keeps, &Limits::default()).unwrap();
    let delta = i64::from(lattice.cell_steps());
    let mut report = Report::initialise_mesh(n_e, delta, |[x, y]| !removed.contains(&(x / delta, y / delta)));
    report.remove_orphans();
    (mesh, report)
}

fn recorded(mesh: &Mesh, rule: &Rule, most_triangles: usize) -> Recording {
    let mut recorder = StepRecorder::new(mesh.clone(), Limits::default(), most_triangles);
    let mut slices = 0;
    while recorder.advance(|one| rule(one.triangle.level(), one.corners), 7).unwrap() == Progress::More {
        slices += 1;
    }
    assert!(slices > 0);
    recorder.finish()
}

/// Everything that a step may change.
type State = (Vec<ReportRow>, Vec<LatticePoint>, Vec<u32>);

fn state(player: &StepPlayer) -> State {
    (player.rows().to_vec(), player.nodes().to_vec(), player.stack().to_vec())
}

fn assert_like_report(player: &StepPlayer, report: &Report) {
    let nodes = player.nodes().iter().map(|node| [i64::from(node.x), i64::from(node.y)]);
    assert!(nodes.eq(report.n[1..].iter().copied()), "after {} steps", player.position());
    assert!(
        player.rows().iter().map(|row| row.map(i64::from)).eq(report.t[1..].iter().copied()),
        "after {} steps",
        player.position()
    );
}

#[test]
fn each_refine_triangle_leaves_the_arrays_of_the_report() {
    let mut cases: BTreeMap<NeighbourCase, usize> = BTreeMap::new();
    let mut visited_again = 0;
    for seed in 0..24 {
        let (n_e, removed) = DOMAINS[seed % DOMAINS.len()];
        let mut random = fastrand::Rng::with_seed(seed as u64);
        let (mut mesh, mut report) = coarse_pair(n_e, removed);
        let rule = rule(mesh.lattice().extent().x, &mut random);
        let mut player = StepPlayer::new(Arc::new(recorded(&mesh, &rule, 100_000)));
        let steps = player.recording().steps().to_vec();
        for (done, step) in steps.iter().enumerate() {
            match step.action {
                StepAction::Visit { exceeds, again } => {
                    player.go_to(done);
                    assert_like_report(&player, &report);
                    assert!(player.stack().is_empty());
                    let asked = player.rows()[step.triangle as usize - 1][7] as u32;
                    assert_eq!(rule(asked, player.corners(step.triangle)), exceeds);
                    if exceeds {
                        report.refine_triangle(step.triangle as usize);
                    }
                    visited_again += usize::from(again);
                }
                StepAction::UpdateNeighbours(case) => *cases.entry(case).or_default() += 1,
                StepAction::Finish => assert_eq!(done + 1, steps.len()),
                _ => {}
            }
        }
        player.go_to(usize::MAX);
        assert_like_report(&player, &report);
        mesh.refine(&Limits::default(), |one| rule(one.triangle.level(), one.corners)).unwrap();
        let corners = (1..=player.rows().len()).map(|number| player.corners(number as u32));
        assert_eq!(fingerprint_of(corners), mesh.fingerprint(), "seed {seed}");
    }
    assert_eq!(cases.len(), 6, "{cases:?}");
    assert!(visited_again > 0, "compatibility bisected a triangle that was satisfied");
}

#[test]
fn going_to_any_step_and_back_gives_the_same_arrays() {
    for (seed, (n_e, removed)) in DOMAINS.into_iter().enumerate() {
        let mut random = fastrand::Rng::with_seed(50 + seed as u64);
        let (mesh, _) = coarse_pair(n_e, removed);
        let rule = rule(mesh.lattice().extent().x, &mut random);
        let recording = Arc::new(recorded(&mesh, &rule, 600));
        let mut player = StepPlayer::new(recording.clone());
        let mut states = vec![state(&player)];
        for position in 1..=player.len() {
            player.go_to(position);
            states.push(state(&player));
        }
        for _ in 0..300 {
            let position = random.usize(0..=player.len());
            player.go_to(position);
            assert_eq!(player.position(), position);
            assert!(state(&player) == states[position], "step {position}");
            let mut other = StepPlayer::new(recording.clone());
            other.go_to(position);
            assert!(state(&other) == states[position], "step {position}");
        }
    }
}

#[test]
fn changed_rows_are_those_that_differ() {
    let (mesh, _) = coarse_pair(4, &[(0, 0)]);
    let rule = rule(mesh.lattice().extent().x, &mut fastrand::Rng::with_seed(9));
    let mut player = StepPlayer::new(Arc::new(recorded(&mesh, &rule, 100_000)));
    let mut seen = 0;
    for position in 1..=player.len() {
        let before = player.rows().to_vec();
        player.go_to(position);
        let rows = player.rows();
        let differs = |number: &usize| before.get(number - 1) != Some(&rows[number - 1]);
        let mut expected: Vec<_> = (1..=rows.len())
            .filter(differs)
            .map(|number| RowChange {
                number: number as u32,
                before: before.get(number - 1).copied(),
                after: rows[number - 1],
            })
            .collect();
        let mut changes = player.changes().to_vec();
        changes.sort_by_key(|change| change.number);
        expected.sort_by_key(|change| change.number);
        assert_eq!(changes, expected, "step {position}");
        assert_eq!(player.step().unwrap().changes_mesh(), rows.len() > before.len(), "step {position}");
        seen += changes.len();
    }
    assert!(seen > 100);
}

/// Runs the assignments of an algorithm that updates neighbours, as they are written.
fn run_lines(lines: &[&str], rows: &mut [ReportRow], i: i32, is_pair: bool) {
    let n_t = rows.len() as i32;
    let mut known: BTreeMap<String, i32> = BTreeMap::new();
    known.insert("i".into(), i);
    known.insert("N_t".into(), n_t);
    known.insert("N_t − 1".into(), n_t - 1);
    assert_eq!(lines[1] == "ī_b ← N_t", is_pair);
    for line in lines {
        if let Some(arguments) = line.strip_prefix("ReplaceTriangleNeighbour(") {
            let [one, old, new] =
                arguments.trim_end_matches(')').split(", ").map(|a| known[a]).collect::<Vec<_>>()[..]
            else {
                panic!("{line}")
            };
            if one > 0 {
                let row = &mut rows[one as usize - 1];
                let place = (3..6).find(|&j| row[j] == old).unwrap();
                row[place] = new;
            }
            continue;
        }
        let (left, right) = line.split_once(" ← ").unwrap();
        let place = |text: &str| -> Option<(String, String)> {
            let (row, column) = text.strip_prefix("T[")?.strip_suffix(']')?.split_once(", ")?;
            Some((row.into(), column.into()))
        };
        match (place(left), place(right)) {
            (None, Some((row, column))) if column == "5 : 6" => {
                let row = rows[known[&row] as usize - 1];
                known.insert(format!("{left}[1]"), row[4]);
                known.insert(format!("{left}[2]"), row[5]);
            }
            (None, Some((row, column))) => {
                let value = rows[known[&row] as usize - 1][column.parse::<usize>().unwrap() - 1];
                known.insert(left.into(), value);
            }
            (None, None) => _ = known.insert(left.into(), known[right]),
            (Some((row, column)), _) => {
                rows[known[&row] as usize - 1][column.parse::<usize>().unwrap() - 1] = known[right];
            }
        }
    }
}

#[test]
fn the_lines_that_are_shown_do_what_the_step_did() {
    let mut cases = BTreeMap::new();
    for (seed, (n_e, removed)) in DOMAINS.into_iter().enumerate() {
        let (mesh, _) = coarse_pair(n_e, removed);
        let rule = rule(mesh.lattice().extent().x, &mut fastrand::Rng::with_seed(80 + seed as u64));
        let mut player = StepPlayer::new(Arc::new(recorded(&mesh, &rule, 2000)));
        for position in 1..=player.len() {
            let mut rows = player.rows().to_vec();
            player.go_to(position);
            let step = *player.step().unwrap();
            let (algorithm, lines) = step.lines();
            let text = algorithm.lines();
            assert!(!lines.is_empty() && lines.start > 0 && lines.end <= text.len() + 1, "{step:?}");
            if let StepAction::UpdateNeighbours(case) = step.action {
                run_lines(
                    &text[lines.start - 1..lines.end - 1],
                    &mut rows,
                    step.triangle as i32,
                    step.across.is_some(),
                );
                assert!(rows == player.rows(), "{step:?}");
                *cases.entry(case).or_insert(0) += 1;
            }
        }
    }
    assert_eq!(cases.len(), 6, "{cases:?}");
    let numbers: Vec<u32> = Algorithm::ALL.into_iter().filter_map(Algorithm::number).collect();
    assert!(numbers.is_sorted() && numbers.len() == 11);
}

#[test]
fn a_large_mesh_is_cut_short_after_a_complete_refinement() {
    let (mesh, _) = coarse_pair(4, &[]);
    let everywhere: Rule = Box::new(|level, _| level < 30);
    let recording = recorded(&mesh, &everywhere, 500);
    assert!(recording.is_cut_short);
    let mut player = StepPlayer::new(Arc::new(recording));
    player.go_to(usize::MAX);
    assert!((500..600).contains(&player.rows().len()));
    assert!(player.stack().is_empty());
    assert!(matches!(player.step().unwrap().action, StepAction::UpdateNeighbours(_)));
}
