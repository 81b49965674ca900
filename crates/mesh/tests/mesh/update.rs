//! After any edits, cut into slices anywhere, the updated mesh is the one made from scratch.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::runs::runs;
use fastrand::Rng;
use glam::{DVec2, dvec2};
use meshbrush_mesh::geometry::{Lattice, LatticePoint, LatticeRect, Rect};
use meshbrush_mesh::mesh::{
    ChangedArea, Changes, Element, Falloff, Forecast, InvalidTarget, Limits, Mesh, Orientation, Progress,
    RefineError, RuleAnswers, SharedRule, TargetChange, Updater,
};

type Answer = Result<bool, InvalidTarget>;

/// Asks for a level wherever a closed triangle meets a closed disc, in lattice coordinates.
#[derive(Clone, Copy, Debug)]
struct Spot {
    at: [i64; 2],
    radius: i64,
    level: u32,
}

impl Spot {
    fn meets(&self, corners: [LatticePoint; 3]) -> bool {
        let mut corners = corners.map(|c| [i128::from(c.x), i128::from(c.y)]);
        let at = self.at.map(i128::from);
        if cross(corners[0], corners[1], corners[2]) < 0 {
            corners.swap(1, 2);
        }
        let edges = [0, 1, 2].map(|i| (corners[i], corners[(i + 1) % 3]));
        let inside = edges.iter().all(|&(a, b)| cross(a, b, at) >= 0);
        inside || edges.iter().any(|&(a, b)| within(at, i128::from(self.radius), a, b))
    }

    /// Returns all triangles that the spot says anything about touch this, if they lie in the grid.
    fn area(&self, mesh: &Mesh) -> LatticeRect {
        let extent = mesh.lattice().extent();
        let clamp = |v: i64, most: u32| v.clamp(0, i64::from(most)) as u32;
        let corner =
            |r: i64| LatticePoint::new(clamp(self.at[0] + r, extent.x), clamp(self.at[1] + r, extent.y));
        LatticeRect { min: corner(-self.radius), max: corner(self.radius) }
    }
}

/// Returns whether the distance from `p` to the segment is at most `radius`, by whole numbers.
fn within(p: [i128; 2], radius: i128, a: [i128; 2], b: [i128; 2]) -> bool {
    let along = dot(a, b, p);
    if along <= 0 {
        dot(a, p, p) <= radius * radius
    } else if along >= dot(a, b, b) {
        dot(b, p, p) <= radius * radius
    } else {
        // Below 2^66 and 2^60: squares and products fit.
        cross(a, b, p) * cross(a, b, p) <= radius * radius * dot(a, b, b)
    }
}

/// (b − a) × (p − a).
fn cross(a: [i128; 2], b: [i128; 2], p: [i128; 2]) -> i128 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// (b − a) · (p − a).
fn dot(a: [i128; 2], b: [i128; 2], p: [i128; 2]) -> i128 {
    (b[0] - a[0]) * (p[0] - a[0]) + (b[1] - a[1]) * (p[1] - a[1])
}

fn rule(spots: &[Spot]) -> impl Fn(&Element) -> Answer {
    |element| {
        let level = element.triangle.level();
        Ok(spots.iter().any(|spot| level < spot.level && spot.meets(element.corners)))
    }
}

/// [`rule`], for updates.
fn shared(spots: &[Spot]) -> impl SharedRule<Error = InvalidTarget> {
    || |corners, level| -> Answer { Ok(spots.iter().any(|spot| level < spot.level && spot.meets(corners))) }
}

