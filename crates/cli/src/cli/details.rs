//! The data about a mesh in files and in the JSON summary, besides its triangles.

use serde::Serialize;

use super::build::FinishedMesh;
use super::depths::{ChangedDepths, DepthChanges, TimeStepSummary};
use super::failure::Failure;
use super::input::Input;
use super::output_coordinates::OutputCoordinates;
use super::quality::QualitySummary;
use super::quantities::NamedQuantity;
use meshbrush_core::domain::{Domain, HoleFigures, MeshBoundary, PieceFigures};
use meshbrush_core::earth::Coordinates;
use meshbrush_core::layers::{CourantFit, Layer, NodeDepths, StraitCount, Straits};
use meshbrush_core::outline::LineEdges;
use meshbrush_core::surface::{SampleCount, SurfaceFit};
use meshbrush_io::io::{JoinedCells, MeshSource, Provenance};
use meshbrush_mesh::mesh::Extract;
use meshbrush_mesh::text::{Grouped, digits};

/// The boundary in named pieces, the parts, and where the mesh comes from.
pub struct MeshDetails {
    /// The pieces, and the piece of each boundary edge.
    pub boundary: MeshBoundary,
    /// The edges along lines.
    pub lines: Vec<LineEdges>,
    /// For each triangle the number of its part, from the largest.
    pub parts: Vec<u32>,
    /// The cells with pairs of triangles joined, in the coordinates of files, once a file has them.
    pub joined: JoinedCells,
    /// The origin of the mesh. What was changed of the depths of a file is added to it there.
    pub provenance: Provenance,
    /// The depths at the nodes as files get them, if a layer has them and they are wanted.
    pub depths: Option<NodeDepths>,
    /// What these depths were before they were changed for files, where that is asked for.
    unchanged_depths: Option<Vec<f64>>,
    /// The quantity that gives the depth in place of layers, and the depths as files get them.
    given: Option<(NamedQuantity, Vec<f64>)>,
    /// What a person should know about its values.
    pub quantity_notes: Vec<String>,
    /// The Courant numbers of the edges, if a layer keeps them below a number and the depths are wanted.
    pub courant: Option<CourantFit>,
    /// What h̄ of the mesh is multiplied by in files: less than 1 where its triangles were cut.
    pub target_factor: f64,
    /// What was changed of the depths for files, where there are depths.
    pub changed_depths: ChangedDepths,
    /// How they are changed.
    pub depth_changes: DepthChanges,
    /// The largest stable time step, if there are depths, and lengths are no degrees.
    pub largest_time_step: Option<TimeStepSummary>,
    /// How good the triangles are, if it is wanted.
    pub quality: Option<QualitySummary>,
    /// How far the mesh is from the surfaces of its layers, if one is a surface.
    pub surface: Option<SurfaceFit>,
    /// The height of the surface at each node, if a layer is one and files are wanted.
    pub heights: Option<Vec<f64>>,
    /// The triangles across straits, if a layer asks for them and they are wanted.
    pub straits: Option<StraitSummary>,
}

/// What the details are wanted for.
#[derive(Clone, Copy, Debug, Default)]
pub struct DetailUses<'a> {
    /// The summary in JSON.
    pub json: bool,
    /// Files with values at the nodes.
    pub node_data: bool,
    /// The quantity that gives the depth at each node in place of layers, if one does.
    pub given_depth: Option<&'a NamedQuantity>,
    /// How depths are changed for files.
    pub depth_changes: DepthChanges,
}

impl MeshDetails {
    /// Collects the details of an exported mesh that the command `line` requested.
    ///
    /// # Errors
    /// Fails when there are layers of depths, and a node is far from all of them; and when the quantity for
    /// the depth has no value at a node.
    pub fn of(
        finished: &FinishedMesh,
        extract: &Extract,
        line: &str,
        input: &Input,
        coordinates: OutputCoordinates,
        uses: DetailUses<'_>,
    ) -> Result<Self, Failure> {
        Self::with_provenance(finished, extract, provenance(finished, line, input, coordinates), uses)
    }

