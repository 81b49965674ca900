//! The mesh of a document as files get it: written to one, and measured before it is.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::file_coordinates::FileCoordinates;
use super::session::Session;
use super::view::{Space, View};
use meshbrush_core::document::Settings;
use meshbrush_core::domain::{DomainOnLattice, MeshBoundary};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::{NodeDepths, PaintLayers, SizeField};
use meshbrush_core::outline::{DerivedMesh, EdgeTargets, LineEdges};
use meshbrush_core::surface::{HeightSource, SurfaceRule};
use meshbrush_io::io::solver_rules::{BrokenRule, Severity, Solver, WrittenMesh, broken_rules};
use meshbrush_io::io::{
    CellShape, DEPTH, JoinedCells, MeshData, MeshSource, Meter, NodeValues, Provenance, SURFACE,
    joined_cells, weir_notes,
};
use meshbrush_mesh::mesh::{Extract, Fingerprint, Mesh, MeshView};
use meshbrush_render::render::export::ExportFormat;
use meshbrush_render::render::look::Look;
use meshbrush_render::render::overlay::PictureOverlay;
use meshbrush_render::render::space_look::SpaceLook;
use meshbrush_render::scene::NodeHeights;

/// Makes the overlay of a picture of an extract; `None` where nobody wants it any more.
pub type OverlayMaker = Box<dyn Fn(&Extract, &Meter) -> Option<PictureOverlay> + Send>;

/// A mesh, and what its files get beside it.
pub struct MeshExport {
    format: ExportFormat,
    mesh: Arc<Mesh>,
    domain: DomainOnLattice,
    field: Arc<SizeField>,
    settings: Settings,
    paint: PaintLayers,
    surface: Option<Arc<SurfaceRule>>,
    look: Look,
    /// The coordinates of a document in the plane of a projection.
    coordinates: FileCoordinates,
    /// The view in space that a picture shows.
    space: Option<Space>,
    /// Makes the overlay that a picture of the plan shows.
    overlay: Option<OverlayMaker>,
}

/// What was written.
pub struct WrittenExport {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Quadrilaterals, and triangles.
    pub cells: [usize; 2],
    /// What a person should know about weirs in them, a sentence each.
    pub notes: Vec<String>,
}

/// What the files of a mesh will have in them.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportFigures {
    /// Bytes of all files together; `None` of a picture, which is drawn for that.
    pub bytes: Option<u64>,
    /// Triangles.
    pub triangles: usize,
    /// Nodes.
    pub nodes: usize,
    /// Quadrilaterals, of two triangles each.
    pub squares: usize,
    /// How the nodes get their depths; `None` without a layer of depths.
    pub depths: Option<DepthFigures>,
    /// The rules of the solver of the format that the files break, in a sentence each; `None` for a format of
    /// no solver.
    pub broken_rules: Option<Vec<String>>,
    /// Whether an edge of the boundary is open.
    pub has_open_edge: bool,
}

/// How the nodes of a mesh get their depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthFigures {
    /// The nodes where no layer has a value: they get that of the nearest pixel.
    pub filled: usize,
    /// The distance of the farthest of these pixels, in world units.
    pub farthest: f64,
}

impl ExportFigures {
    /// Returns whether the format has a solver, and the files keep all its rules.
    pub fn is_ready(&self) -> bool {
        self.broken_rules.as_ref().is_some_and(Vec::is_empty)
    }
}

impl MeshExport {
    /// Takes the mesh on the screen for files of a format, and the colours of the view for a picture.
    pub fn of(session: &Session, view: &View, format: ExportFormat) -> Self {
        let (follower, document) = (session.follower(), session.document());
        let is_picture = matches!(format, ExportFormat::Png | ExportFormat::Svg);
        Self {
            format,
            mesh: follower.shared_mesh(),
            domain: follower.domain().clone(),
            field: follower.shared_field(),
            settings: follower.settings().clone(),
            paint: document.paint().clone(),
            surface: follower.surface().cloned(),
            look: view.picture_of(document.settings()),
            coordinates: view.file_coordinates,
            space: is_picture.then_some(view.space).filter(|space| space.is_on),
            overlay: None,
        }
    }

    /// Lets a picture of the plan show an overlay in place of the levels.
    pub fn with_overlay(self, overlay: Option<OverlayMaker>) -> Self {
        Self { overlay, ..self }
    }