/// Squares, a rectangle and domains in which diagonals and sides are on inner and outer boundaries, that fall
/// apart, and that are joined by a corner only.
fn domains() -> Vec<Mesh> {
    let grid = |w: f64, h: f64, spacing: f64, removed: &[(i32, i32)]| {
        let whole = |x: f64| (x / spacing).round() as i32;
        let contains = |p: DVec2| !removed.contains(&(whole(p.x), whole(p.y)));
        Mesh::coarse_grid(
            &Lattice::covering(Rect::new(DVec2::ZERO, dvec2(w, h)), spacing, 1_000_000).unwrap(),
            contains,
            &Limits::default(),
        )
        .unwrap()
    };
    vec![
        grid(1.0, 1.0, 1.0, &[]),
        grid(1.0, 1.0, 0.5, &[]),
        grid(2.0, 1.0, 0.25, &[]),
        grid(1.0, 1.0, 1.0, &[(0, 0)]),
        grid(1.0, 1.0, 0.25, &[(0, 0), (4, 4)]),
        grid(1.25, 1.25, 0.25, &[(2, 2)]),
        grid(1.5, 1.5, 0.25, &[(1, 1), (3, 2), (5, 5), (0, 4)]),
        grid(1.0, 1.0, 0.25, &[(0, 2), (1, 2), (2, 2), (3, 2), (4, 2)]), // two halves
        grid(0.75, 0.75, 0.25, &[(1, 0), (2, 2)]),
    ]
}

fn any_spot(random: &mut Rng, mesh: &Mesh) -> Spot {
    let extent = mesh.lattice().extent();
    let cell = f64::from(mesh.lattice().cell_steps());
    let mut at = [i64::from(random.u32(..=extent.x)), i64::from(random.u32(..=extent.y))];
    if random.bool() {
        // On a node, or near enough to one for a disc to touch it.
        let node = mesh.raw_nodes()[random.usize(..mesh.raw_nodes().len())];
        at = [i64::from(node.x), i64::from(node.y)];
    }
    let radius = match random.u8(..3) {
        0 => random.i64(0..3),
        1 => 1 << random.u32(..mesh.lattice().halvings()),
        _ => (cell * 0.5 * random.f64().powi(3)) as i64,
    };
    // The larger the coarser, so that meshes stay small.
    let finest = (2.0 * (8.0 * cell / (radius + 1) as f64).log2()).clamp(1.0, 14.0) as u32;
    Spot { at, radius, level: random.u32(1..=finest) }
}

/// Adds, removes, moves or changes a spot; returns the rectangles in which that says something else, how the
/// targets change there, and mostly how small those are that do.
fn edit(random: &mut Rng, spots: &mut Vec<Spot>, mesh: &Mesh) -> Vec<ChangedArea> {
    use TargetChange::{Coarser, Finer};
    let tells_least = random.u8(..4) > 0;
    let changed = |spot: &Spot, change, level| {
        let rect = spot.area(mesh);
        let falloff = Falloff { core: rect, least: mesh.diameter(level), slope: 0.0 };
        ChangedArea { rect, change, falloff: tells_least.then_some(falloff) }
    };
    let pick = (!spots.is_empty()).then(|| random.usize(..spots.len()));
    match (random.u8(..6), pick) {
        (0..3, Some(i)) if spots.len() > random.usize(..6) => {
            let spot = spots.swap_remove(i);
            vec![changed(&spot, Coarser, spot.level)]
        }
        (3, Some(i)) => {
            let before = spots[i];
            spots[i].level = any_spot(random, mesh).level.min(before.level + 2);
            let change = if spots[i].level < before.level { Coarser } else { Finer };
            vec![changed(&before, change, before.level.max(spots[i].level))]
        }
        (4, Some(i)) => {
            let before = spots[i];
            spots[i] = Spot { at: any_spot(random, mesh).at, ..before };
            vec![changed(&before, Coarser, before.level), changed(&spots[i], Finer, before.level)]
        }
        _ => {
            let spot = any_spot(random, mesh);
            spots.push(spot);
            vec![changed(&spot, Finer, spot.level)]
        }
    }
}

fn areas_of(changes: &[ChangedArea]) -> Vec<LatticeRect> {
    changes.iter().map(|area| area.rect).collect()
}

fn from_scratch(coarse: &Mesh, spots: &[Spot]) -> Mesh {
    let mut mesh = coarse.clone();
    mesh.refine(&Limits::default(), rule(spots)).unwrap();
    mesh
}

