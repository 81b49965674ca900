//! From a [`MeshRequest`] to a [`MeshSpec`]: polygons and the data of layers are read here.

use std::io::stdin;
use std::path::Path;

use super::args::BoundaryArgument;
use super::failure::Failure;
use super::output::is_standard_stream;
use super::request::MeshRequest;
use crate::build::MeshSpec;
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, DomainShape, NamedPolygon, RegionError};
use crate::field::Transfer;
use crate::geometry::{Lattice, Rect};
use crate::io::geojson::Outline;
use crate::io::layers::{GridFiles, LayerFiles, LayerSpec};
use crate::io::{self, Meter};
use crate::layers::{Layer, LayerId, LayerKind, PaintLayers, RasterSource, Shapes, SizeFieldSpec};
use crate::mesh::{Cleaning, CoarseError, bisection_edge_length};
use crate::text::LengthUnit;

/// Coarse cells along the longer side of the domain unless `--spacing` says otherwise (N_e of the report's
/// example).
const USUAL_CELLS: f64 = 20.0;

/// The share of a rectangle that a raster covers which covers all of it, but for rounding.
const WHOLE: f64 = 1.0 - 1e-6;

/// What the files of a request say.
pub struct ReadSources {
    /// What to mesh.
    pub spec: MeshSpec,
    /// What is painted on its layers.
    pub paint: PaintLayers,
    /// Names of the boundary.
    pub marks: BoundaryMarks,
    /// The unit of coordinates and lengths, where a file says it.
    pub unit: LengthUnit,
    /// Notes for the user, a sentence each.
    pub notes: Vec<String>,
}

/// Reads the files of a request that names no project. The meter counts the bytes of each file.
///
/// # Errors
/// When a file cannot be read or used, or there is no coarse grid.
pub fn read_sources(request: &MeshRequest, meter: &Meter) -> Result<ReadSources, Failure> {
    let grids = GridFiles::read(visible(request), meter)?;
    let ReadDomain { domain, marks, unit, note } = domain(request, grids.extent(), meter)?;
    let marks = request.marks.as_deref().cloned().unwrap_or(marks);
    let unit = request.unit.unwrap_or(unit);
    let bounds = domain.bounds;
    let spacing = request.spacing.unwrap_or(bounds.size().max_element() / USUAL_CELLS);
    let lattice =
        Lattice::covering(bounds, spacing, request.limits.most_triangles()).map_err(CoarseError::from)?;
    let boundary = boundary(request, spacing, &lattice)?;
    let transfer = transfer(request, bisection_edge_length(lattice.spacing(), 0));
    let (layers, paint) = layers(request, LayerFiles::new(grids, bounds, transfer, meter))?;
    let notes = note.into_iter().chain(notes(request, &layers, bounds)).collect();
    let field = field_spec(request, layers, transfer, &domain, &lattice)?;
    let (rule, limits) = (request.rule, request.limits);
    let is_fitted = boundary != BoundaryTreatment::Report && domain.region().is_some();
    let cleaning = request.cleaning(if is_fitted { Cleaning::FOR_SOLVERS } else { Cleaning::NONE });
    let spec = MeshSpec { domain, boundary, lattice, field, rule, cleaning, limits };
    Ok(ReadSources { spec, paint, marks, unit, notes })
}

/// The layers that ask for something.
fn visible(request: &MeshRequest) -> impl Iterator<Item = &LayerSpec> {
    request.layers.iter().filter(|layer| layer.visible)
}

/// The visible layers with their data, and what is painted on them.
fn layers(request: &MeshRequest, mut files: LayerFiles) -> Result<(Vec<Layer>, PaintLayers), Failure> {
    let mut paint = PaintLayers::default();
    let mut layers = Vec::new();
    for (spec, id) in visible(request).zip((0..).map(LayerId)) {
        layers.push(spec.load(id, &mut files)?);
        files.add_paint(spec, id, &mut paint)?;
    }
    Ok((layers, paint))
}

/// A domain, and what its file says besides.
struct ReadDomain {
    domain: Domain,
    marks: BoundaryMarks,
    unit: LengthUnit,
    /// A sentence for the user.
    note: Option<String>,
}

/// The domain that is asked for, with the names and the unit that its file has; if none is, the `extent` of
/// the rasters, or the unit square.
fn domain(request: &MeshRequest, extent: Option<Rect>, meter: &Meter) -> Result<ReadDomain, Failure> {
    if let Some(path) = &request.region {
        let outline = if is_standard_stream(path) {
            io::geojson::read_outline_from(stdin().lock(), Path::new("standard input"))?
        } else {
            io::geojson::read_outline(path, meter)?
        };
        return domain_of(&outline.polygons, request.domain)
            .map(|(domain, marks)| ReadDomain {
                domain,
                marks,
                unit: outline.unit,
                note: cut(path, &outline),
            })
            .map_err(|error| Failure::Work(format!("{}: {error}", path.display())));
    }
    let bounds = request.domain.or(extent);
    let shape = request.inside.clone().map_or(DomainShape::Whole, DomainShape::Formula);
    let domain = Domain { bounds: bounds.unwrap_or(Rect::UNIT), shape };
    Ok(ReadDomain { domain, marks: BoundaryMarks::default(), unit: LengthUnit::None, note: None })
}

