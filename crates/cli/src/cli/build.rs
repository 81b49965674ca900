//! Builds the mesh of an input, with progress on the terminal.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use glam::DVec2;

use super::failure::Failure;
use super::input::{Input, ToMesh};
use super::terminal::Terminal;
use meshbrush_core::build::{
    BuildError, BuildStage, BuiltMesh, CurveTracing, ErrorCurves, MeshBuilder, MeshSpec, Parts,
};
use meshbrush_core::domain::{BoundaryMarks, Domain, MeshBoundary, Region};
use meshbrush_core::earth::{Coordinates, EdgeLengths, Ground};
use meshbrush_core::explain::{Bisections, Explanation};
use meshbrush_core::field::RefinementRule;
use meshbrush_core::layers::{
    Combine, FormulaLayer, Layer, NODES_AT_A_TIME, PaintLayers, Quantity, RiskField, SurfaceNorm,
};
use meshbrush_core::outline::DerivedMesh;
use meshbrush_core::surface::SurfaceFit;
use meshbrush_io::io::{Cancelled, DocumentPlane, Meter};
use meshbrush_mesh::mesh::{
    CoarseError, CurveOrder, Extract, InvalidTarget, Mesh, Progress, TreeTriangle, TriangleId,
};
use meshbrush_mesh::text::{Grouped, LengthUnit};

/// Triangles visited between two updates of the progress line.
const SLICE: usize = 1 << 18;

/// A mesh that was asked for, and how it was made.
pub struct FinishedMesh {
    built: BuiltMesh,
    /// The differences of the exported mesh from the mesh.
    pub derived: DerivedMesh,
    origin: MeshOrigin,
    /// Time spent on refinement alone.
    pub refinement: Duration,
    /// Triangles that the level cap left coarser than their target.
    pub capped: usize,
    /// How lengths and areas are measured, once somebody asked.
    ground: OnceLock<Ground>,
}

/// What a mesh was made from.
#[derive(Clone)]
pub struct MeshOrigin {
    /// The description of the mesh.
    pub spec: MeshSpec,
    /// The paint of the layers.
    pub paint: PaintLayers,
    /// Names and types of its boundary.
    pub marks: Arc<BoundaryMarks>,
    /// The unit of coordinates and lengths.
    pub unit: LengthUnit,
    /// The coordinates of exported files, unless others are asked for; see [`ToMesh`].
    pub coordinates: Coordinates,
    /// What coordinates of files are that do not name a known system.
    pub assumed: Option<Coordinates>,
}

impl FinishedMesh {
    /// Returns the deepest level that a triangle may have, if there is one.
    pub fn max_level(&self) -> Option<u32> {
        self.origin.spec.limits.max_level
    }

    /// Puts a mesh together.
    ///
    /// # Errors
    /// Fails when nothing is left of the mesh in the domain.
    pub fn new(
        built: BuiltMesh,
        derived: DerivedMesh,
        origin: MeshOrigin,
        refinement: Duration,
        capped: usize,
    ) -> Result<Self, CoarseError> {
        if derived.patch().leaves_nothing_of(&built.mesh) {
            return Err(CoarseError::EmptyDomain { spacing: built.mesh.lattice().spacing() });
        }
        Ok(Self { built, derived, origin, refinement, capped, ground: OnceLock::new() })
    }

    /// Returns the mesh with triangles bisected, and others only to keep it conforming, and its nodes on the
    /// outline again.
    ///
    /// # Errors
    /// Fails when a limit is reached.
    pub fn bisected(&self, marked: &[TriangleId]) -> Result<Self, BuildError> {
        let mut built = self.built.clone();
        built.bisect(marked, &self.origin.spec.limits)?;
        let targets = built.edge_targets(&self.origin.paint);
        let derived = DerivedMesh::new(&built.mesh, &built.domain, targets, &self.origin.spec.cleaning);
        Ok(Self::new(built, derived, self.origin.clone(), self.refinement, self.capped)?)
    }

    /// Returns the mesh with its size field.
    pub fn built(&self) -> &BuiltMesh {
        &self.built
    }

    /// Returns the paint of the layers.
    pub fn paint(&self) -> &PaintLayers {
        &self.origin.paint
    }

    /// Returns the unit of coordinates and lengths.
    pub fn unit(&self) -> LengthUnit {
        self.origin.unit
    }

    /// Returns the coordinates of exported files, unless others are asked for; see [`ToMesh`].
    pub fn coordinates(&self) -> Coordinates {
        self.origin.coordinates
    }

