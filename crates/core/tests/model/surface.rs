//! Meshes close to surfaces, compared with every conforming mesh of a small grid, and by a search of its own.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::{DVec2, dvec2};
use meshbrush_core::build::{BuiltMesh, CurveTracing, MeshBuilder, Parts};
use meshbrush_core::document::{Document, Settings};
use meshbrush_core::domain::{BoundaryTreatment, Domain, DomainShape};
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    FormulaLayer, Layer, LayerId, LayerKind, Mask, PaintLayers, Quantity, RasterLayer, RasterReading,
    RasterSource, Surface, SurfaceGoal, SurfaceNorm, SurfaceSource,
};
use meshbrush_core::paint::{Brush, Medium};
use meshbrush_core::raster::{Raster, RasterPyramid};
use meshbrush_mesh::geometry::Rect;
use meshbrush_mesh::mesh::{Limits, Mesh, Progress, TriangleId};

/// A document of the unit square with one coarse cell, which asks for nothing but a surface.
fn settings(domain: Domain, spacing: f64, surfaces: impl IntoIterator<Item = LayerKind>) -> Settings {
    let kinds = [LayerKind::constant(f64::INFINITY)].into_iter().chain(surfaces);
    let mut settings = Settings::for_domain("surface".into(), domain);
    settings.spacing = spacing;
    settings.layers = Layer::stack(kinds);
    settings.boundary = BoundaryTreatment::Report;
    settings.transfer.h_min = 1e-9;
    settings.transfer.h_max = f64::MAX;
    settings.checked().unwrap()
}

fn built(settings: &Settings, max_level: Option<u32>) -> BuiltMesh {
    built_with(settings, PaintLayers::blank(), max_level)
}

fn built_with(settings: &Settings, paint: &PaintLayers, max_level: Option<u32>) -> BuiltMesh {
    let limits = Limits { max_level, ..Limits::default() };
    let mut builder = MeshBuilder::new(settings.mesh_spec_on(settings.lattice().unwrap(), limits));
    while builder.advance(Some(paint), 700).unwrap() == Progress::More {}
    builder.finish()
}

fn of_raster(raster: Raster, goal: SurfaceGoal) -> LayerKind {
    let raster = Arc::new(RasterPyramid::new(raster));
    let source = SurfaceSource::Raster(RasterSource { name: "heights.asc".into(), raster });
    Surface { source, goal, norm: SurfaceNorm::Largest }.into()
}

/// Every conforming mesh down to a level, from the coarsest.
fn all_meshes(coarse: &Mesh, levels: u32) -> Vec<Mesh> {
    let mut found = vec![coarse.clone()];
    let mut seen = BTreeSet::from([coarse.fingerprint().0]);
    let mut next = 0;
    while next < found.len() {
        for index in 0..found[next].raw_triangle_count() {
            let id = TriangleId::from_index(index);
            if found[next].triangle(id).level() < levels {
                let mut finer = found[next].clone();
                finer.refine_triangle(id);
                if seen.insert(finer.fingerprint().0) {
                    found.push(finer);
                }
            }
        }
        next += 1;
    }
    found
}

/// A surface as the referee sees it: samples at places, and values between them.
struct Referee {
    samples: Vec<(DVec2, f64)>,
    at: Box<dyn Fn(DVec2) -> f64>,
}

impl Referee {
    /// Returns the largest difference of a sample in the closed triangle from the plane through its corners.
    fn error(&self, corners: [DVec2; 3]) -> f64 {
        let mut largest = 0.0_f64;
        self.each(corners, |_, difference| largest = largest.max(difference));
        largest
    }

    /// Calls `visit` with each sample in the closed triangle and its difference from the plane.
    fn each(&self, corners: [DVec2; 3], mut visit: impl FnMut(DVec2, f64)) {
        let [a, b, c] = corners;
        let whole = (b - a).perp_dot(c - a);
        let heights = corners.map(|corner| (self.at)(corner));
        for &(place, value) in &self.samples {
            let parts = [(b, c), (c, a), (a, b)].map(|(p, q)| (q - p).perp_dot(place - p) / whole);
            if parts.iter().all(|&part| part >= -1e-10) && !value.is_nan() {
                let plane: f64 = (0..3).map(|n| parts[n] * heights[n]).sum();
                visit(place, (plane - value).abs());
            }
        }
    }

    fn errors(&self, mesh: &Mesh) -> Vec<f64> {
        let ids = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
        ids.map(|id| self.error(mesh.world_corners(id))).collect()
    }
}

