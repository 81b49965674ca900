//! From a [`MeshRequest`] to a [`MeshSpec`]: polygons and rasters are read here.

use std::io::stdin;
use std::path::Path;
use std::sync::Arc;

use super::args::BoundaryArgument;
use super::failure::Failure;
use super::output::is_standard_stream;
use super::request::MeshRequest;
use crate::build::MeshSpec;
use crate::domain::{BoundaryMarks, BoundaryTreatment, Domain, DomainShape, NamedPolygon, RegionError};
use crate::field::{Transfer, f32_not_below};
use crate::geometry::{Lattice, Rect};
use crate::io::layers::{KindSpec, LayerSpec, RasterFile, RasterFormat, RasterReading as ReadAs};
use crate::io::{self, Meter};
use crate::layers::{Combine, Layer, LayerId, LayerKind, RasterReading, RasterSource, SizeFieldSpec};
use crate::mesh::{Cleaning, CoarseError, InvalidTarget, bisection_edge_length};
use crate::raster::{Raster, RasterPyramid};
use crate::text::LengthUnit;

/// Coarse cells along the longer side of the domain unless `--spacing` says otherwise (N_e of the report's
/// example).
const USUAL_CELLS: f64 = 20.0;

/// What the files of a request say.
pub struct ReadSources {
    /// What to mesh.
    pub spec: MeshSpec,
    /// Names of the boundary.
    pub marks: BoundaryMarks,
    /// The unit of coordinates and lengths, where a file says it.
    pub unit: LengthUnit,
    /// Notes for the user, a sentence each.
    pub notes: Vec<String>,
}

/// Reads the files of a request that names no project.
///
/// # Errors
/// When a file cannot be read or used, or there is no coarse grid.
pub fn read_sources(request: &MeshRequest) -> Result<ReadSources, Failure> {
    check_supported(request)?;
    let placed = read_placed(request)?;
    let (domain, marks, unit) = domain(request, &placed)?;
    let marks = request.marks.as_deref().cloned().unwrap_or(marks);
    let unit = request.unit.unwrap_or(unit);
    let bounds = domain.bounds;
    let rasters = read_images(request, placed, bounds)?;
    let spacing = request.spacing.unwrap_or(bounds.size().max_element() / USUAL_CELLS);
    let lattice =
        Lattice::covering(bounds, spacing, request.limits.most_triangles()).map_err(CoarseError::from)?;
    let boundary = boundary(request, spacing, &lattice)?;
    let notes = notes(request, &rasters, bounds);
    let field = field_spec(request, rasters, &lattice)?;
    let (rule, limits) = (request.rule, request.limits);
    let is_fitted = boundary != BoundaryTreatment::Report && domain.region().is_some();
    let cleaning = request.cleaning(if is_fitted { Cleaning::FOR_SOLVERS } else { Cleaning::NONE });
    let spec = MeshSpec { domain, boundary, lattice, field, rule, cleaning, limits };
    Ok(ReadSources { spec, marks, unit, notes })
}

/// Refuses what the field cannot express.
fn check_supported(request: &MeshRequest) -> Result<(), Failure> {
    let refused =
        |what: &str| Err(Failure::Work(format!("{what} cannot be meshed by this version of Meshbrush.")));
    if request.gradation.is_some() {
        return refused("A field with a bound on its gradation");
    }
    for layer in visible(request) {
        let of_kind =
            matches!(layer.kind, KindSpec::Paint { .. } | KindSpec::Threats(_) | KindSpec::Distance { .. });
        if of_kind || layer.mask.is_some() || layer.combine != Combine::Finest {
            return refused(&format!("The layer \"{}\"", layer.name));
        }
    }
    Ok(())
}

/// The layers that ask for something.
fn visible(request: &MeshRequest) -> impl Iterator<Item = &LayerSpec> {
    request.layers.iter().filter(|layer| layer.visible)
}

/// The pixels of a layer, if it has some.
fn raster_file(layer: &LayerSpec) -> Option<&RasterFile> {
    match &layer.kind {
        KindSpec::Raster { raster, .. } | KindSpec::Band { raster, .. } => Some(raster),
        _ => None,
    }
}