    /// Returns the mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.built.mesh
    }

    /// Returns the mesh as files get it, numbered along the curve.
    pub fn extract(&self) -> Extract<'static> {
        self.extract_as_made().along_curve()
    }

    /// [`Self::extract`] with the numbers of the mesh: for where no number is told.
    pub fn extract_as_made(&self) -> Extract<'_> {
        self.derived.extract(self.mesh())
    }

    /// Returns the order of [`Self::extract`] in numbers of [`Self::extract_as_made`].
    pub fn curve_order(&self) -> CurveOrder {
        self.extract_as_made().curve_order()
    }

    /// Returns the polygons that the mesh meets, if there are some: those of the domain, or the zero line of
    /// its formula.
    pub fn outline(&self) -> Option<Arc<Region>> {
        self.origin.spec.domain.outline(self.origin.spec.boundary)
    }

    /// Returns the boundary of the mesh as files get it, in named pieces.
    pub fn boundary(&self, extract: &Extract) -> MeshBoundary {
        let boundary = MeshBoundary::new(extract, &self.origin.spec.domain, &self.origin.marks);
        boundary.on_ground(extract, self.ground())
    }

    /// Names, types and splits of the boundary.
    pub fn marks(&self) -> &BoundaryMarks {
        &self.origin.marks
    }

    /// Which points of a triangle count.
    pub fn rule(&self) -> RefinementRule {
        self.built.rule
    }

    /// h̄ at a point of the domain, both in world units, as the rule sees it. Where it is impossible, the
    /// impossible value.
    pub fn target_at(&self, point: DVec2) -> f64 {
        let target = self.built.field.target_by_rule(self.built.rule, &self.origin.paint, point);
        self.built.field.scale() * target
    }

    /// h̄ at every node, in world units. The meter counts nodes.
    ///
    /// # Errors
    /// Fails when the work was cancelled.
    pub fn target_at_nodes(&self, extract: &Extract, meter: &Meter) -> Result<Vec<f64>, Cancelled> {
        let BuiltMesh { field, rule, .. } = &self.built;
        meter.expect(extract.nodes().len() as u64);
        let of_field =
            field.targets_at_nodes(*rule, &self.origin.paint, extract, || meter.add(NODES_AT_A_TIME));
        let mut targets = of_field?;
        targets.iter_mut().for_each(|target| *target *= field.scale());
        Ok(targets)
    }

    /// Returns the risk of the layers.
    pub fn risk(&self) -> RiskField {
        RiskField::new(self.layers(), &self.origin.paint).within(&self.origin.spec.domain.bounds)
    }

    /// Returns the domain, in world units.
    pub fn domain(&self) -> &Domain {
        &self.origin.spec.domain
    }

    /// Returns the error of meshes against the number of their triangles, with no more than `most` of them,
    /// by a norm. `goes_on` is called with the number of triangles so far. `None` once it says that nobody
    /// wants them any more.
    ///
    /// # Errors
    /// Fails when a mesh without the surfaces cannot be made.
    pub fn error_curves(
        &self,
        norm: SurfaceNorm,
        most: usize,
        mut goes_on: impl FnMut(usize) -> bool,
    ) -> Result<Option<ErrorCurves>, BuildError> {
        let BuiltMesh { domain, field, surface, .. } = &self.built;
        let samples = surface.as_ref().map(|rule| rule.samples().clone());
        let (domain, field) = (Some(domain.clone()), Some(field.clone()));
        let parts = Parts { domain, field, samples, spare: None };
        let mut tracing = CurveTracing::new(self.origin.spec.clone(), parts, norm, most);
        while tracing.advance(Some(&self.origin.paint), SLICE)? == Progress::More {
            if !goes_on(tracing.progress()[0]) {
                return Ok(None);
            }
        }
        Ok(Some(tracing.curves().clone()))
    }

    /// Returns the description of the mesh.
    pub fn spec(&self) -> &MeshSpec {
        &self.origin.spec
    }

    /// Returns the plane of the domain, if it is that of a projection, for files that are read into it.
    pub fn plane(&self) -> Option<DocumentPlane> {
        let plane = |projection| DocumentPlane { projection, assumed: self.origin.assumed };
        self.domain().projection.map(plane)
    }

    /// Returns how lengths and areas are measured.
    pub fn ground(&self) -> &Ground {
        self.ground.get_or_init(|| self.domain().ground())
    }

    /// Returns why a triangle is in the mesh.
    pub fn explanation(&self, id: TriangleId) -> Explanation {
        let criterion = self.built.criterion(Some(&self.origin.paint));
        let mesh = &self.built.mesh;
        Explanation::new(mesh, TreeTriangle::from_mesh(mesh, id), &criterion, &self.origin.spec.limits)
    }

    /// Returns which bisections of the mesh its criterion asks for.
    pub fn bisections(&self) -> Bisections {
        let criterion = self.built.criterion(Some(&self.origin.paint));
        Bisections::of(&self.built.mesh, &criterion, &self.origin.spec.limits)
    }

    /// Returns how far the mesh as files get it is from the surfaces of its layers, if one is a surface.
    pub fn surface_fit(&self, extract: &Extract) -> Option<SurfaceFit> {
        self.built.surface.as_ref().map(|rule| rule.samples().fit(extract.view()))
    }

    /// Returns the diameters of triangles, which targets are compared with.
    pub fn edge_lengths(&self) -> &EdgeLengths {
        self.built.field.edge_lengths()
    }

    /// Returns sentences about what the document asks for and the mesh does not have.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        let spec = &self.origin.spec;
        let line = spec.domain.outline_error(spec.boundary).map(|error| error.to_string());
        line.into_iter().chain(self.surface_note())
    }

    /// Returns a sentence where a surface asks for fewer triangles than coarse grid and sizes need.
    fn surface_note(&self) -> Option<String> {
        let most = self.built.surface.as_ref()?.exceeded_count()?;
        Some(format!(
            "A mesh of at most {} triangles, as the surface asks for, cannot be made: without the surface it has {} already. \
             Ask for more, take a larger spacing, or ask for larger triangles elsewhere.",
            Grouped(most),
            Grouped(self.built.mesh.triangles().count())
        ))
    }

    /// Returns the layers of the size field, from the bottom to the top.
    pub fn layers(&self) -> &[Layer] {
        &self.built.field.spec().layers
    }

    /// Returns the smallest target diameter, in world units: that of the limits, or a layer below which
    /// nothing gets finer.
    pub fn smallest_diameter(&self) -> f64 {
        let is_floor = |layer: &&Layer| layer.combine == Combine::Floor && layer.mask.is_none();
        let diameter = |layer: &Layer| {
            let floor: &FormulaLayer = layer.kind.get()?;
            floor.formula.constant().filter(|_| floor.quantity == Quantity::Diameter)
        };
        let floors = self.layers().iter().filter(is_floor).filter_map(diameter);
        floors.fold(self.spec().field.transfer.h_min, f64::max)
    }

    /// Returns the triangles whose diameter exceeds their target.
    ///
    /// # Errors
    /// Fails when a target is impossible.
    pub fn unsatisfied(&self) -> Result<Vec<TriangleId>, InvalidTarget> {
        self.built.unsatisfied(Some(&self.origin.paint))
    }
}