/// Values between the centres of pixels that all have one; beyond the outermost ones, those of the cell of
/// centres beside them go on.
fn bilinear(values: Vec<f32>, size: [usize; 2], bounds: Rect) -> Box<dyn Fn(DVec2) -> f64> {
    Box::new(move |point| {
        let steps = dvec2(size[0] as f64, size[1] as f64);
        let at = (point - bounds.min) / bounds.size() * steps - 0.5;
        let cell = at.floor().clamp(DVec2::ZERO, (steps - 2.0).max(DVec2::ZERO));
        let (x, y, share) = (cell.x as usize, cell.y as usize, at - cell);
        let value = |x: usize, y: usize| f64::from(values[y.min(size[1] - 1) * size[0] + x.min(size[0] - 1)]);
        let along = |y| value(x, y) * (1.0 - share.x) + value(x + 1, y) * share.x;
        along(y) * (1.0 - share.y) + along(y + 1) * share.y
    })
}

/// Returns a random raster over the unit square and the referee of its surface. Its samples are the nodes of
/// the small grid, or lie anywhere.
fn random_raster(random: &mut fastrand::Rng) -> (Raster, Referee) {
    let is_on_nodes = random.bool();
    raster_with(random, is_on_nodes)
}

fn raster_with(random: &mut fastrand::Rng, is_on_nodes: bool) -> (Raster, Referee) {
    let size = if is_on_nodes { [5, 5] } else { [3 + random.usize(..7), 3 + random.usize(..7)] };
    let pixel = dvec2(1.0, 1.0) / dvec2(size[0] as f64 - 1.0, size[1] as f64 - 1.0);
    let bounds = match is_on_nodes {
        true => Rect::new(-0.5 * pixel, 1.0 + 0.5 * pixel),
        false => Rect::new(DVec2::splat(-0.3 * random.f64()), DVec2::splat(1.0 + 0.3 * random.f64())),
    };
    let coarse = random.bool();
    let values: Vec<f32> = (0..size[0] * size[1])
        .map(|_| if coarse { random.u32(..4) as f32 } else { 4.0 * random.f32() })
        .collect();
    let raster = Raster::from_values(bounds, size.map(|n| n as u32), values.clone());
    let samples =
        raster.all().pixels().map(|(x, y)| (raster.pixel_center(x, y), f64::from(raster.get(x, y))));
    let referee = Referee { samples: samples.collect(), at: bilinear(values, size, bounds) };
    (raster, referee)
}

/// The errors that matter: triangles of the last level are not bisected.
fn largest_error(mesh: &Mesh, levels: u32, errors: &BTreeMap<[[u64; 2]; 3], f64>) -> f64 {
    let ids = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
    let coarser = ids.filter(|&id| mesh.triangle(id).level() < levels);
    coarser.map(|id| errors[&key(mesh.world_corners(id))]).fold(0.0, f64::max)
}

fn key(corners: [DVec2; 3]) -> [[u64; 2]; 3] {
    corners.map(|corner| corner.to_array().map(f64::to_bits))
}

/// A domain with every conforming mesh of it down to the last level.
struct Grid {
    domain: Domain,
    spacing: f64,
    levels: u32,
    meshes: Vec<Mesh>,
}

impl Grid {
    fn new(domain: Domain, spacing: f64, levels: u32) -> Self {
        let coarse = built(&settings(domain.clone(), spacing, []), Some(levels)).mesh;
        Self { domain, spacing, levels, meshes: all_meshes(&coarse, levels) }
    }

    fn ours(&self, raster: &Raster, goal: SurfaceGoal) -> Mesh {
        let surface = of_raster(raster.clone(), goal);
        built(&settings(self.domain.clone(), self.spacing, [surface]), Some(self.levels)).mesh
    }