/// A triangle by its corners in order.
type Corners = [LatticePoint; 3];

/// Everything about a mesh but its numbering.
fn by_place(mesh: &Mesh) -> HashMap<Corners, (Orientation, u32, [Option<Corners>; 3])> {
    let places = mesh.raw_triangles().iter().map(|t| {
        let neighbours = t.raw_neighbours.map(|n| n.triangle().map(|id| mesh.corners(id)));
        (t.vertices.map(|v| mesh.node(v)), (t.orientation(), t.level(), neighbours))
    });
    places.collect()
}

/// Nothing outside the ranges differs between two states of an array.
fn assert_covered<T: PartialEq + std::fmt::Debug>(before: &[T], after: &[T], changed: &[Range<usize>]) {
    assert!(changed.windows(2).all(|pair| pair[0].end < pair[1].start), "{changed:?} do not ascend apart");
    assert!(changed.iter().all(|range| range.start < range.end && range.end <= after.len()));
    let gaps = std::iter::once(0).chain(changed.iter().map(|range| range.end));
    let ends = changed.iter().map(|range| range.start).chain([after.len()]);
    for (start, end) in gaps.zip(ends).filter(|(start, end)| start < end) {
        assert_eq!(before.get(start..end), Some(&after[start..end]), "changed in {start}..{end}, not said");
    }
}

/// A copy of the mesh that is kept up to date by its changes alone.
struct Mirror(Mesh);

impl Mirror {
    fn follow(&mut self, mesh: &Mesh, changes: Option<Changes>) {
        let Some(Changes { nodes, triangles, .. }) = changes else {
            assert_eq!(
                (self.0.raw_nodes(), self.0.raw_triangles()),
                (mesh.raw_nodes(), mesh.raw_triangles())
            );
            return;
        };
        assert_covered(self.0.raw_nodes(), mesh.raw_nodes(), &nodes);
        assert_covered(self.0.raw_triangles(), mesh.raw_triangles(), &triangles);
        self.0.clone_from(mesh);
    }
}

fn settle(updater: &mut Updater, mesh: &mut Mesh, spots: &[Spot]) {
    while updater.advance(mesh, &shared(spots), 1000).unwrap() == Progress::More {}
    assert!(updater.is_done());
}

#[test]
fn after_any_edits_cut_anywhere_the_mesh_is_the_one_made_from_scratch() {
    let edits = runs(10_000) as usize;
    let (mut rests, mut largest, mut changed) = (0, 0, 0);
    for (seed, coarse) in domains().into_iter().enumerate() {
        let mut random = Rng::with_seed(seed as u64);
        let mut mesh = coarse.clone();
        let mut mirror = Mirror(coarse.clone());
        let mut updater = Updater::new(Limits::default());
        let mut spots = Vec::new();
        for count in 0..edits / 9 {
            // Up to ten edits at once: small areas are then large together.
            for _ in 0..if random.u8(..8) == 0 { 10 } else { 1 } {
                for area in edit(&mut random, &mut spots, &mesh) {
                    if random.u8(..4) == 0 { updater.add(area.rect) } else { updater.add_area(area) }
                }
            }
            // Half the time the next edit comes before the work is done.
            let slice = 1 << random.u32(..8);
            let mut progress = Progress::More;
            for _ in 0..if random.bool() { random.usize(..8) } else { usize::MAX } {
                progress = updater.advance(&mut mesh, &shared(&spots), slice).unwrap();
                if random.u8(..8) == 0 {
                    assert_eq!(mesh.violations(), [], "seed {seed}, edit {count}");
                    let changes = updater.take_changes();
                    changed += usize::from(changes.is_some());
                    mirror.follow(&mesh, changes);
                }
                if progress == Progress::Done {
                    break;
                }
            }
            if progress == Progress::Done && random.u8(..4) == 0 {
                let rebuilt = from_scratch(&coarse, &spots);
                assert_eq!(mesh.fingerprint(), rebuilt.fingerprint(), "seed {seed}, edit {count}");
                assert_eq!(
                    (mesh.raw_nodes().len(), mesh.level_counts()),
                    (rebuilt.raw_nodes().len(), rebuilt.level_counts())
                );
                if rests % 8 == 0 {
                    assert!(by_place(&mesh) == by_place(&rebuilt), "seed {seed}, edit {count}");
                    // What files get is the same to the last number.
                    let [edited, made] = [&mesh, &rebuilt].map(|mesh| mesh.extract().along_curve());
                    assert!(edited.nodes() == made.nodes() && edited.triangles() == made.triangles());
                }
                rests += 1;
                largest = largest.max(mesh.raw_triangle_count());
            }
        }
        settle(&mut updater, &mut mesh, &spots);
        mirror.follow(&mesh, updater.take_changes());
        assert_eq!(mesh.fingerprint(), from_scratch(&coarse, &spots).fingerprint());
        // And all the way back: what is left is the coarse mesh, entry by entry.
        spots.drain(..).for_each(|spot| updater.add(spot.area(&mesh)));
        settle(&mut updater, &mut mesh, &spots);
        assert_eq!((mesh.raw_nodes(), mesh.raw_triangles()), (coarse.raw_nodes(), coarse.raw_triangles()));
    }
    eprintln!("{edits} edits, {rests} rests, {changed} changes, up to {largest} triangles");
    assert!(rests > edits / 20 && changed > edits / 20);
}