    /// Collects the details of an exported mesh with this origin.
    ///
    /// # Errors
    /// Fails as [`Self::of`] does.
    pub fn with_provenance(
        finished: &FinishedMesh,
        extract: &Extract,
        provenance: Provenance,
        uses: DetailUses<'_>,
    ) -> Result<Self, Failure> {
        let layers = finished.layers();
        let is_in_formula = uses.given_depth.is_some_and(NamedQuantity::uses_depth);
        let mut depths = match uses.json || uses.node_data || is_in_formula {
            true => NodeDepths::of(layers, extract.view()).transpose()?,
            false => None,
        };
        let of_layers = depths.as_ref().map(|depths| &*depths.depths);
        let mut quantity_notes = Vec::new();
        let mut given = None;
        if let Some(quantity) = uses.given_depth {
            let values = quantity.at_nodes(finished, extract, of_layers, &mut quantity_notes)?.values;
            given = Some((quantity.clone(), values));
        }
        let unchanged_depths = of_layers.filter(|_| !uses.depth_changes.is_empty()).map(<[f64]>::to_vec);
        let change = |values: &mut Vec<f64>| uses.depth_changes.apply(extract, values);
        let of_layers = depths.as_mut().map(|depths| change(&mut depths.depths));
        let of_quantity = given.as_mut().map(|(_, values)| change(values));
        let changed_depths = of_quantity.or(of_layers).unwrap_or_default();
        let courant = depths.as_ref().and_then(|depths| {
            let ground = finished.ground();
            CourantFit::of(layers, extract.view(), &depths.depths, |ends| ground.length(ends))
        });
        let known = given.as_ref().map(|(_, depths)| depths).or(depths.as_ref().map(|of| &of.depths));
        let largest_time_step = known.and_then(|depths| TimeStepSummary::of(finished, extract, depths));
        let quality = uses.json.then(|| QualitySummary::of(finished, extract, depths.as_ref()));
        let straits = uses.json.then(|| StraitSummary::of(layers, extract, finished.domain())).flatten();
        let (boundary, parts) = (finished.boundary(extract), extract.part_numbers());
        let surface = finished.surface_fit(extract);
        let filled = surface.as_ref().filter(|_| uses.node_data);
        let heights = filled.map(|fit| fit.filled_heights(extract.view()));
        let lines = LineEdges::all(finished.derived.line_fits(), &finished.spec().lines, extract);
        Ok(Self {
            boundary,
            lines,
            parts,
            joined: JoinedCells::default(),
            provenance,
            depths,
            unchanged_depths,
            given,
            quantity_notes,
            courant,
            target_factor: 1.0,
            changed_depths,
            depth_changes: uses.depth_changes,
            largest_time_step,
            quality,
            surface,
            heights,
            straits,
        })
    }

    /// Returns the depths of layers at the nodes, before they were changed for files.
    pub fn depths_of_layers(&self) -> Option<&[f64]> {
        let written = self.depths.as_ref().map(|depths| &*depths.depths);
        self.unchanged_depths.as_deref().or(written)
    }

    /// Returns the depths of layers at the nodes as files get them, if no quantity counts in their place.
    pub fn written_depths(&self) -> Option<&[f64]> {
        self.depths.as_ref().filter(|_| self.given.is_none()).map(|depths| &*depths.depths)
    }

    /// Returns the depths that a quantity gives, as files get them, if it is the one that counts for the
    /// mesh.
    pub fn given_depths(&self, quantity: &NamedQuantity) -> Option<&[f64]> {
        self.given.as_ref().filter(|(own, _)| own == quantity).map(|(_, depths)| &**depths)
    }

    /// Returns the number of triangles of each part.
    pub fn part_triangles(&self) -> Vec<usize> {
        let mut counts = Vec::new();
        for &part in &self.parts {
            let part = part as usize;
            counts.resize(counts.len().max(part + 1), 0);
            counts[part] += 1;
        }
        counts
    }
}

/// Returns the origin of a mesh that the command `line` requested.
pub fn provenance(
    finished: &FinishedMesh,
    line: &str,
    input: &Input,
    coordinates: OutputCoordinates,
) -> Provenance {
    let file = input.settings.domain.outline_file().or(input.project.as_deref());
    let file = file.map(|file| file.display().to_string());
    provenance_from(finished, MeshSource::Command(line), file.as_deref(), coordinates)
}