    /// Compares the meshes of a surface with all of them, for errors and a number of triangles. Returns 1 if
    /// the mesh of the number is the smallest of its error, also where rounding matters.
    fn compare(&self, raster: &Raster, referee: &Referee, random: &mut fastrand::Rng) -> usize {
        let mut errors = BTreeMap::new();
        for mesh in &self.meshes {
            for id in (0..mesh.raw_triangle_count()).map(TriangleId::from_index) {
                let corners = mesh.world_corners(id);
                errors.entry(key(corners)).or_insert_with(|| referee.error(corners));
            }
        }
        let largest: Vec<f64> =
            self.meshes.iter().map(|mesh| largest_error(mesh, self.levels, &errors)).collect();
        let count = |mesh: &Mesh| mesh.raw_triangle_count();
        for _ in 0..3 {
            // An error that a mesh has, one just below it, or any.
            let of_a_mesh = largest[random.usize(..largest.len())];
            let error = match random.u8(..3) {
                0 => of_a_mesh * (1.0 - 1e-9) + 1e-12,
                1 => of_a_mesh * (1.0 + 1e-9) + 1e-12,
                _ => 3.0 * random.f64() + 1e-6,
            };
            let meeting = self.meshes.iter().zip(&largest).filter(|(_, of_mesh)| **of_mesh <= error);
            let least = meeting.clone().map(|(mesh, _)| count(mesh)).min().unwrap();
            let smallest: Vec<_> = meeting.filter(|(mesh, _)| count(mesh) == least).collect();
            assert_eq!(smallest.len(), 1, "the smallest mesh of {error} is unique");
            let ours = self.ours(raster, SurfaceGoal::Within(error));
            assert_eq!(smallest[0].0.fingerprint(), ours.fingerprint(), "within {error}");
        }
        let coarse = count(&self.meshes[0]);
        let most = coarse + random.usize(..30);
        let possible = self.meshes.iter().zip(&largest).filter(|(mesh, _)| count(mesh) <= most);
        let least = possible.clone().map(|(_, error)| *error).fold(f64::INFINITY, f64::min);
        let best = possible.filter(|(_, error)| **error <= least + 1e-9);
        let smallest = best.min_by_key(|(mesh, _)| count(mesh)).unwrap().0;
        let ours = self.ours(raster, SurfaceGoal::AtMost(most));
        // Errors that only rounding tells apart are two steps for the program, and one here.
        let of_ours = largest_error(&ours, self.levels, &errors);
        assert!(count(&ours) <= most && of_ours <= least + 1e-9, "at most {most}: {of_ours} {least}");
        let within = self.ours(raster, SurfaceGoal::Within(least + 1e-9));
        assert_eq!(smallest.fingerprint(), within.fingerprint(), "at most {most}");
        usize::from(within.fingerprint() == ours.fingerprint())
    }
}

/// A random layer of errors in the unit square, with its paint and the errors that it says.
struct ErrorCase {
    kind: LayerKind,
    paint: PaintLayers,
    at: Box<dyn Fn(DVec2) -> Option<f64>>,
}

impl ErrorCase {
    /// `id` is that of the layer in the document.
    fn random(random: &mut fastrand::Rng, id: LayerId) -> Self {
        // A number of paint.
        let error = f64::from(0.05 + 1.5 * random.f32());
        let edge = 0.2 + 0.6 * random.f64();
        let blank = PaintLayers::default();
        match random.u8(..3) {
            0 => {
                let formula = Formula::parse(&format!("if(x < {edge}, {error}, inf)")).unwrap();
                let kind = LayerKind::Formula(FormulaLayer { quantity: Quantity::Error, formula });
                Self { kind, paint: blank, at: Box::new(move |p| (p.x < edge).then_some(error)) }
            }
            1 => {
                // Four pixels, one of them without a value.
                let values = vec![error as f32, f32::NAN, 2.0 * error as f32, 0.5 * error as f32];
                let raster = Raster::from_values(Rect::UNIT, [2, 2], values.clone());
                let source =
                    RasterSource { name: "errors.asc".into(), raster: Arc::new(RasterPyramid::new(raster)) };
                let kind = LayerKind::Raster(RasterLayer { source, reading: RasterReading::Error });
                let at = move |p: DVec2| {
                    let cell = |x: f64| usize::from(x >= 0.5);
                    let inside = (0.0..=1.0).contains(&p.x) && (0.0..=1.0).contains(&p.y);
                    let value = f64::from(values[2 * cell(p.y) + cell(p.x)]);
                    (inside && !value.is_nan()).then_some(value)
                };
                Self { kind, paint: blank, at: Box::new(at) }
            }
            _ => {
                let kind = LayerKind::paint(Quantity::Error);
                let (center, radius) = (dvec2(random.f64(), random.f64()), 0.15 + 0.4 * random.f64());
                let mut settings =
                    settings(Domain::rectangle(Rect::new(DVec2::splat(-1.0), DVec2::splat(3.0))), 4.0, []);
                settings.layers = vec![Layer::new(id, "Errors", kind.clone())];
                let mut document = Document::new(settings, None).unwrap();
                let medium = Medium::Error(error);
                document.begin_stroke(Brush { medium, radius, hardness: 1.0, strength: 1.0 });
                document.draw_to(center);
                document.end_stroke();
                let paint = document.paint().clone();
                let pixels = paint.get(id).unwrap().clone();
                let at = move |p: DVec2| {
                    let value = pixels.sample(p);
                    // The stroke is a disc, but for the pixels at its rim.
                    let distance = p.distance(center);
                    assert!(value < 9.0 || distance > 0.9 * radius, "{value} at {distance}");
                    assert!(value > 9.0 || distance < 1.1 * radius, "{value} at {distance}");
                    (value < 9.0).then_some(f64::from(value))
                };
                Self { kind, paint, at: Box::new(at) }
            }
        }
    }
}

/// How far a triangle is from the samples in it: the largest difference at those without an error of a layer,
/// and the largest share of that error at the others.
fn excess(referee: &Referee, at: &dyn Fn(DVec2) -> Option<f64>, corners: [DVec2; 3]) -> [f64; 2] {
    let mut largest = [0.0_f64; 2];
    referee.each(corners, |place, difference| match at(place) {
        None => largest[0] = largest[0].max(difference),
        Some(error) => largest[1] = largest[1].max(difference / error),
    });
    largest
}

