//! Refines a coarse mesh until the job's rule holds everywhere.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec2;

use super::failure::Failure;
use super::job::Job;
use super::sources::Start;
use super::terminal::Terminal;
use crate::domain::{DomainOnLattice, Region};
use crate::field::{
    PaintRef, RefinementRule, Source, TargetField, TargetFieldSpec, Transfer, VertexRule, smallest_target,
};
use crate::io;
use crate::mesh::{
    CoarseError, Element, Extract, InvalidTarget, Limits, Mesh, Progress, Refiner, TriangleId,
};
use crate::paint::PaintRasters;
use crate::text::Grouped;

/// Triangles asked about, or pixels evaluated, between two looks at the clock.
const SLICE: usize = 1 << 18;

/// A finished mesh, and the h̄ that it obeys.
pub struct Built {
    /// The mesh.
    pub mesh: Mesh,
    /// The domain as it was asked for.
    pub domain: DomainOnLattice,
    /// Its polygons, if it has some.
    pub region: Option<Arc<Region>>,
    /// Which points of a triangle count.
    pub rule: RefinementRule,
    /// Its target diameter.
    pub target: Target,
    /// Time spent on refinement alone.
    pub refinement: Duration,
    /// Triangles that the level cap left coarser than their target.
    pub capped: usize,
}

/// h̄ as the rule sees it.
pub enum Target {
    /// Exactly what the sources ask for, at nodes.
    ByVertex(PointTarget),
    /// The sources by pixel.
    ByArea {
        /// The pixels.
        field: Box<TargetField>,
        /// h̄ where no source asks for anything, in world units.
        unasked: f64,
    },
    /// What a document asks for, at nodes.
    OfDocument {
        /// Its sources.
        field: Box<TargetField>,
        /// Its paint.
        layers: Box<PaintRasters>,
    },
}

/// h̄ point by point.
pub struct PointTarget {
    sources: Vec<Source>,
    transfer: Transfer,
    unasked: f64,
}

impl PointTarget {
    /// h̄ at a point, all in world units. Where it is impossible, the impossible value.
    pub fn at(&self, point: DVec2) -> f64 {
        match smallest_target(&self.sources, point, &self.transfer) {
            Ok(f64::INFINITY) => self.unasked,
            Ok(asked) => asked.clamp(self.transfer.h_min, self.transfer.h_max),
            Err(InvalidTarget { value, .. }) => value,
        }
    }
}

impl Target {
    /// h̄ at a point of the domain, in world units.
    pub fn at(&self, point: DVec2) -> f64 {
        match self {
            Self::ByVertex(target) => target.at(point),
            Self::ByArea { field, unasked } => {
                field.at(point).filter(|asked| asked.is_finite()).unwrap_or(*unasked)
            }
            Self::OfDocument { field, layers } => field.target_at_node(layers.as_paint(), point),
        }
    }

    /// h̄ at every node.
    pub fn at_nodes(&self, mesh: &Extract) -> Vec<f64> {
        mesh.world_nodes().map(|p| self.at(p)).collect()
    }

    /// Columns and rows of the pixels, if the rule goes by pixels.
    pub fn resolution(&self) -> Option<[u32; 2]> {
        match self {
            Self::ByVertex(_) | Self::OfDocument { .. } => None,
            Self::ByArea { field, .. } => Some(field.spec().size),
        }
    }

    /// The triangles whose diameter exceeds their target.
    ///
    /// # Errors
    /// When a target is impossible.
    pub fn unsatisfied(
        &self,
        mesh: &Mesh,
        domain: &DomainOnLattice,
    ) -> Result<Vec<TriangleId>, InvalidTarget> {
        match self {
            Self::ByVertex(_) | Self::OfDocument { .. } => {
                let mut rule = VertexRule::new(|p| self.at(p));
                mesh.unsatisfied(|element| domain.exceeds(element, |element| rule.exceeds(element)))
            }
            Self::ByArea { field, .. } => {
                mesh.unsatisfied(|element| domain.exceeds(element, |element| Ok(field.exceeds(element))))
            }
        }
    }
}