/// The rasters that say which rectangle they cover, in the order of the visible layers; `None` for others.
fn read_placed(request: &MeshRequest) -> Result<Vec<Option<Raster>>, Failure> {
    let read = |layer: &LayerSpec| match raster_file(layer) {
        Some(RasterFile { path, format: RasterFormat::Asc, .. }) => Ok(Some(io::asc::read(path)?)),
        _ => Ok(None),
    };
    visible(request).map(read).collect()
}

/// As [`read_placed`], with the images too, which cover the bounds of the domain unless they have their own.
fn read_images(
    request: &MeshRequest,
    placed: Vec<Option<Raster>>,
    domain: Rect,
) -> Result<Vec<Option<Raster>>, Failure> {
    let read = |(layer, placed): (&LayerSpec, Option<Raster>)| match raster_file(layer) {
        Some(RasterFile { path, format: RasterFormat::Png, bounds }) => {
            let behind = if layer.is_risk() { io::png::Behind::Black } else { io::png::Behind::White };
            Ok(Some(io::png::read(path, bounds.unwrap_or(domain), behind)?))
        }
        _ => Ok(placed),
    };
    visible(request).zip(placed).map(read).collect()
}

/// The domain that is asked for, with the names and the unit that its file has; if none is, the rectangle
/// that the rasters cover, or the unit square.
fn domain(
    request: &MeshRequest,
    placed: &[Option<Raster>],
) -> Result<(Domain, BoundaryMarks, LengthUnit), Failure> {
    if let Some(path) = &request.region {
        let outline = if is_standard_stream(path) {
            io::geojson::read_outline_from(stdin().lock(), Path::new("standard input"))?
        } else {
            io::geojson::read_outline(path, &Meter::default())?
        };
        return domain_of(&outline.polygons, request.domain)
            .map(|(domain, marks)| (domain, marks, outline.unit))
            .map_err(|error| Failure::Work(format!("{}: {error}", path.display())));
    }
    let bounds =
        request.domain.or_else(|| placed.iter().flatten().map(Raster::bounds).reduce(|a, b| a.union(&b)));
    let shape = request.inside.clone().map_or(DomainShape::Whole, DomainShape::Formula);
    let domain = Domain { bounds: bounds.unwrap_or(Rect::UNIT), shape };
    Ok((domain, BoundaryMarks::default(), LengthUnit::None))
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
    rasters: Vec<Option<Raster>>,
    lattice: &Lattice,
) -> Result<SizeFieldSpec, Failure> {
    let coarse_diameter = bisection_edge_length(lattice.spacing(), 0);
    let transfer = transfer(request, coarse_diameter);
    let layers = visible(request).zip(rasters).zip(0..).map(|((spec, raster), id)| {
        let kind = kind(spec, raster, &transfer)?;
        Ok(Layer { combine: spec.combine, ..Layer::new(LayerId(id), spec.name.clone(), kind) })
    });
    let layers = layers.collect::<Result<_, Failure>>()?;
    let unasked = request.h_max.unwrap_or(coarse_diameter);
    Ok(SizeFieldSpec { layers, transfer, unasked, outline: None, gradation: None })
}

/// The curve from risk to diameter; its ends bound h̄. Where no bounds are given, they do not restrict
/// formulas and lengths.
fn transfer(request: &MeshRequest, coarse_diameter: f64) -> Transfer {
    let h_min = request.h_min.unwrap_or(f64::MIN_POSITIVE);
    let widest = if request.uses_scale() { coarse_diameter.max(h_min) } else { f64::MAX };
    Transfer { h_min, h_max: request.h_max.unwrap_or(widest), shape: request.transfer_shape }
}