#[test]
fn no_conforming_mesh_of_the_error_is_as_small() {
    let mut random = fastrand::Rng::with_seed(32);
    let square = Grid::new(Domain::rectangle(Rect::UNIT), 1.0, 4);
    assert_eq!(square.meshes.len(), 5489, "conforming meshes of 5 x 5 nodes");
    let runs = crate::runs::runs(150);
    let mut equal = 0;
    for _ in 0..runs {
        let (raster, referee) = random_raster(&mut random);
        equal += square.compare(&raster, &referee, &mut random);
    }
    assert!(10 * equal > 9 * runs as usize, "{equal} of {runs}");
}

#[test]
fn with_errors_of_layers_the_mesh_is_the_smallest_too() {
    let mut random = fastrand::Rng::with_seed(34);
    let square = Grid::new(Domain::rectangle(Rect::UNIT), 1.0, 4);
    let count = |mesh: &Mesh| mesh.raw_triangle_count();
    let (mut decided, runs) = (0, crate::runs::runs(60));
    for _ in 0..runs {
        let (raster, referee) = random_raster(&mut random);
        let case = ErrorCase::random(&mut random, LayerId(2));
        let mut known = BTreeMap::new();
        for mesh in &square.meshes {
            for id in (0..mesh.raw_triangle_count()).map(TriangleId::from_index) {
                let corners = mesh.world_corners(id);
                known.entry(key(corners)).or_insert_with(|| excess(&referee, &case.at, corners));
            }
        }
        let largest: Vec<[f64; 2]> = square
            .meshes
            .iter()
            .map(|mesh| {
                let ids = (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
                let coarser = ids.filter(|&id| mesh.triangle(id).level() < square.levels);
                let excesses = coarser.map(|id| known[&key(mesh.world_corners(id))]);
                excesses.fold([0.0_f64; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])])
            })
            .collect();
        let ours = |goal| {
            let kinds = [of_raster(raster.clone(), goal), case.kind.clone()];
            let settings = settings(square.domain.clone(), square.spacing, kinds);
            assert_eq!(settings.layers[2].id, LayerId(2));
            built_with(&settings, &case.paint, Some(square.levels)).mesh
        };
        let smallest = |error: f64| {
            let meets = |of: &[f64; 2]| of[0] <= error && of[1] <= 1.0 + 1e-9;
            let meeting = square.meshes.iter().zip(&largest).filter(|(_, of)| meets(of));
            let least = meeting.clone().map(|(mesh, _)| count(mesh)).min()?;
            let smallest: Vec<_> = meeting.filter(|(mesh, _)| count(mesh) == least).collect();
            assert_eq!(smallest.len(), 1, "the smallest mesh of {error} is unique");
            Some(smallest[0].0.clone())
        };
        let error = 0.05 + 3.0 * random.f64();
        let expected = smallest(error).unwrap();
        assert_eq!(ours(SurfaceGoal::Within(error)).fingerprint(), expected.fingerprint(), "within {error}");
        let alone = square.ours(&raster, SurfaceGoal::Within(error));
        decided += usize::from(alone.fingerprint() != expected.fingerprint());
        // Samples with an error of a layer meet it whatever the number; the others have the least error.
        let most = count(&smallest(f64::INFINITY).unwrap()) + random.usize(..20);
        let possible = square.meshes.iter().zip(&largest);
        let possible = possible.filter(|(mesh, of)| count(mesh) <= most && of[1] <= 1.0 + 1e-9);
        let least = possible.map(|(_, of)| of[0]).fold(f64::INFINITY, f64::min);
        let counted = ours(SurfaceGoal::AtMost(most));
        assert!(count(&counted) <= most, "at most {most}");
        assert_eq!(counted.fingerprint(), smallest(least + 1e-9).unwrap().fingerprint(), "at most {most}");
    }
    assert!(2 * decided > runs as usize, "errors of layers decided {decided} of {runs} meshes");
}

#[test]
fn where_a_part_is_missing_the_mesh_is_the_smallest_too() {
    let mut random = fastrand::Rng::with_seed(33);
    // Three quarters of the square: five of eight coarse triangles.
    let inside = Formula::parse("if(x > 0.6 and y > 0.6, 0, 1)").unwrap();
    let shape = DomainShape::from(inside.clone());
    let domain = Domain { shape, ..Domain::rectangle(Rect::new(DVec2::ZERO, dvec2(1.0, 1.0))) };
    let grid = Grid::new(domain, 0.5, 2);
    assert!(grid.meshes.len() > 100, "{}", grid.meshes.len());
    for _ in 0..crate::runs::runs(20) {
        let (raster, mut referee) = random_raster(&mut random);
        referee.samples.retain(|(place, _)| inside.eval(place.x, place.y) != 0.0);
        grid.compare(&raster, &referee, &mut random);
    }
}

