//! Smaller triangles where a mesh breaks a rule of its solver.
//!
//! The mesh itself is mended, and not the file: layers ask for one more bisection of each triangle that
//! breaks a rule, so that window, files and fingerprint agree. The mesh that follows is looked at again,
//! until no rule is broken that a bisection can mend, or none of the further bisections helped.
//!
//! ```text
//!      open
//!   o--------o     The triangle at the corner has three nodes on the boundary. A layer asks for a diameter
//!   |     ╱  |     between that of the triangle and that of its halves, in a disc around its incentre ×
//!   |  × ╱ ╲ |     and nowhere else. So this triangle is bisected, once, and its neighbours only where the
//!   |  ╱     o     mesh has to stay conforming.
//! ```

use std::collections::HashSet;

use glam::DVec2;

use super::{BrokenRule, Solver, broken_among, plain_mesh, rules_of};
use meshbrush_core::build::{BuiltMesh, MeshSpec};
use meshbrush_core::document::{Document, Setting, unused_name};
use meshbrush_core::domain::BoundaryMarks;
use meshbrush_core::field::Formula;
use meshbrush_core::layers::{
    Combine, DistanceLayer, DistanceTo, Layer, LayerId, LayerKind, PaintLayers, ShapeList, Shapes,
    ShapesError,
};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_mesh::mesh::{Extract, Mesh, TriangleId};

/// The most bisections of a triangle and its parts: what these do not mend, no more would. Between the sides
/// of a sharp corner there is one triangle at every level.
const MOST_BISECTIONS: u32 = 4;
/// The most meshes that are looked at.
const MOST_MESHES: usize = 24;
/// The diameter that is asked for, as a share of that of the triangle. Its halves have 0.707.
const ASKED: f64 = 0.98;
/// The largest triangle that is bisected once for the same diameter as another one, as a share of that. Its
/// halves are at most 0.97 times the smaller triangle, and are not bisected.
const LARGEST_SHARE: f64 = 1.36;
/// The radius of the disc in which it is asked for, as a share of the diameter; the incircle has 0.2.
const DISC: f64 = 0.05;

/// What a mesh needs to keep the rules of a solver.
#[derive(Debug)]
pub struct Repaired {
    /// Layers, to lie above all others.
    pub layers: Vec<Layer>,
    /// The smallest target diameter, if it has to be less than it was. The first of the layers keeps the
    /// former one everywhere else.
    pub h_min: Option<f64>,
    /// The triangles for which they ask for a bisection.
    pub bisected: usize,
    /// The rules that smaller triangles could mend, and did not.
    pub left: Vec<BrokenRule>,
}

impl Repaired {
    /// Returns the number of places that smaller triangles could mend, and did not.
    pub fn places_left(&self) -> usize {
        self.left.iter().map(|broken| broken.found.len()).sum()
    }

    /// Returns the settings with which the document has the layers, with names and identifiers of their own.
    pub fn settings_for(&self, document: &Document) -> Vec<Setting> {
        let mut layers = document.settings().layers.clone();
        for (layer, id) in self.layers.iter().zip(document.unused_layer_ids()) {
            let name = unused_name(&layers, &layer.name);
            layers.push(Layer { id, name, ..layer.clone() });
        }
        let smallest = self.h_min.map(Setting::SmallestDiameter);
        let added = (!self.layers.is_empty()).then_some(Setting::Layers(layers));
        smallest.into_iter().chain(added).collect()
    }
}

/// A triangle that is bisected for a rule.
#[derive(Clone, Debug)]
struct FinerTriangle {
    corners: [DVec2; 3],
    level: u32,
    /// The length that its target is compared with: its diameter by the scale of the targets.
    diameter: f64,
    /// The triangle of the first mesh that it is a part of.
    first: TriangleId,
}

/// The triangles to be bisected so far.
#[derive(Debug, Default)]
struct Finer {
    /// The mesh before any repair, once there is one.
    first_mesh: Option<Mesh>,
    triangles: Vec<FinerTriangle>,
    /// Triangles of the first mesh in which bisections did not help.
    given_up: HashSet<TriangleId>,
}