/// What a layer asks for.
fn kind(layer: &LayerSpec, raster: Option<Raster>, transfer: &Transfer) -> Result<LayerKind, Failure> {
    let of_raster = |file: &RasterFile, raster, reading| {
        let raster = Arc::new(RasterPyramid::new(raster));
        LayerKind::Raster { source: RasterSource { name: file.path.display().to_string(), raster }, reading }
    };
    Ok(match (&layer.kind, raster) {
        (KindSpec::Formula { quantity, formula }, _) => {
            LayerKind::Formula { quantity: *quantity, formula: formula.clone() }
        }
        (KindSpec::Raster { raster: file, reading: ReadAs::Risk }, Some(raster)) => {
            of_raster(file, risks(&file.path, raster)?, RasterReading::Risk)
        }
        (KindSpec::Raster { raster: file, reading: ReadAs::Diameter }, Some(raster)) => {
            of_raster(file, diameters(file.format, raster, transfer)?, RasterReading::Diameter)
        }
        (KindSpec::Raster { raster: file, reading: ReadAs::Curve(knots) }, Some(raster)) => {
            let asked = |value: f32| f32_not_below(on_curve(knots, f64::from(value)));
            of_raster(file, mapped(raster, asked), RasterReading::Diameter)
        }
        (KindSpec::Band { raster: file, between: [least, greatest], diameter }, Some(raster)) => {
            let band = *least..=*greatest;
            let asked = |value: f32| if band.contains(&f64::from(value)) { *diameter } else { f64::INFINITY };
            of_raster(file, mapped(raster, |value| f32_not_below(asked(value))), RasterReading::Diameter)
        }
        _ => unreachable!("`check_supported` lets other layers through to nobody, and every raster was read"),
    })
}

/// The diameter for a value of a raster, linear between the knots; NaN asks for nothing.
fn on_curve(knots: &[[f64; 2]], value: f64) -> f64 {
    if value.is_nan() {
        return f64::INFINITY;
    }
    match knots.partition_point(|knot| knot[0] <= value) {
        0 => knots[0][1],
        last if last == knots.len() => knots[last - 1][1],
        next => {
            let ([from, h0], [to, h1]) = (knots[next - 1], knots[next]);
            h0 + (h1 - h0) * ((value - from) / (to - from))
        }
    }
}

/// Lengths in world units. An image's grey is mapped linearly from `h_min` (black) to `h_max` (white); pixels
/// without a value ask for nothing.
fn diameters(format: RasterFormat, raster: Raster, transfer: &Transfer) -> Result<Raster, Failure> {
    let Transfer { h_min, h_max, .. } = *transfer;
    let length = |value: f32| match format {
        _ if value.is_nan() => f32::INFINITY,
        RasterFormat::Png => f32_not_below(h_min + f64::from(value) * (h_max - h_min)),
        RasterFormat::Asc => value,
    };
    let raster = mapped(raster, length);
    if let Some((x, y)) = raster.all().pixels().find(|&(x, y)| raster.get(x, y) <= 0.0) {
        let (value, at) = (f64::from(raster.get(x, y)), raster.pixel_center(x, y));
        return Err(InvalidTarget { at, value }.into());
    }
    Ok(raster)
}

/// Risks from 0 to 1; pixels without a value ask for nothing.
fn risks(path: &Path, raster: Raster) -> Result<Raster, Failure> {
    let is_risk = |value: f32| value.is_nan() || (0.0..=1.0).contains(&value);
    if let Some((x, y)) = raster.all().pixels().find(|&(x, y)| !is_risk(raster.get(x, y))) {
        let (value, at) = (raster.get(x, y), raster.pixel_center(x, y));
        let problem = format!("{}: the risk is {value} at x = {}, y = {}", path.display(), at.x, at.y);
        return Err(Failure::Work(format!("{problem}; it must lie from 0 to 1. Scale the values first.")));
    }
    Ok(raster)
}

fn mapped(raster: Raster, value: impl Fn(f32) -> f32) -> Raster {
    let values = raster.values().iter().map(|&v| value(v)).collect();
    Raster::from_values(raster.bounds(), raster.size(), values)
}

/// Notes for the user: rasters that do not meet the domain.
fn notes(request: &MeshRequest, rasters: &[Option<Raster>], domain: Rect) -> Vec<String> {
    let beyond = |(layer, raster): (&LayerSpec, &Option<Raster>)| match (raster_file(layer), raster) {
        (Some(file), Some(raster)) if raster.bounds().intersection(&domain).is_none() => {
            let (path, Rect { min, max }) = (file.path.display(), raster.bounds());
            Some(format!(
                "{path} covers {}, {} to {}, {} and does not meet the domain.",
                min.x, min.y, max.x, max.y
            ))
        }
        _ => None,
    };
    visible(request).zip(rasters).filter_map(beyond).collect()
}