/// Reads, lays the coarse grid and refines.
///
/// # Errors
/// When a file is of no use, the target is impossible somewhere, or a limit is reached.
pub fn build(job: &Job, terminal: &mut Terminal) -> Result<Built, Failure> {
    if let Some(path) = &job.project {
        return build_project(path, job, terminal);
    }
    let start = Start::new(job)?;
    for warning in &start.warnings {
        terminal.say(&format!("meshbrush: note: {warning}"));
    }
    let Start { mut mesh, domain, region, sources, transfer, unasked, size, .. } = start;
    let (target, refined) = match job.rule {
        RefinementRule::Vertex => {
            let target = PointTarget { sources, transfer, unasked };
            let mut rule = VertexRule::new(|p| target.at(p));
            let exceeds = |element: &Element| domain.exceeds(element, |element| rule.exceeds(element));
            let refined = refine(&mut mesh, &job.limits, exceeds, terminal);
            (Target::ByVertex(target), refined)
        }
        RefinementRule::Area => {
            let field = fill(TargetFieldSpec { sources, transfer, size }, None, &mesh, terminal)?;
            let exceeds = |element: &Element| domain.exceeds(element, |element| Ok(field.exceeds(element)));
            let refined = refine(&mut mesh, &job.limits, exceeds, terminal);
            (Target::ByArea { field: Box::new(field), unasked }, refined)
        }
    };
    let (refinement, capped) = refined?;
    Built { mesh, domain, region, rule: job.rule, target, refinement, capped }.sorted_out(terminal)
}

/// Does with a saved document what the window does with an open one.
fn build_project(path: &Path, job: &Job, terminal: &mut Terminal) -> Result<Built, Failure> {
    let document = io::project::read(path)?;
    let settings = document.settings();
    let max_triangles = job.asked_budget.unwrap_or(settings.max_triangles);
    let limits = Limits { max_triangles, ..job.limits };
    let domain = settings.domain_on_lattice().map_err(CoarseError::from)?;
    let admits = |node| domain.admits(node);
    let mut mesh = Mesh::coarse_grid(domain.lattice(), admits, &limits)?;
    let paint = document.paint().as_paint();
    let field = fill(settings.field_spec(), Some(paint), &mesh, terminal)?;
    let (target, refined) = match settings.rule {
        RefinementRule::Vertex => {
            let mut rule = VertexRule::new(|p| field.target_at_node(paint, p));
            let exceeds = |element: &Element| domain.exceeds(element, |element| rule.exceeds(element));
            let refined = refine(&mut mesh, &limits, exceeds, terminal);
            let layers = Box::new(document.paint().clone());
            (Target::OfDocument { field: Box::new(field), layers }, refined)
        }
        RefinementRule::Area => {
            let exceeds = |element: &Element| domain.exceeds(element, |element| Ok(field.exceeds(element)));
            let refined = refine(&mut mesh, &limits, exceeds, terminal);
            (Target::ByArea { field: Box::new(field), unasked: settings.transfer.h_max }, refined)
        }
    };
    let (refinement, capped) = refined?;
    let region = settings.domain.region().cloned();
    Built { mesh, domain, region, rule: settings.rule, target, refinement, capped }.sorted_out(terminal)
}

impl Built {
    /// The refined mesh without what lies outside the domain.
    fn sorted_out(mut self, terminal: &mut Terminal) -> Result<Self, Failure> {
        terminal.clear();
        let Self { mesh, domain, .. } = &mut self;
        if domain.is_fitted() {
            mesh.classify(0..mesh.raw_triangle_count(), |element| domain.excludes(element));
            if mesh.triangle_count() == 0 {
                return Err(CoarseError::EmptyDomain { spacing: mesh.lattice().spacing() }.into());
            }
        }
        Ok(self)
    }
}

/// Samples the sources, and paint where there is some.
fn fill(
    spec: TargetFieldSpec,
    paint: Option<PaintRef>,
    mesh: &Mesh,
    terminal: &mut Terminal,
) -> Result<TargetField, Failure> {
    let start = Instant::now();
    let pixels = spec.size[0] as usize * spec.size[1] as usize;
    let mut field = TargetField::new(spec, mesh.lattice());
    let mut done = 0;
    let mut fill_slice = || match paint {
        Some(paint) => field.fill(paint, SLICE),
        None => field.fill_unpainted(SLICE),
    };
    // Every slice fills at least one row: this ends.
    while fill_slice()? == Progress::More {
        done += SLICE;
        terminal.progress(start, || format!("{} of {} pixels", Grouped(done.min(pixels)), Grouped(pixels)));
    }
    Ok(field)
}

/// Refines in slices. Returns the time it took and the count of triangles left to the level cap.
fn refine(
    mesh: &mut Mesh,
    limits: &Limits,
    mut exceeds: impl FnMut(&Element) -> Result<bool, InvalidTarget>,
    terminal: &mut Terminal,
) -> Result<(Duration, usize), Failure> {
    let start = Instant::now();
    let mut refiner = Refiner::new(mesh, *limits);
    while refiner.advance(mesh, &mut exceeds, SLICE)? == Progress::More {
        terminal.progress(start, || format!("{} triangles", Grouped(mesh.raw_triangle_count())));
    }
    Ok((start.elapsed(), refiner.capped()))
}