#[test]
fn the_errors_of_meshes_are_those_of_the_referee_and_one_ulp_below_another_mesh_results() {
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..6 {
        let (raster, referee) = raster_with(&mut random, false);
        let error = 0.05 + 0.3 * random.f64();
        let of = |goal| settings(Domain::rectangle(Rect::UNIT), 0.25, [of_raster(raster.clone(), goal)]);
        let ours = built(&of(SurfaceGoal::Within(error)), None);
        let errors = referee.errors(&ours.mesh);
        let largest = errors.iter().copied().fold(0.0, f64::max);
        assert!(largest <= error * (1.0 + 1e-9), "{largest} {error}");
        let extract = ours.mesh.extract();
        let fit = ours.surface.as_ref().unwrap().samples().fit(extract.view());
        assert!((fit.largest - largest).abs() < 1e-9, "{} {largest}", fit.largest);
        let again = built(&of(SurfaceGoal::Within(fit.largest)), None);
        assert_eq!(again.mesh.fingerprint(), ours.mesh.fingerprint());
        let below = built(&of(SurfaceGoal::Within(fit.largest.next_down())), None);
        assert_ne!(below.mesh.fingerprint(), ours.mesh.fingerprint());
        let count = ours.mesh.raw_triangle_count();
        let counted = built(&of(SurfaceGoal::AtMost(count)), None);
        assert_eq!(counted.mesh.fingerprint(), ours.mesh.fingerprint());
        let (_, found) = counted.surface.as_ref().unwrap().errors().next().unwrap();
        assert_eq!(found, fit.largest);
    }
}

#[test]
fn a_formula_that_jumps_ends_and_its_error_says_where() {
    let formula = Formula::parse("if(x + 0.3 * y > 0.61, 1, 0)").unwrap();
    let surface = Surface {
        source: SurfaceSource::Formula(formula),
        goal: SurfaceGoal::Within(0.1),
        norm: SurfaceNorm::Largest,
    };
    let ours = built(&settings(Domain::rectangle(Rect::UNIT), 0.25, [LayerKind::Surface(surface)]), None);
    // Samples are at nodes: no triangle has another one once all of them are nodes.
    let fit = ours.surface.as_ref().unwrap().samples().fit(ours.mesh.extract().view());
    assert!(fit.largest <= 0.1);
    assert!(ours.mesh.raw_triangle_count() < 100_000);
}

#[test]
fn samples_outside_the_domain_do_not_count() {
    let domain = Domain {
        shape: DomainShape::from(Formula::parse("x < 0.5").unwrap()),
        ..Domain::rectangle(Rect::UNIT)
    };
    let values = (0..16 * 16).map(|n| if n % 16 < 8 { 1.0 } else { 100.0 * f32::from(n as u8) }).collect();
    let raster = Raster::from_values(Rect::UNIT, [16, 16], values);
    let surface = of_raster(raster, SurfaceGoal::Within(0.5));
    let ours = built(&settings(domain, 0.125, [surface]), None).mesh;
    let beyond = ours.nodes().filter(|&(id, _)| ours.world(id).x > 0.51).count();
    assert_eq!(beyond, 0);
}

/// Values at places of which each stands for the same area: heights, or gradients.
struct Places<V> {
    values: Vec<(DVec2, V)>,
}

/// Returns the angle of a closed triangle at a point, in radians: 0 outside.
fn angle_at(corners: [DVec2; 3], point: DVec2) -> f64 {
    let whole = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
    let sides = [0, 1, 2].map(|n| {
        let [p, q] = [corners[n], corners[(n + 1) % 3]];
        (q - p).perp_dot(point - p) / whole
    });
    if sides.iter().any(|side| *side < -1e-10) {
        return 0.0;
    }
    let on: Vec<usize> = (0..3).filter(|&n| sides[n] <= 1e-10).collect();
    match on[..] {
        [] => std::f64::consts::TAU,
        [_] => std::f64::consts::PI,
        _ => {
            let mut others = corners;
            others.sort_by(|a, b| a.distance(point).total_cmp(&b.distance(point)));
            (others[1] - point).angle_to(others[2] - point).abs()
        }
    }
}