/// The arrays, and not only the mesh, are the same for any number of threads.
#[test]
fn an_update_gives_the_same_arrays_on_any_number_of_threads() {
    let pools =
        [1, 2, 3, 8].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
    let mut largest = 0;
    for (seed, coarse) in domains().into_iter().enumerate() {
        let meshes = pools.each_ref().map(|pool| {
            let mut random = Rng::with_seed(200 + seed as u64);
            let (mut mesh, mut updater) = (coarse.clone(), Updater::new(Limits::default()));
            let mut spots = Vec::new();
            for _ in 0..60 {
                edit(&mut random, &mut spots, &mesh).into_iter().for_each(|area| updater.add_area(area));
                let visits = random.usize(1..20_000);
                pool.install(|| updater.advance(&mut mesh, &Eager(&spots), visits).unwrap());
                largest = largest.max(mesh.raw_triangle_count());
            }
            mesh
        });
        for mesh in &meshes[1..] {
            assert!(mesh.raw_triangles() == meshes[0].raw_triangles(), "seed {seed}");
            assert!(mesh.raw_nodes() == meshes[0].raw_nodes(), "seed {seed}");
        }
    }
    assert!(largest > 300, "{largest} triangles");
}

/// [`shared`], for which two questions are worth another thread.
struct Eager<'a>(&'a [Spot]);

impl SharedRule for Eager<'_> {
    type Error = InvalidTarget;

    fn answers(&self) -> impl RuleAnswers<Error = InvalidTarget> {
        |corners, level| -> Answer { Ok(self.0.iter().any(|spot| level < spot.level && spot.meets(corners))) }
    }

    fn questions_per_thread(&self) -> usize {
        2
    }
}

/// Returns the smallest rectangle that holds all of `areas`, of which there is at least one.
fn hull(areas: &[LatticeRect]) -> LatticeRect {
    let low = |of: fn(&LatticeRect) -> u32| areas.iter().map(of).min().unwrap();
    let high = |of: fn(&LatticeRect) -> u32| areas.iter().map(of).max().unwrap();
    LatticeRect {
        min: LatticePoint::new(low(|a| a.min.x), low(|a| a.min.y)),
        max: LatticePoint::new(high(|a| a.max.x), high(|a| a.max.y)),
    }
}