/// Returns layers with which a mesh keeps the rules of a solver, as far as smaller triangles help: those that
/// leave the fewest places.
///
/// `make` makes the mesh of a description with the pixels of `paint`, and multiplies its targets by `scale`;
/// `marks` are the names of its boundary. The vertex rule looks at h̄ in nodes only, so under it the layers
/// change nothing.
///
/// # Errors
/// Fails when `make` does.
pub fn repaired<E>(
    solver: Solver,
    spec: &MeshSpec,
    marks: &BoundaryMarks,
    (scale, paint): (f64, &PaintLayers),
    mut make: impl FnMut(MeshSpec) -> Result<BuiltMesh, E>,
) -> Result<Repaired, E> {
    let mut finer = Finer::default();
    let mut best: Option<Repaired> = None;
    for _ in 0..MOST_MESHES {
        let (layers, h_min) = finer.ask(spec, solver, scale);
        let bisected = finer.triangles.len();
        let mut asking = spec.clone();
        asking.field.layers.extend(layers.iter().cloned());
        asking.field.transfer.h_min = h_min.unwrap_or(spec.field.transfer.h_min);
        let built = make(asking)?;
        let targets = built.edge_targets(paint);
        let derived = DerivedMesh::new(&built.mesh, &built.domain, targets, &spec.cleaning);
        let extract = derived.extract(&built.mesh);
        let left = broken_in(&extract, spec, marks, solver);
        let goes_on = finer.learn(&built, &extract, &left);
        let found = Repaired { layers, h_min, bisected, left };
        // In a sharp corner several small triangles can break the rule of a large one.
        if best.as_ref().is_none_or(|best| found.places_left() < best.places_left()) {
            best = Some(found);
        }
        if !goes_on {
            break;
        }
    }
    Ok(best.expect("one mesh at least was looked at"))
}

/// Returns the broken rules that smaller triangles can mend. They are about the boundary and not about
/// coordinates, so those of the plane are as good as those of the file.
fn broken_in(extract: &Extract, spec: &MeshSpec, marks: &BoundaryMarks, solver: Solver) -> Vec<BrokenRule> {
    let mended = rules_of(solver).filter(|rule| rule.is_mended_by_size);
    broken_among(mended, &plain_mesh(extract, &spec.domain, marks, solver))
}

impl Finer {
    /// Adds the triangles that break rules, and returns whether another mesh follows from that.
    fn learn(&mut self, built: &BuiltMesh, extract: &Extract, broken: &[BrokenRule]) -> bool {
        let found = broken.iter().flat_map(|broken| &broken.found).flat_map(|found| &found.mended_in);
        let mut ids: Vec<TriangleId> = found.filter_map(|&index| source(built, extract, index)).collect();
        ids.sort_unstable();
        ids.dedup();
        self.first_mesh.get_or_insert_with(|| built.mesh.clone());
        let mut changed = false;
        for id in ids {
            changed |= self.add(built, id);
        }
        changed
    }

    /// Adds a triangle, or gives up on the one of the first mesh that it is a part of. Returns whether
    /// anything changed.
    fn add(&mut self, built: &BuiltMesh, id: TriangleId) -> bool {
        let (mesh, Some(first_mesh)) = (&built.mesh, &self.first_mesh) else { return false };
        let level = mesh.raw_triangles()[id.index()].level();
        let lattice_corners = mesh.corners(id);
        let corners = lattice_corners.map(|corner| mesh.lattice().world_from_lattice(corner));
        let place = corners.iter().sum::<DVec2>() / 3.0;
        let Some(first) = first_mesh.locate(place).triangle().filter(|first| !self.given_up.contains(first))
        else {
            return false;
        };
        let depth = level.saturating_sub(first_mesh.raw_triangles()[first.index()].level());
        let was_asked = self.triangles.iter().any(|it| it.level >= level && contains(&it.corners, place));
        if was_asked || depth >= MOST_BISECTIONS {
            self.triangles.retain(|triangle| triangle.first != first);
            self.given_up.insert(first);
            return true;
        }
        let diameter = built.field.edge_lengths().of(lattice_corners, level);
        self.triangles.push(FinerTriangle { corners, level, diameter, first });
        true
    }