impl<V: Copy> Places<V> {
    /// Returns the root mean square over a mesh of the unit square of how far the values are from those of a
    /// triangle. Triangles that share a place count by their angles there.
    fn root_mean_square(&self, mesh: &Mesh, difference: impl Fn([DVec2; 3], DVec2, V) -> f64) -> f64 {
        let all = || (0..mesh.raw_triangle_count()).map(|id| mesh.world_corners(TriangleId::from_index(id)));
        let means = self.values.iter().filter_map(|&(place, value)| {
            let parts = all().map(|corners| (corners, angle_at(corners, place)));
            let parts = parts.filter(|(_, angle)| *angle > 0.0);
            let (sum, angles) = parts.fold((0.0, 0.0), |(sum, angles), (corners, angle)| {
                (sum + angle * difference(corners, place, value).powi(2), angles + angle)
            });
            (angles > 0.0).then_some(sum / angles)
        });
        let means: Vec<f64> = means.collect();
        (means.iter().sum::<f64>() / means.len() as f64).sqrt()
    }
}

/// A surface as a referee of sums of squares sees it.
struct SquareReferee {
    heights: Places<f64>,
    gradients: Places<DVec2>,
    at: Box<dyn Fn(DVec2) -> f64>,
}

impl SquareReferee {
    fn new(raster: &Raster, at: Box<dyn Fn(DVec2) -> f64>) -> Self {
        let (step, [columns, rows]) = (raster.pixel_size(), raster.size());
        let value = |x, y| f64::from(raster.get(x, y));
        let cells = (0..rows - 1).flat_map(|y| (0..columns - 1).map(move |x| (x, y)));
        let gradient = |(x, y)| {
            let ([a, b], [c, d]) = ([value(x, y), value(x + 1, y)], [value(x, y + 1), value(x + 1, y + 1)]);
            (
                raster.pixel_center(x, y) + 0.5 * step,
                dvec2((b + d - a - c) / 2.0, (c + d - a - b) / 2.0) / step,
            )
        };
        let heights = raster.all().pixels().map(|(x, y)| (raster.pixel_center(x, y), value(x, y)));
        Self {
            heights: Places { values: heights.collect() },
            gradients: Places { values: cells.map(gradient).collect() },
            at,
        }
    }

    fn error(&self, mesh: &Mesh, norm: SurfaceNorm) -> f64 {
        let plane = |corners: [DVec2; 3]| {
            let [a, b, c] = corners.map(|corner| corner.extend((self.at)(corner)));
            let normal = (b - a).cross(c - a);
            (a, -normal.truncate() / normal.z)
        };
        match norm {
            SurfaceNorm::Gradient => {
                self.gradients.root_mean_square(mesh, |corners, _, value| value.distance(plane(corners).1))
            }
            _ => self.heights.root_mean_square(mesh, |corners, place, value| {
                let (from, gradient) = plane(corners);
                value - from.z - gradient.dot(place - from.truncate())
            }),
        }
    }
}

#[test]
fn sums_of_squares_are_met_with_few_triangles() {
    let mut random = fastrand::Rng::with_seed(3200);
    let square = Grid::new(Domain::rectangle(Rect::UNIT), 1.0, 4);
    for run in 0..crate::runs::runs(24) {
        let norm = [SurfaceNorm::RootMeanSquare, SurfaceNorm::Gradient][run as usize % 2];
        // Bisections of noise can raise the error, and no order is near the best then.
        let (peak, width) = (dvec2(random.f64(), random.f64()), 0.2 + 0.5 * random.f64());
        let height = |n: u32| {
            let place = dvec2(f64::from(n % 5), f64::from(n / 5)) / 4.0;
            (4.0 * (-place.distance_squared(peak) / (width * width)).exp()) as f32
        };
        let (bounds, values) = (Rect::new(DVec2::splat(-0.125), DVec2::splat(1.125)), (0..25).map(height));
        let raster = Raster::from_values(bounds, [5, 5], values.clone().collect());
        let referee = SquareReferee::new(&raster, bilinear(values.collect(), [5, 5], bounds));
        let errors: Vec<f64> = square.meshes.iter().map(|mesh| referee.error(mesh, norm)).collect();
        let all =
            || square.meshes.iter().zip(&errors).map(|(mesh, error)| (mesh.raw_triangle_count(), *error));
        let ours = |goal| {
            let LayerKind::Surface(surface) = of_raster(raster.clone(), goal) else { unreachable!() };
            let surface = LayerKind::Surface(Surface { norm, ..surface });
            let built = built(&settings(square.domain.clone(), 1.0, [surface]), Some(4));
            let fit = built.surface.as_ref().unwrap().samples().fit(built.mesh.extract().view());
            let found = (built.mesh.raw_triangle_count(), referee.error(&built.mesh, norm));
            assert!((fit.error(norm) - found.1).abs() < 1e-9, "{norm:?}: {} {}", fit.error(norm), found.1);
            found
        };
        let error = errors[random.usize(..errors.len())].max(1e-3);
        let (count, found) = ours(SurfaceGoal::Within(error));
        let least = all().filter(|(_, of_mesh)| *of_mesh <= error).map(|(count, _)| count).min().unwrap();
        assert!(found <= error * (1.0 + 1e-9) && count <= 2 * least, "{error}: {found}, {count} for {least}");
        let most = 2 + random.usize(..28);
        let (count, found) = ours(SurfaceGoal::AtMost(most));
        let of_half = all().filter(|(count, _)| 2 * *count <= most.max(4)).map(|(_, error)| error);
        let of_half = of_half.fold(f64::INFINITY, f64::min);
        assert!(count <= most && found <= of_half + 1e-9, "at most {most}: {found} {of_half}");
    }
}

