//! From a [`Job`](super::job::Job) to a coarse mesh and the sources of its target diameter: rasters are read here.

use std::sync::Arc;

use super::failure::Failure;
use super::job::{Job, Meaning, RasterFormat, RasterSpec, SourceSpec};
use crate::domain::{BoundaryTreatment, Domain, DomainOnLattice, DomainShape, Region};
use crate::field::{Source, Transfer, f32_not_below};
use crate::geometry::{Lattice, Rect};
use crate::io;
use crate::mesh::{CoarseError, Mesh, bisection_edge_length};
use crate::raster::{MAX_SIDE, Raster};

/// Pixels along the longer side of the domain when nobody says how many.
const USUAL_RESOLUTION: u32 = 1024;
/// Coarse cells along the longer side of the domain when nobody says how wide (N_e of the report's example).
const USUAL_CELLS: f64 = 20.0;

/// All that refinement starts from.
pub struct Start {
    /// The domain on the lattice of the mesh.
    pub domain: DomainOnLattice,
    /// Its polygons, if it has some.
    pub region: Option<Arc<Region>>,
    /// The coarse triangulation of the domain.
    pub mesh: Mesh,
    /// What asks for small triangles.
    pub sources: Vec<Source>,
    /// From risk to diameter; its ends bound the target diameter.
    pub transfer: Transfer,
    /// h̄ where no source asks for anything, in world units.
    pub unasked: f64,
    /// Columns and rows for the area rule.
    pub size: [u32; 2],
    /// What a person should know, sentence by sentence.
    pub warnings: Vec<String>,
}

impl Start {
    /// Reads the rasters, settles the domain, lays the coarse grid.
    ///
    /// # Errors
    /// When a raster cannot be read or used, or no coarse grid can be laid.
    pub fn new(job: &Job) -> Result<Self, Failure> {
        let placed = read_placed(job)?;
        let shape = domain(job, &placed)?;
        let (bounds, region) = (shape.bounds, shape.region().cloned());
        let rasters = read_images(job, placed, bounds)?;
        let (domain, mesh) = coarse_mesh(job, &shape)?;
        let transfer = transfer(job, &mesh);
        let warnings = warnings(job, &rasters, bounds);
        let size = field_size(job, &rasters, bounds);
        let sources = job.sources.iter().zip(rasters).map(|(spec, raster)| source(spec, raster, &transfer));
        let sources = sources.collect::<Result<_, _>>()?;
        let unasked = job.h_max.unwrap_or(mesh.diameter(0));
        Ok(Self { domain, region, mesh, sources, transfer, unasked, size, warnings })
    }
}

/// The grids with their own placement, each at the place of its source.
fn read_placed(job: &Job) -> Result<Vec<Option<Raster>>, Failure> {
    let read = |spec: &SourceSpec| match spec {
        SourceSpec::Raster(RasterSpec { path, format: RasterFormat::Asc, .. }) => {
            Ok(Some(io::asc::read(path)?))
        }
        _ => Ok(None),
    };
    job.sources.iter().map(read).collect()
}

/// The images too, now that the domain they cover is known.
fn read_images(job: &Job, placed: Vec<Option<Raster>>, domain: Rect) -> Result<Vec<Option<Raster>>, Failure> {
    let read = |(spec, placed): (&SourceSpec, Option<Raster>)| match spec {
        SourceSpec::Raster(RasterSpec { path, format: RasterFormat::Png, meaning }) => {
            let behind = match meaning {
                Meaning::Risk => io::png::Behind::Black,
                Meaning::Target => io::png::Behind::White,
            };
            Ok(Some(io::png::read(path, domain, behind)?))
        }
        _ => Ok(placed),
    };
    job.sources.iter().zip(placed).map(read).collect()
}

/// The domain that is asked for; where none is, wherever the rasters lie, or the unit square.
fn domain(job: &Job, placed: &[Option<Raster>]) -> Result<Domain, Failure> {
    if let Some(path) = &job.region {
        let polygons = io::geojson::read(path)?;
        return Domain::of_polygons(&polygons)
            .map_err(|error| Failure::Work(format!("{}: {error}", path.display())));
    }
    let bounds =
        job.domain.or_else(|| placed.iter().flatten().map(Raster::bounds).reduce(|a, b| a.union(&b)));
    let shape = job.inside.clone().map_or(DomainShape::Whole, DomainShape::Formula);
    Ok(Domain { bounds: bounds.unwrap_or(Rect::UNIT), shape })
}

fn coarse_mesh(job: &Job, domain: &Domain) -> Result<(DomainOnLattice, Mesh), Failure> {
    let bounds = domain.bounds;
    let spacing = job.spacing.unwrap_or(bounds.size().max_element() / USUAL_CELLS);
    let lattice =
        Lattice::covering(bounds, spacing, job.limits.most_triangles()).map_err(CoarseError::from)?;
    let boundary = match (job.fitted, job.boundary_diameter) {
        (false, _) => BoundaryTreatment::Report,
        (true, None) => BoundaryTreatment::usual(spacing),
        (true, Some(diameter)) => BoundaryTreatment::Fitted { diameter: resolvable(diameter, &lattice)? },
    };
    let domain = DomainOnLattice::new(domain, boundary, &lattice);
    let mesh = Mesh::coarse_grid(&lattice, |node| domain.admits(node), &job.limits)?;
    Ok((domain, mesh))
}