/// Reads the files of an input, and builds the mesh.
///
/// # Errors
/// Fails when a file cannot be used, the target is impossible somewhere, or a limit is reached.
pub fn build(input: &Input, terminal: &mut Terminal) -> Result<FinishedMesh, Failure> {
    build_from(input.read(terminal)?, terminal)
}

/// Builds the mesh of what was read.
///
/// # Errors
/// Fails when the target is impossible somewhere, or a limit is reached.
pub fn build_from(read: ToMesh, terminal: &mut Terminal) -> Result<FinishedMesh, Failure> {
    let scale = read.scale;
    let origin = read.origin();
    let mut builder = MeshBuilder::new(origin.spec.clone()).scaled(scale);
    let refinement = refine(&mut builder, &origin.paint, terminal);
    terminal.clear();
    let (refinement, capped) = (refinement?, builder.capped());
    let built = builder.finish();
    let targets = built.edge_targets(&origin.paint);
    let derive = || DerivedMesh::new(&built.mesh, &built.domain, targets, &origin.spec.cleaning);
    let derived = terminal.while_working("fitting the mesh to its domain", derive);
    let finished = FinishedMesh::new(built, derived, origin, refinement, capped)?;
    finished.notes().for_each(|note| terminal.note(&note));
    Ok(finished)
}

impl ToMesh {
    /// Returns what the mesh is made from.
    pub fn origin(self) -> MeshOrigin {
        let Self { spec, paint, marks, unit, coordinates, assumed, paths: _, scale: _ } = self;
        MeshOrigin { spec, paint, marks, unit, coordinates, assumed }
    }
}

/// Builds in slices. Returns the time spent on refinement.
///
/// # Errors
/// Fails when the target is impossible somewhere, or a limit is reached.
pub fn refine(
    builder: &mut MeshBuilder,
    paint: &PaintLayers,
    terminal: &mut Terminal,
) -> Result<Duration, Failure> {
    let start = Instant::now();
    let mut refinement = Duration::ZERO;
    loop {
        let (stage, slice_start) = (builder.stage(), Instant::now());
        let progress = builder.advance(Some(paint), SLICE)?;
        if matches!(stage, BuildStage::Refining { .. }) {
            refinement += slice_start.elapsed();
        }
        if progress == Progress::Done {
            return Ok(refinement);
        }
        terminal.progress(start, || describe(builder.stage()));
    }
}

fn describe(stage: BuildStage) -> String {
    match stage {
        BuildStage::Indexing => "indexing the outline".into(),
        BuildStage::Checking => "checking the layers".into(),
        BuildStage::Refining { triangles } | BuildStage::Classifying { triangles } => {
            format!("{} triangles", Grouped(triangles))
        }
    }
}