    /// Returns layers that ask for these bisections, and the smallest target diameter where it has to be
    /// less.
    fn ask(&self, spec: &MeshSpec, solver: Solver, scale: f64) -> (Vec<Layer>, Option<f64>) {
        let h_min = spec.field.transfer.h_min;
        let mut kinds = self.kinds(scale);
        let least = kinds.iter().map(|kind| kind.at_zero).fold(f64::INFINITY, f64::min);
        let unused = 1 + spec.field.layers.iter().map(|layer| layer.id.0).max().unwrap_or(0);
        let mut layers = Vec::new();
        let less = (least < h_min).then_some(least);
        if less.is_some() {
            let smallest = LayerKind::target(Formula::constant_of(h_min));
            let layer = Layer::new(LayerId(unused), "Smallest diameter elsewhere", smallest);
            layers.push(Layer { combine: Combine::Floor, ..layer });
        }
        for (kind, number) in kinds.drain(..).zip(1..) {
            let (id, name) = (unused + number, format!("Repair for {} {number}", solver.name()));
            layers.push(Layer::new(LayerId(id), name, LayerKind::Distance(kind)));
        }
        (layers, less)
    }

    /// Returns the distances that ask for these bisections: one for triangles of about the same size.
    fn kinds(&self, scale: f64) -> Vec<DistanceLayer> {
        // Where a part of a triangle is bisected, so is the triangle.
        let is_innermost = |triangle: &&FinerTriangle| {
            let holds = |other: &FinerTriangle| {
                other.level > triangle.level && contains(&triangle.corners, incentre(other.corners))
            };
            !self.triangles.iter().any(holds)
        };
        let mut triangles: Vec<&FinerTriangle> = self.triangles.iter().filter(is_innermost).collect();
        triangles.sort_by(|a, b| a.diameter.total_cmp(&b.diameter));
        let mut kinds = Vec::new();
        let mut rest = &triangles[..];
        while let Some(least) = rest.first().map(|triangle| triangle.diameter) {
            let end = rest.partition_point(|triangle| triangle.diameter <= LARGEST_SHARE * least);
            let incentres = rest[..end].iter().map(|triangle| incentre(triangle.corners)).collect();
            rest = &rest[end..];
            // There is one place at least, and all are finite.
            kinds.extend(asking_for(ASKED * least, DISC * least * scale, incentres).ok());
        }
        kinds
    }
}

/// Returns the layer of a diameter in discs around places.
fn asking_for(diameter: f64, radius: f64, places: Vec<DVec2>) -> Result<DistanceLayer, ShapesError> {
    let shapes = Shapes::new(ShapeList { points: places, ..ShapeList::default() }, false)?;
    let to = DistanceTo::Shapes { name: String::new(), shapes };
    Ok(DistanceLayer { to, at_zero: diameter, slope: 0.0, range: radius })
}

/// Returns the triangle of the mesh in which one of its files is, by its number there. Where nodes were
/// moved, the middle of the latter can be beyond the mesh, and a place near a corner is not.
fn source(built: &BuiltMesh, extract: &Extract, index: usize) -> Option<TriangleId> {
    let corners = extract.view().world_corners(TriangleId::from_index(index));
    let middle = corners.iter().sum::<DVec2>() / 3.0;
    let near_corners = corners.map(|corner| middle.lerp(corner, 0.7));
    std::iter::once(middle).chain(near_corners).find_map(|place| built.mesh.locate(place).triangle())
}

/// Returns whether a place is inside a triangle.
fn contains(corners: &[DVec2; 3], place: DVec2) -> bool {
    let sides = [0, 1, 2].map(|k| (corners[(k + 1) % 3] - corners[k]).perp_dot(place - corners[k]));
    sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0)
}

fn incentre([a, b, c]: [DVec2; 3]) -> DVec2 {
    let [p, q, r] = [b.distance(c), c.distance(a), a.distance(b)];
    (p * a + q * b + r * c) / (p + q + r)
}