/// The note on polygons that are cut at the antimeridian.
fn cut(path: &Path, outline: &Outline) -> Option<String> {
    outline.is_cut_at_antimeridian().then(|| {
        format!(
            "{} is cut at the antimeridian (longitude 180°): the halves on its sides are separate parts of the mesh, and \
             without --parts all only the largest part stays. Add 360 to the negative longitudes to mesh them as one.",
            path.display()
        )
    })
}

/// The domain that polygons cover, in `bounds` where these are given, and the names that they bring.
fn domain_of(
    polygons: &[NamedPolygon],
    bounds: Option<Rect>,
) -> Result<(Domain, BoundaryMarks), RegionError> {
    let Some(bounds) = bounds else { return BoundaryMarks::domain_of(polygons) };
    let plain = polygons.iter().map(|named| named.polygon.clone()).collect();
    let domain = Domain::of_stored_polygons(plain, bounds)?;
    let marks = BoundaryMarks::of_polygons(polygons, &domain);
    Ok((domain, marks))
}

fn boundary(request: &MeshRequest, spacing: f64, lattice: &Lattice) -> Result<BoundaryTreatment, Failure> {
    let usual = BoundaryTreatment::usual_diameter(spacing);
    let diameter = request.boundary_diameter.unwrap_or(usual);
    let treatment = match request.boundary {
        BoundaryArgument::Report => return Ok(BoundaryTreatment::Report),
        BoundaryArgument::Fitted => BoundaryTreatment::Fitted { diameter },
        BoundaryArgument::Outline => BoundaryTreatment::OnOutline { diameter },
    };
    request.boundary_diameter.map_or(Ok(()), |diameter| check_resolvable(diameter, lattice))?;
    Ok(treatment)
}

/// Refuses a diameter at the outline that the lattice cannot resolve: the refinement would fail wherever the
/// outline passes.
fn check_resolvable(diameter: f64, lattice: &Lattice) -> Result<(), Failure> {
    let level = lattice.deepest_level();
    let smallest = bisection_edge_length(lattice.spacing(), level);
    if diameter >= smallest {
        return Ok(());
    }
    Err(Failure::Work(format!(
        "--boundary-diameter {diameter:e}: below {smallest:.3e} (level {level}) nodes would leave the lattice. Raise it, or mesh a \
         smaller domain."
    )))
}

fn field_spec(
    request: &MeshRequest,
    layers: Vec<Layer>,
    transfer: Transfer,
    domain: &Domain,
    lattice: &Lattice,
) -> Result<SizeFieldSpec, Failure> {
    let unasked = request.h_max.unwrap_or(bisection_edge_length(lattice.spacing(), 0));
    let outline = outline(&layers, domain)?;
    Ok(SizeFieldSpec { layers, transfer, unasked, outline, gradation: request.gradation })
}

/// The boundary of the domain, if a layer asks for the distance to it.
fn outline(layers: &[Layer], domain: &Domain) -> Result<Option<Shapes>, Failure> {
    let Some(layer) = layers.iter().find(|layer| layer.is_of_outline()) else { return Ok(None) };
    let Some(region) = domain.as_region() else {
        let problem = "there is no distance to the outline of a domain that is given by a formula";
        return Err(Failure::Work(format!(
            "The layer “{}”: {problem}. Give the domain by polygons, or the distance to shapes.",
            layer.name
        )));
    };
    Shapes::outline(&region).map(Some).map_err(|error| Failure::Work(error.to_string()))
}

/// The curve from risk to diameter; its ends bound h̄. Where no bounds are given, they do not restrict
/// formulas and lengths.
fn transfer(request: &MeshRequest, coarse_diameter: f64) -> Transfer {
    let h_min = request.h_min.unwrap_or(f64::MIN_POSITIVE);
    let widest = if request.uses_scale() { coarse_diameter.max(h_min) } else { f64::MAX };
    Transfer { h_min, h_max: request.h_max.unwrap_or(widest), shape: request.transfer_shape }
}

/// Notes for the user: layers that ask for nothing, or only in a part of the domain.
fn notes(request: &MeshRequest, layers: &[Layer], domain: Rect) -> Vec<String> {
    let of_raster = |layer: &Layer, source: &RasterSource| {
        let (bounds, file) = (source.raster.raster().bounds(), &source.name);
        let common = bounds.intersection(&domain).map_or(0.0, |common| common.size().element_product());
        if common == 0.0 {
            let Rect { min, max } = bounds;
            let place = format!("{}, {} to {}, {}", min.x, min.y, max.x, max.y);
            return Some(format!("{file} covers {place} and does not meet the domain."));
        }
        let share = common / domain.size().element_product();
        // Without a domain of its own, the mesh covers all rasters.
        let is_partial = share < WHOLE && (request.domain.is_some() || request.region.is_some());
        is_partial.then(|| {
            let percent = (100.0 * share).max(1.0).floor();
            let name = &layer.name;
            format!("{file} covers {percent} % of the domain's rectangle; beyond it the layer “{name}” asks for nothing.")
        })
    };
    let note = |layer: &Layer| match (&layer.kind, &layer.mask) {
        (_, Some(mask)) if mask.bounds().intersection(&domain).is_none() => Some(format!(
            "The mask of the layer “{}” does not meet the domain: it asks for nothing.",
            layer.name
        )),
        (LayerKind::Raster { source, .. } | LayerKind::Band { source, .. }, _) => of_raster(layer, source),
        _ => None,
    };
    layers.iter().filter_map(note).collect()
}