#[test]
fn each_point_of_a_curve_is_the_mesh_of_its_error_and_its_number() {
    let formula = |text: &str| SurfaceSource::Formula(Formula::parse(text).unwrap());
    for norm in SurfaceNorm::ALL {
        let of = |goal| {
            let source = formula("exp(-20 * ((x - 0.4)^2 + (y - 0.3)^2)) + 0.2 * x");
            let surface = LayerKind::Surface(Surface { source, goal, norm });
            let others = LayerKind::target(Formula::parse("if(x > 0.8, 0.1, inf)").unwrap());
            settings(Domain::rectangle(Rect::UNIT), 0.25, [others, surface])
        };
        // The goal of the document does not matter.
        let spec = of(SurfaceGoal::Within(0.3))
            .mesh_spec_on(of(SurfaceGoal::AtMost(9)).lattice().unwrap(), Limits::default());
        let [mut tracing, mut at_once] =
            [(); 2].map(|()| CurveTracing::new(spec.clone(), Parts::default(), norm, 3000));
        while tracing.advance(None, 97).unwrap() == Progress::More {}
        while at_once.advance(None, usize::MAX).unwrap() == Progress::More {}
        let curves = tracing.curves();
        assert_eq!(at_once.curves(), curves, "the slices do not matter");
        let others = curves.others.unwrap();
        assert_eq!(others.triangles, curves.least[0].triangles, "the curve begins with the other layers");
        assert!(curves.least.last().unwrap().triangles <= 3000 && curves.least.len() > 50);
        for point in curves.least.iter().skip(1).step_by(17) {
            let within = built(&of(SurfaceGoal::Within(point.error)), None).mesh;
            assert!(within.raw_triangle_count() <= point.triangles);
            let counted = built(&of(SurfaceGoal::AtMost(point.triangles)), None);
            let fit = counted.surface.as_ref().unwrap().samples().fit(counted.mesh.extract().view());
            assert!(fit.error(norm) <= point.error * (1.0 + 1e-9), "{norm:?}: {} {point:?}", fit.error(norm));
        }
        let counts: Vec<_> = curves.uniform.iter().map(|point| point.triangles).collect();
        assert_eq!(counts, (5..=11).map(|n| 1 << n).collect::<Vec<usize>>());
        assert!(curves.uniform.windows(2).filter(|pair| pair[1].error < pair[0].error).count() >= 5);
    }
}

#[test]
fn a_sample_on_a_side_counts_as_much_as_one_within() {
    let pixel = Rect::new(DVec2::splat(-0.25), DVec2::splat(1.25));
    for place in 0..9 {
        let raster = Raster::from_values(pixel, [3, 3], (0..9).map(|n| f32::from(n == place)).collect());
        let surface = of_raster(raster, SurfaceGoal::Within(9.0));
        let built = built(&settings(Domain::rectangle(Rect::UNIT), 1.0, [surface]), None);
        assert_eq!(built.mesh.raw_triangle_count(), 2);
        let fit = built.surface.as_ref().unwrap().samples().fit(built.mesh.extract().view());
        // Samples at corners are met. The one in the middle is on the common edge.
        let expected = if place % 2 == 1 || place == 4 { 1.0 / 3.0 } else { fit.rms };
        assert!((fit.rms - expected).abs() < 1e-12, "{place}: {}", fit.rms);
    }
}

/// Returns a number or one of its neighbours.
fn nudged(random: &mut fastrand::Rng, number: f64) -> f64 {
    [number.next_down(), number, number.next_up()][random.usize(..3)]
}

/// A small surface whose samples are in the domain by whole numbers: those of some columns and rows.
struct OnSides {
    domain: Rect,
    bounds: Rect,
    /// In columns and rows of samples, both included.
    inside: [[usize; 2]; 2],
    size: usize,
}