/// Returns the origin of a mesh. `file` has the coordinates of the domain, if one has them.
pub fn provenance_from(
    finished: &FinishedMesh,
    source: MeshSource,
    file: Option<&str>,
    coordinates: OutputCoordinates,
) -> Provenance {
    let meaning = match (finished.domain().projection, file) {
        (Some(plane), _) => format!("x, y in {plane}"),
        (None, Some(file)) => format!("x, y as in {file}"),
        (None, None) => "x, y".to_owned(),
    };
    let provenance = Provenance::new(source, finished.mesh().fingerprint(), &meaning);
    let provenance = provenance.with_unit(finished.unit());
    let coordinates = match coordinates {
        OutputCoordinates::Plane => return provenance,
        OutputCoordinates::Lonlat => Coordinates::Geographic,
        OutputCoordinates::Other(other) => other,
    };
    provenance.in_coordinates(&coordinates, finished.domain().projection)
}

/// How far surfaces that are linear over triangles are from their samples.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct SurfaceSummary {
    /// The largest difference of either sign, in the unit of the surface.
    pub max_error: f64,
    /// The root mean square of the differences.
    pub rms_error: f64,
    /// The root mean square of the differences of the gradient, in the unit of the surface by unit of length
    /// of the plane.
    pub gradient_error: f64,
    /// The place of the largest difference: x and y.
    pub worst: [f64; 2],
    /// Samples in the domain at which no surface has a value.
    pub missing_samples: usize,
    /// Their share of all samples in the domain, 0 to 1.
    pub missing_share: f64,
}

impl SurfaceSummary {
    /// Returns the figures of a mesh by how it fits, and by the count of the samples.
    pub fn new(fit: &SurfaceFit, count: SampleCount) -> Self {
        let SurfaceFit { heights: _, largest, at, rms, gradient, samples: _ } = fit;
        Self {
            max_error: *largest,
            rms_error: *rms,
            gradient_error: *gradient,
            worst: (*at).into(),
            missing_samples: count.missing,
            missing_share: count.missing_share(),
        }
    }
}

/// The triangles across straits.
#[derive(Clone, Debug, Serialize)]
pub struct StraitSummary {
    /// Triangles that are asked for across each strait.
    pub across: f64,
    /// The places of straits at which triangles were counted, from one coast to the other.
    pub crossings: usize,
    /// The number of places with fewer triangles.
    pub below: usize,
    /// The narrowest passage between two shores, with wider water on both sides.
    pub narrowest: Option<NarrowStrait>,
    /// Up to a thousand of these places, the narrowest first.
    pub places: Vec<NarrowStrait>,
}

/// A place of a strait.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct NarrowStrait {
    /// The middle of the strait.
    pub at: [f64; 2],
    /// The points of both coasts that are nearest to the middle.
    pub shores: [[f64; 2]; 2],
    /// Its width in world units, with a projection in metres on the ellipsoid.
    pub width: f64,
    /// Triangles across it.
    pub triangles: usize,
}

/// Places of straits that are listed, at most.
const MOST_STRAITS: usize = 1000;

impl StraitSummary {
    /// Counts triangles for the uppermost visible layer that asks for them.
    pub fn of(layers: &[Layer], extract: &Extract, domain: &Domain) -> Option<Self> {
        let mut visible = layers.iter().rev().filter(|layer| layer.visible);
        let straits: &Straits = visible.find_map(|layer| layer.kind.get())?;
        let narrowest = straits.found.narrowest(domain);
        let counts = StraitCount::of(straits, narrowest.as_ref(), extract.view());
        let is_below = |count: &&StraitCount| (count.triangles as f64) < straits.across;
        let place = |count: &StraitCount| NarrowStrait {
            at: count.disc.center.into(),
            shores: count.disc.shores.map(Into::into),
            width: domain.on_earth(count.disc.width, count.disc.center),
            triangles: count.triangles,
        };
        let (of_narrowest, of_discs) = counts.split_at(usize::from(narrowest.is_some()));
        Some(Self {
            across: straits.across,
            crossings: of_discs.len(),
            below: of_discs.iter().filter(is_below).count(),
            narrowest: of_narrowest.first().map(place),
            places: of_discs.iter().filter(is_below).take(MOST_STRAITS).map(place).collect(),
        })
    }