    /// Writes the files, and returns their names, the cells in them (squares, and triangles), and notes for a
    /// person on weirs.
    ///
    /// # Errors
    /// Fails when a file cannot be written, nodes have no depth, the format cannot hold the mesh, or the work
    /// was cancelled. Existing files are then unchanged.
    pub fn write(&self, file: &Path, meter: &Meter) -> io::Result<WrittenExport> {
        let (extract, lines, weir_notes) = self.extract();
        let (values, _) = self.values_at_nodes(extract.view())?;
        self.with_data((&extract, &lines), &values, meter, |placed, data| {
            let in_space = |space| self.look_in_space(&space, &extract);
            let space = self.space.and_then(in_space);
            let overlay = self.overlay.as_ref().filter(|_| space.is_none());
            let overlay = overlay.and_then(|make| make(&extract, meter));
            meter.check()?;
            let look = Look { space, overlay, ..self.look.clone() };
            let files = self.format.write(file, &self.mesh, placed, data, &look, meter)?;
            let squares = self.squares(placed, data);
            let cells = [squares, extract.triangles().len() - 2 * squares];
            Ok(WrittenExport { files, cells, notes: self.notes(weir_notes, placed, data) })
        })
    }

    /// Returns what the files will have in them.
    ///
    /// # Errors
    /// Fails as [`Self::write`] does, except for errors of the file system.
    pub fn measure(&self, meter: &Meter) -> io::Result<ExportFigures> {
        let (extract, lines, _) = self.extract();
        let (values, depths) = self.values_at_nodes(extract.view())?;
        self.with_data((&extract, &lines), &values, meter, |placed, data| {
            let pieces = data.boundary.pieces().list();
            let is_open = |piece: usize| pieces[piece].boundary_type().is_open();
            let bytes = match self.format {
                ExportFormat::Mesh(format) => Some(format.exact_bytes(placed, data, meter)?),
                _ => None,
            };
            let squares = self.squares(placed, data);
            let solver = Solver::of_format(self.format.name());
            let broken_rules = solver.map(|solver| {
                let broken = broken_rules(&WrittenMesh::of(placed, data, solver), solver);
                let violations = broken.iter().filter(|broken| broken.rule.severity == Severity::Violation);
                violations.map(|broken| broken.in_words(solver)).collect()
            });
            Ok(ExportFigures {
                bytes,
                squares,
                broken_rules,
                triangles: extract.triangles().len(),
                nodes: extract.nodes().len(),
                depths,
                has_open_edge: data.boundary.present().any(is_open),
            })
        })
    }

    /// Returns the rules of a solver that the mesh breaks in the coordinates of a file, with the places in
    /// world units.
    ///
    /// # Errors
    /// Fails when nodes have no depth, and when the work was cancelled.
    pub fn broken_rules(&self, solver: Solver, meter: &Meter) -> io::Result<Vec<BrokenRule>> {
        let (extract, lines, _) = self.extract();
        let (values, _) = self.values_at_nodes(extract.view())?;
        let mut broken = self.with_data((&extract, &lines), &values, meter, |placed, data| {
            Ok(broken_rules(&WrittenMesh::of(placed, data, solver), solver))
        })?;
        if let Some(projection) = self.settings.domain.projection.filter(|_| !self.is_in_plane()) {
            let places = broken.iter_mut().flat_map(|broken| &mut broken.found);
            places.for_each(|found| found.place = projection.plane_from_geographic(found.place));
        }
        Ok(broken)
    }

    /// Returns whether files of a document in the plane of a projection are in that plane.
    fn is_in_plane(&self) -> bool {
        self.coordinates.is_plane(self.format, self.surface.is_some())
    }

    /// Returns how many quadrilaterals the files have.
    fn squares(&self, placed: &Extract, data: &MeshData) -> usize {
        if self.format.wants_squares() { joined_cells(placed, data).joined_count() } else { 0 }
    }

    /// Returns what a person should know about weirs in the files: their gaps, and what of them is lost.
    fn notes(&self, mut gaps: Vec<String>, placed: &Extract, data: &MeshData) -> Vec<String> {
        let ExportFormat::Mesh(format) = self.format else { return Vec::new() };
        if self.settings.lines.iter().any(|line| line.weir().is_some()) {
            match format.has_weirs() {
                true => gaps.extend(weir_notes(placed, data)),
                false => gaps
                    .push("The file has no place for crests: weirs are edges without a crack there.".into()),
            }
        }
        gaps
    }