#[test]
fn a_forecast_is_what_the_update_then_does() {
    let edits = runs(10_000) as usize;
    let [mut grew, mut shrank, mut both] = [0; 3];
    for (seed, coarse) in domains().into_iter().enumerate() {
        let mut random = Rng::with_seed(100 + seed as u64);
        let mut mesh = coarse.clone();
        let mut updater = Updater::new(Limits::default());
        let mut spots = Vec::new();
        // A forecast that was made before, perhaps not to its end.
        let mut memory: Option<Forecast> = None;
        for count in 0..edits / 9 {
            let changes = edit(&mut random, &mut spots, &mesh);
            let before = mesh.raw_triangle_count();
            let mut forecast = match (random.u8(..3), memory.take()) {
                (0, _) => Forecast::new(hull(&areas_of(&changes)), &Limits::default()),
                (1, Some(memory)) => Forecast::for_changes_in(memory, changes.clone(), &Limits::default())
                    .expect("there is an area"),
                _ => Forecast::for_changes(changes.clone(), &Limits::default()).expect("there is an area"),
            };
            let asks = |corners, level| spots.iter().any(|spot| level < spot.level && spot.meets(corners));
            let slice = 1 << random.u32(..12);
            if random.bool() {
                _ = forecast.advance(&mesh, &|| asks, |_, _| true, slice).unwrap();
                memory = Some(forecast.clone());
            }
            while forecast.advance(&mesh, &|| asks, |_, _| true, slice).unwrap() == Progress::More {}
            changes.into_iter().for_each(|area| updater.add_area(area));
            settle(&mut updater, &mut mesh, &spots);
            let (added, removed) = (forecast.added(), forecast.removed());
            assert_eq!(forecast.change(), added as i64 - removed as i64, "all belong");
            assert_eq!(before + added - removed, mesh.raw_triangle_count(), "seed {seed}, edit {count}");
            grew += usize::from(added > 0 && removed == 0);
            shrank += usize::from(removed > 0 && added == 0);
            both += usize::from(added > 0 && removed > 0);
            memory = memory.or(Some(forecast));
        }
    }
    eprintln!("{grew} grew, {shrank} shrank, {both} both");
    assert!(grew > edits / 20 && shrank > edits / 20 && both > edits / 50);
}

#[test]
fn a_forecast_says_when_a_target_is_finer_than_the_lattice() {
    let (mesh, ..) = with_a_far_corner(3);
    let corner = LatticeRect { min: LatticePoint::new(0, 0), max: LatticePoint::new(0, 0) };
    let mut forecast = Forecast::new(corner, &Limits::default());
    let error = forecast
        .advance(&mesh, &|| |corners, _| corner.touches(corners), |_, _| true, usize::MAX)
        .unwrap_err();
    assert!(matches!(error, RefineError::TooFine { .. }), "{error}");
    let limits = Limits { max_level: Some(9), ..Limits::default() };
    let mut forecast = Forecast::new(corner, &limits);
    assert_eq!(
        forecast.advance(&mesh, &|| |corners, _| corner.touches(corners), |_, _| true, usize::MAX),
        Ok(Progress::Done)
    );
    let mut mesh = mesh;
    let before = mesh.raw_triangle_count();
    mesh.refine(&limits, |element| corner.touches(element.corners)).unwrap();
    assert_eq!(before + forecast.added(), mesh.raw_triangle_count());
}

/// Returns a grid of 16 × 16 cells with one corner refined, and a disc far from there.
fn with_a_far_corner(level: u32) -> (Mesh, Spot, Spot) {
    let coarse = Mesh::coarse_grid(
        &Lattice::covering(Rect::UNIT, 1.0 / 16.0, 1_000_000).unwrap(),
        |_| true,
        &Limits::default(),
    )
    .unwrap();
    let steps = i64::from(coarse.lattice().cell_steps());
    let corner = Spot { at: [0, 0], radius: 4 * steps, level };
    let dab = Spot { at: [12 * steps, 11 * steps], radius: steps / 2, level: 10 };
    (from_scratch(&coarse, &[corner]), corner, dab)
}