/// A diameter at the outline that the lattice can resolve. Every outline would ask for it, so there is no need to try.
fn resolvable(diameter: f64, lattice: &Lattice) -> Result<f64, Failure> {
    let level = lattice.deepest_level();
    let smallest = bisection_edge_length(lattice.spacing(), level);
    if diameter >= smallest {
        return Ok(diameter);
    }
    Err(Failure::Work(format!(
        "--boundary-diameter {diameter:e}: below {smallest:.3e} (level {level}) nodes would leave the lattice. Raise it, or mesh a \
         smaller domain."
    )))
}

/// With no bounds given, formulas and lengths are taken as they are: the ends are then out of reach.
fn transfer(job: &Job, mesh: &Mesh) -> Transfer {
    let h_min = job.h_min.unwrap_or(f64::MIN_POSITIVE);
    let widest = if job.uses_scale() { mesh.diameter(0).max(h_min) } else { f64::MAX };
    Transfer { h_min, h_max: job.h_max.unwrap_or(widest), shape: job.transfer_shape }
}

fn source(spec: &SourceSpec, raster: Option<Raster>, transfer: &Transfer) -> Result<Source, Failure> {
    Ok(match (spec, raster) {
        (SourceSpec::Target(formula), _) => Source::TargetFormula(formula.clone()),
        (SourceSpec::Risk(formula), _) => Source::RiskFormula(formula.clone()),
        (SourceSpec::Raster(spec), Some(raster)) => match spec.meaning {
            Meaning::Target => Source::TargetRaster(Arc::new(diameters(spec, raster, transfer))),
            Meaning::Risk => Source::RiskRaster(Arc::new(risks(spec, raster)?)),
        },
        (SourceSpec::Raster(_), None) => unreachable!("every raster was read as placed or as an image"),
    })
}

/// Lengths: from an image by its grey, even from `h_min` to `h_max`; pixels without a value ask for nothing.
fn diameters(spec: &RasterSpec, raster: Raster, transfer: &Transfer) -> Raster {
    let Transfer { h_min, h_max, .. } = *transfer;
    let length = |value: f32| match spec.format {
        _ if value.is_nan() => f32::INFINITY,
        RasterFormat::Png => f32_not_below(h_min + f64::from(value) * (h_max - h_min)),
        RasterFormat::Asc => value,
    };
    mapped(raster, length)
}

/// Risks from 0 to 1; pixels without a value have none.
fn risks(spec: &RasterSpec, raster: Raster) -> Result<Raster, Failure> {
    let raster = mapped(raster, |value| if value.is_nan() { 0.0 } else { value });
    if let Some((x, y)) = raster.all().pixels().find(|&(x, y)| !(0.0..=1.0).contains(&raster.get(x, y))) {
        let (value, at) = (raster.get(x, y), raster.pixel_center(x, y));
        let problem = format!("{}: the risk is {value} at x = {}, y = {}", spec.path.display(), at.x, at.y);
        return Err(Failure::Work(format!("{problem}; it must lie from 0 to 1. Scale the values first.")));
    }
    Ok(raster)
}

fn mapped(raster: Raster, value: impl Fn(f32) -> f32) -> Raster {
    let values = raster.values().iter().map(|&v| value(v)).collect();
    Raster::from_values(raster.bounds(), raster.size(), values)
}

/// Columns and rows that the area rule sees: enough for every raster pixel to hold the middle of one of them.
fn field_size(job: &Job, rasters: &[Option<Raster>], domain: Rect) -> [u32; 2] {
    let own: Vec<[u32; 2]> =
        rasters.iter().flatten().filter(|r| r.bounds() == domain).map(Raster::size).collect();
    let alike = own.len() == rasters.len() && own.windows(2).all(|pair| pair[0] == pair[1]);
    if let (None, true, Some(&size)) = (job.resolution, alike, own.first()) {
        return size;
    }
    let extent = domain.size();
    let finest = rasters.iter().flatten().map(|r| r.pixel_size().min_element()).fold(f64::INFINITY, f64::min);
    let needed = (extent.max_element() / finest).ceil().min(f64::from(MAX_SIDE)) as u32;
    let longer = job.resolution.unwrap_or(USUAL_RESOLUTION.max(needed));
    // Rounded up, so that no side of a pixel is longer than asked for; not by the last bits of the division.
    let side =
        |length: f64| (f64::from(longer) * length / extent.max_element() - 1e-9).ceil().max(1.0) as u32;
    [side(extent.x), side(extent.y)]
}

fn warnings(job: &Job, rasters: &[Option<Raster>], domain: Rect) -> Vec<String> {
    let beyond = |(spec, raster): (&SourceSpec, &Option<Raster>)| match (spec, raster) {
        (SourceSpec::Raster(spec), Some(raster)) if raster.bounds().intersection(&domain).is_none() => {
            let (path, Rect { min, max }) = (spec.path.display(), raster.bounds());
            Some(format!(
                "{path} covers {}, {} to {}, {} and does not meet the domain.",
                min.x, min.y, max.x, max.y
            ))
        }
        _ => None,
    };
    job.sources.iter().zip(rasters).filter_map(beyond).collect()
}