impl OnSides {
    fn random(random: &mut fastrand::Rng) -> Self {
        let size = 9;
        let (step, first) = (0.1, [(); 2].map(|()| 0.1 * f64::from(random.i32(-20..20))));
        let mut inside = [[0; 2]; 2];
        let mut sides = [[0.0; 2]; 2];
        for axis in 0..2 {
            let (low, high) = (random.usize(..3), 5 + random.usize(..4));
            // On samples, or between two of them.
            let off = [(); 2].map(|()| if random.u8(..3) == 0 { 0.2 + 0.6 * random.f64() } else { 0.0 });
            let at = |column: usize, off: f64| first[axis] + step * (column as f64 + off);
            sides[axis] = [nudged(random, at(low, -off[0])), nudged(random, at(high, off[1]))];
            inside[axis] = [low, high.min(size - 1)];
        }
        let domain = Rect::new(dvec2(sides[0][0], sides[1][0]), dvec2(sides[0][1], sides[1][1]));
        let corner = |from: f64| {
            let at = DVec2::from(first) + step * from;
            dvec2(nudged(random, at.x), nudged(random, at.y))
        };
        let [low, high] = [-0.5, size as f64 - 0.5].map(corner);
        Self { domain, bounds: Rect::new(low, high), inside, size }
    }

    fn is_inside(&self, n: usize) -> bool {
        let place = [n % self.size, n / self.size];
        (0..2).all(|axis| (self.inside[axis][0]..=self.inside[axis][1]).contains(&place[axis]))
    }

    fn values(&self, random: &mut fastrand::Rng, missing: f32) -> Vec<f32> {
        let value = |_| if random.f32() < missing { f32::NAN } else { random.f32() };
        (0..self.size * self.size).map(value).collect()
    }
}

#[test]
fn samples_beside_a_side_by_rounding_are_on_it() {
    let mut random = fastrand::Rng::with_seed(19);
    let mut has_missing = 0;
    for run in 0..crate::runs::runs(40) {
        let case = OnSides::random(&mut random);
        let (size, has_two) = ([case.size; 2], random.bool());
        let missing = if run % 2 == 0 { 0.0 } else { 0.1 };
        let values = [(); 2].map(|()| case.values(&mut random, missing));
        let step = case.bounds.size() / case.size as f64;
        // The mask ends between samples.
        let in_mask = |n: usize| has_two && (2..6).contains(&(n % 9)) && (3..7).contains(&(n / 9));
        let [from, to] = [dvec2(2.0, 3.0), dvec2(6.0, 7.0)].map(|at| case.bounds.min + at * step);
        let raster = |n: usize| {
            let raster = Raster::from_values(case.bounds, size.map(|n| n as u32), values[n].clone());
            of_raster(raster, SurfaceGoal::Within(0.3))
        };
        let kinds = [0, 1].into_iter().take(1 + usize::from(has_two)).map(raster);
        let mut settings = settings(Domain::rectangle(case.domain), 0.4, kinds);
        if has_two {
            let corners = [from, dvec2(to.x, from.y), to, dvec2(from.x, to.y)];
            settings.layers[2].mask = Some(Mask::new(&[vec![corners.to_vec()]]).unwrap());
        }
        let built = built(&settings, Some(12));
        let samples = built.surface.as_ref().unwrap().samples();
        let value = |n: usize| match f64::from(values[usize::from(in_mask(n))][n]) {
            value if value.is_nan() => f64::from(values[0][n]),
            value => value,
        };
        let inside: Vec<usize> = (0..81).filter(|&n| case.is_inside(n)).collect();
        let known: Vec<usize> = inside.iter().copied().filter(|&n| !value(n).is_nan()).collect();
        let count = samples.count();
        // A surface below without a value does not count where a mask has one of its own.
        assert_eq!([count.known, count.missing], [known.len(), inside.len() - known.len()], "{run}");
        has_missing += count.missing;
        if missing > 0.0 {
            continue;
        }
        let mesh = &built.mesh;
        let height = |point| samples.height_at(point).unwrap();
        let ids = || (0..mesh.raw_triangle_count()).map(TriangleId::from_index);
        let (mut squares, mut largest) = (0.0, 0.0_f64);
        for &n in &known {
            let place = case.bounds.min + step * (dvec2((n % 9) as f64, (n / 9) as f64) + 0.5);
            let within = place.clamp(case.domain.min, case.domain.max);
            let mut around = ids().map(|id| mesh.world_corners(id)).filter(|c| angle_at(*c, within) > 0.0);
            let corners = around.next().expect("the mesh covers the domain");
            let [a, b, c] = corners.map(|corner| corner.extend(height(corner)));
            let normal = (b - a).cross(c - a);
            let plane = a.z - normal.truncate().dot(within - a.truncate()) / normal.z;
            squares += (plane - value(n)).powi(2);
            largest = largest.max((plane - value(n)).abs());
        }
        let fit = samples.fit(mesh.extract().view());
        let rms = (squares / known.len() as f64).sqrt();
        assert!(largest <= 0.3 + 1e-9 && (fit.largest - largest).abs() < 1e-9, "{run}: {largest} {fit:?}");
        assert!((fit.rms - rms).abs() < 1e-9, "{run}: {} {rms}", fit.rms);
    }
    assert!(has_missing > 10, "{has_missing}");
}