/// Returns the coarse mesh that a mesh without holes was refined from.
fn coarse_of(mesh: &Mesh) -> Mesh {
    Mesh::coarse_grid(mesh.lattice(), |_| true, &Limits::default()).unwrap()
}

#[test]
fn the_work_goes_with_the_change_and_not_with_the_mesh() {
    let visits_for = |level| {
        let (mut mesh, corner, dab) = with_a_far_corner(level);
        let count = mesh.raw_triangle_count();
        let mut updater = Updater::new(Limits::default());
        let mut visits = [0, 0];
        for (i, spots) in [vec![corner, dab], vec![corner]].into_iter().enumerate() {
            updater.add(dab.area(&mesh));
            while updater.advance(&mut mesh, &shared(&spots), 1).unwrap() == Progress::More {
                visits[i] += 1;
            }
        }
        assert_eq!(mesh.raw_triangle_count(), count);
        (count, visits)
    };
    let ((small, visits), (large, visits_in_large)) = (visits_for(3), visits_for(11));
    assert!(large > 50 * small, "{small} and {large} triangles");
    assert_eq!(visits, visits_in_large);
}

#[test]
fn erasing_asks_no_more_than_painting_where_the_direction_is_known() {
    let questions = |[painting, erasing]: [TargetChange; 2]| {
        let (mut mesh, corner, dab) = with_a_far_corner(7);
        let before = mesh.fingerprint();
        let mut updater = Updater::new(Limits::default());
        let counts = [(painting, vec![corner, dab]), (erasing, vec![corner])].map(|(change, spots)| {
            let asked = AtomicUsize::new(0);
            updater.add_change(dab.area(&mesh), change);
            let count = || {
                |corners, level| {
                    asked.fetch_add(1, Ordering::Relaxed);
                    spots.iter().any(|spot| level < spot.level && spot.meets(corners))
                }
            };
            assert_eq!(updater.advance(&mut mesh, &count, usize::MAX), Ok(Progress::Done));
            asked.into_inner()
        });
        assert_eq!(mesh.fingerprint(), before);
        counts
    };
    let [painting, erasing] = questions([TargetChange::Finer, TargetChange::Coarser]);
    let [painting_blindly, erasing_blindly] = questions([TargetChange::Any; 2]);
    eprintln!(
        "{painting} and {erasing} questions; {painting_blindly} and {erasing_blindly} in any direction"
    );
    assert!(erasing <= painting && painting <= painting_blindly && 3 * erasing < 2 * erasing_blindly);
}

#[test]
fn at_the_budget_the_mesh_is_conforming_and_the_work_can_go_on() {
    let (mut mesh, corner, dab) = with_a_far_corner(6);
    let before = (mesh.fingerprint(), mesh.raw_triangle_count());
    let limit = from_scratch(&coarse_of(&mesh), &[corner, dab]).raw_triangle_count() - 1;
    let mut updater = Updater::new(Limits { max_triangles: limit, ..Limits::default() });
    updater.add(dab.area(&mesh));
    let refused = updater.advance(&mut mesh, &shared(&[corner, dab]), usize::MAX);
    assert_eq!(refused, Err(RefineError::TooManyTriangles { limit }));
    assert!(mesh.raw_triangle_count() <= limit && mesh.raw_triangle_count() > before.1);
    assert_eq!(mesh.violations(), []);
    // The dab is taken back: so is what came of it.
    updater.add(dab.area(&mesh));
    settle(&mut updater, &mut mesh, &[corner]);
    assert_eq!((mesh.fingerprint(), mesh.raw_triangle_count()), before);
}