    /// Returns the mesh as files get it, its edges along lines, and notes on gaps of weirs.
    fn extract(&self) -> (Extract<'static>, Vec<LineEdges>, Vec<String>) {
        let targets = EdgeTargets::by_rule(self.settings.rule, &self.field, &self.paint);
        let cleaning = self.settings.derived_cleaning();
        let derived = DerivedMesh::new(&self.mesh, &self.domain, targets, &cleaning);
        let extract = derived.extract(&self.mesh).along_curve();
        let lines = LineEdges::all(derived.line_fits(), &self.settings.lines, &extract);
        let fits = self.settings.lines.iter().zip(derived.line_fits());
        let weirs = fits.filter(|(line, _)| line.weir().is_some());
        let notes = weirs.filter_map(|(_, fit)| fit.weir_note()).collect();
        (extract, lines, notes)
    }

    /// Calls `use_data` with the mesh in the coordinates of its files, and its data.
    fn with_data<T>(
        &self,
        (extract, lines): (&Extract, &[LineEdges]),
        values: &[NodeValues],
        meter: &Meter,
        use_data: impl FnOnce(&Extract, &MeshData) -> io::Result<T>,
    ) -> io::Result<T> {
        let settings = &self.settings;
        let target_diameter = match self.format.has_targets() {
            true => self.field.targets_at_nodes(settings.rule, &self.paint, extract, || meter.check())?,
            false => Vec::new(),
        };
        let boundary = MeshBoundary::new(extract, &settings.domain, &settings.boundary_marks);
        let heights = values.iter().find(|values| values.name == SURFACE).map(|it| &*it.values);
        let data = MeshData {
            target_diameter: &target_diameter,
            quantities: values,
            heights,
            boundary: &boundary,
            lines,
            parts: &extract.part_numbers(),
            cells: CellShape::OfFormat,
            joined: &JoinedCells::default(),
            parts_for: None,
            provenance: &provenance_of(settings, self.mesh.fingerprint(), self.is_in_plane()),
        };
        let nodes =
            settings.domain.nodes_in(&Coordinates::Geographic, extract).filter(|_| !self.is_in_plane());
        let placed = nodes.map(|nodes| extract.with_coordinates(nodes));
        use_data(placed.as_ref().unwrap_or(extract), &data)
    }

    /// Returns the depths and the heights of surfaces at the nodes, where layers have them and the format
    /// holds them, and how the nodes get their depths.
    fn values_at_nodes(&self, mesh: MeshView) -> io::Result<(Vec<NodeValues>, Option<DepthFigures>)> {
        if !self.format.wants_node_data() {
            return Ok((Vec::new(), None));
        }
        let depths = NodeDepths::of(&self.settings.layers, mesh).transpose().map_err(io::Error::other)?;
        let figures =
            depths.as_ref().map(|&NodeDepths { filled, farthest, .. }| DepthFigures { filled, farthest });
        let depths = depths.map(|depths| (DEPTH, depths.depths));
        let heights = self.surface.as_ref().map(|rule| (SURFACE, rule.samples().filled_heights(mesh)));
        let named = |(name, values): (&str, Vec<f64>)| NodeValues { name: name.into(), values };
        Ok((depths.into_iter().chain(heights).map(named).collect(), figures))
    }

    /// Returns how a picture looks in space; `None` where no layer has heights.
    fn look_in_space(&self, space: &Space, extract: &Extract) -> Option<SpaceLook> {
        let heights = HeightSource::new(self.surface.as_deref(), &self.settings.layers)?;
        let heights = heights.at_nodes(extract.lattice(), extract.nodes());
        Some(space.picture(NodeHeights::new(&heights, &[])?, extract.lattice()))
    }
}

/// Returns the origin of a mesh, with its coordinates.
fn provenance_of(settings: &Settings, fingerprint: Fingerprint, in_plane: bool) -> Provenance {
    let source = MeshSource::Document(&settings.name);
    let provenance = Provenance::new(source, fingerprint, "x, y").with_unit(settings.unit);
    match settings.domain.projection {
        Some(plane) if in_plane => provenance.in_plane(&plane),
        plane => provenance.in_coordinates(&Coordinates::Geographic, plane),
    }
}