    /// Returns a sentence about the places with fewer triangles than asked for, if there are any. `h_min` is
    /// the smallest target diameter.
    pub fn sentence(&self, h_min: f64) -> Option<String> {
        if self.below == 0 {
            return None;
        }
        let Self { across, crossings, below, narrowest, .. } = self;
        let counted = format!(
            "{} of {} places in straits have fewer than {across} triangles across",
            Grouped(*below),
            Grouped(*crossings)
        );
        let narrowest =
            narrowest.map_or_else(String::new, |NarrowStrait { at: [x, y], width, triangles, .. }| {
                let width = digits(width, 4);
                format!(" The narrowest strait is {width} wide, at x = {x}, y = {y}, and has {triangles} across it.")
            });
        // One more is asked for, since a mesh can end short of the coast.
        let is_held = self.places.first().is_some_and(|place| place.width < (across + 1.0) * h_min);
        let reason = match is_held {
            true => format!(
                ": the smallest target diameter, {h_min}, is kept where they would have to be smaller.{narrowest} A smaller \
                 --h-min makes room for them."
            ),
            false => format!(
                ", as the outline leaves them no room.{narrowest} A smaller --boundary-diameter helps."
            ),
        };
        Some(counted + &reason)
    }
}

/// A piece of the boundary of which the mesh has edges.
#[derive(Clone, Debug, Serialize)]
pub struct PieceSummary {
    /// The number of the piece among all pieces of the domain's boundary. Markers in files are one higher.
    pub id: usize,
    /// The name of the piece. No other piece has it.
    pub name: String,
    /// "open", "mainland" or "island".
    pub kind: &'static str,
    /// What it is for a solver, as "open" or "natural land".
    #[serde(rename = "type")]
    pub boundary_type: &'static str,
    /// Edges of the mesh.
    pub edges: usize,
    /// Their length in world units, with a projection in metres on the ellipsoid.
    pub length: f64,
}

impl PieceSummary {
    /// Returns the pieces that have edges in the mesh, by number.
    pub fn of_present(boundary: &MeshBoundary) -> Vec<Self> {
        let summary = |id: usize| {
            let (piece, figures) = (&boundary.pieces().list()[id], boundary.figures()[id]);
            let PieceFigures { edges, length } = figures;
            let (name, kind) = (piece.name.clone(), piece.kind.name());
            Self { id, name, kind, boundary_type: piece.boundary_type().word(), edges, length }
        };
        boundary.present().map(summary).collect()
    }
}

/// A piece of the domain's boundary of which the mesh has no edge.
#[derive(Clone, Debug, Serialize)]
pub struct LostPiece {
    /// Its number among all pieces.
    pub id: usize,
    /// Its name.
    pub name: String,
    /// "open", "mainland" or "island".
    pub kind: &'static str,
    /// The point halfway along it.
    pub place: [f64; 2],
}

impl LostPiece {
    /// Returns the parts of a mesh, by number.
    pub fn all(boundary: &MeshBoundary) -> Vec<Self> {
        let lost = |id: usize| {
            let piece = &boundary.pieces().list()[id];
            let (name, kind) = (piece.name.clone(), piece.kind.name());
            Self { id, name, kind, place: piece.middle().into() }
        };
        boundary.lost().map(lost).collect()
    }
}

/// A hole of the polygons that lies wholly under triangles.
#[derive(Clone, Debug, Serialize)]
pub struct LostIsland {
    /// One of its corners.
    pub place: [f64; 2],
    /// Its area in square world units.
    pub area: f64,
    /// Its name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

impl LostIsland {
    /// Returns the island with its name, where the pieces of the boundary are known.
    pub fn new(island: HoleFigures, boundary: Option<&MeshBoundary>) -> Self {
        let HoleFigures { place, area } = island;
        let pieces = boundary.map(MeshBoundary::pieces);
        let name = pieces.and_then(|pieces| {
            let (piece, _) = pieces.nearest(place, pieces.tolerance())?;
            Some(pieces.list()[piece].name.clone())
        });
        Self { place: place.into(), area, name }
    }
}

/// A hole of the mesh that the polygons do not have.
#[derive(Clone, Debug, Serialize)]
pub struct NewHole {
    /// A point in it.
    pub place: [f64; 2],
    /// Its area in square world units.
    pub area: f64,
}

impl From<HoleFigures> for NewHole {
    fn from(HoleFigures { place, area }: HoleFigures) -> Self {
        Self { place: place.into(), area }
    }
}