#[test]
fn whatever_fits_the_budget_is_reached_though_old_and_new_together_do_not_fit() {
    let mut random = Rng::with_seed(21);
    for _ in 0..40 {
        let (mesh, corner, dab) = with_a_far_corner(random.u32(4..8));
        let coarse = coarse_of(&mesh);
        // The dab moves by a little or by much.
        let steps = i64::from(mesh.lattice().cell_steps());
        let moved = Spot { at: dab.at.map(|v| v - random.i64(0..2 * steps)), ..dab };
        let (mut mesh, rebuilt) =
            (from_scratch(&coarse, &[corner, dab]), from_scratch(&coarse, &[corner, moved]));
        let limit = mesh.raw_triangle_count().max(rebuilt.raw_triangle_count());
        let mut updater = Updater::new(Limits { max_triangles: limit, ..Limits::default() });
        updater.add(dab.area(&mesh));
        updater.add(moved.area(&mesh));
        while updater.advance(&mut mesh, &shared(&[corner, moved]), 100).unwrap() == Progress::More {
            assert!(mesh.raw_triangle_count() <= limit);
        }
        assert_eq!(mesh.fingerprint(), rebuilt.fingerprint());
        assert_eq!(mesh.violations(), []);
    }
}

#[test]
fn a_bad_target_or_too_small_a_one_is_refused_and_can_be_taken_back() {
    let (mut mesh, corner, dab) = with_a_far_corner(5);
    let before = mesh.fingerprint();
    let mut updater = Updater::new(Limits::default());
    let bad = InvalidTarget { at: DVec2::ONE, value: f64::NAN };
    updater.add(dab.area(&mesh));
    let within_dab = || {
        |corners, level| -> Answer {
            if dab.meets(corners) { Err(bad) } else { Ok(level < corner.level && corner.meets(corners)) }
        }
    };
    let refused = updater.advance(&mut mesh, &within_dab, usize::MAX);
    assert!(matches!(refused, Err(RefineError::Rule(_))), "{refused:?}");
    assert_eq!(mesh.violations(), []);

    let point = Spot { radius: 0, level: u32::MAX, ..dab };
    updater.add(point.area(&mesh));
    let refused = updater.advance(&mut mesh, &shared(&[corner, point]), usize::MAX);
    assert!(matches!(refused, Err(RefineError::TooFine { .. })), "{refused:?}");
    assert_eq!(mesh.level_counts().len() as u32, mesh.lattice().deepest_level() + 1);
    assert_eq!(mesh.violations(), []);

    updater.add(dab.area(&mesh));
    settle(&mut updater, &mut mesh, &[corner]);
    assert_eq!(mesh.fingerprint(), before);
}

#[test]
fn the_level_cap_holds_for_updates_too() {
    let coarse = domains().swap_remove(6);
    let limits = Limits { max_level: Some(7), ..Limits::default() };
    let mut random = Rng::with_seed(22);
    let (mut mesh, mut updater, mut spots) = (coarse.clone(), Updater::new(limits), Vec::new());
    for _ in 0..300 {
        areas_of(&edit(&mut random, &mut spots, &mesh)).into_iter().for_each(|area| updater.add(area));
        settle(&mut updater, &mut mesh, &spots);
        let mut rebuilt = coarse.clone();
        rebuilt.refine(&limits, rule(&spots)).unwrap();
        assert_eq!(mesh.fingerprint(), rebuilt.fingerprint());
    }
}

#[test]
fn cancelled_work_leaves_a_conforming_mesh_and_nothing_to_do() {
    let (mesh, corner, dab) = with_a_far_corner(5);
    let mut cut = mesh.clone();
    let mut updater = Updater::new(Limits::default());
    for visits in [0, 1, 10, 40, 100, 400, 1000] {
        updater.add(dab.area(&mesh));
        updater.advance(&mut cut, &shared(&[corner, dab]), visits).unwrap();
        updater.cancel();
        assert!(updater.is_done() && cut.violations().is_empty());
        assert_eq!(updater.advance(&mut cut, &shared(&[corner]), 1), Ok(Progress::Done));
    }
    // Work on the same place, later, mends it.
    updater.add(dab.area(&mesh));
    settle(&mut updater, &mut cut, &[corner]);
    assert_eq!(cut.fingerprint(), mesh.fingerprint());
}
