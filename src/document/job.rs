//! A mesh in the making, beside the one that is shown.

use super::stage::{FollowError, Stage};
use super::{Document, Settings};
use crate::domain::{DomainLaying, DomainOnLattice};
use crate::field::{RefinementRule, TargetField, VertexRule};
use crate::mesh::{CoarseError, Element, Mesh, Progress, RefineError, Refiner};
use crate::raster::PixelRect;

/// A mesh in the making.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) settings: Settings,
    /// The domain on its way to the lattice, at first, where that of the shown mesh does not serve.
    laying: Option<DomainLaying>,
    domain: Option<DomainOnLattice>,
    /// A field in the making, where that of the shown mesh does not serve.
    field: Option<TargetField>,
    refining: Option<Refining>,
    /// What was painted since the work began: field and mesh are updated there once they are shown.
    pub(super) repainted: Vec<PixelRect>,
}

/// What a job leaves behind.
pub(super) struct Finished {
    pub(super) settings: Settings,
    pub(super) domain: DomainOnLattice,
    pub(super) field: Option<TargetField>,
    pub(super) mesh: Mesh,
}

#[derive(Clone, Debug)]
struct Refining {
    mesh: Mesh,
    refiner: Refiner,
    refined: bool,
    /// How many triangles were asked whether they lie outside.
    sorted: usize,
    /// h̄ by node, as far as the vertex rule has asked.
    known: Vec<f64>,
}

impl Job {
    /// `reuse_field`: the field of the shown mesh serves. So does its domain on the lattice, where it is given.
    pub(super) fn new(
        settings: &Settings,
        reuse_field: bool,
        domain: Option<DomainOnLattice>,
    ) -> Result<Self, FollowError> {
        let lattice = settings.lattice().map_err(CoarseError::from)?;
        let laying =
            domain.is_none().then(|| DomainLaying::new(&settings.domain, settings.boundary, &lattice));
        let field = (!reuse_field).then(|| TargetField::new(settings.field_spec(), &lattice));
        Ok(Self { settings: settings.clone(), laying, domain, field, refining: None, repainted: Vec::new() })
    }

    /// What is being done.
    pub(super) fn stage(&self) -> Stage {
        match &self.refining {
            _ if self.laying.is_some() => Stage::Outlining,
            None => Stage::Filling,
            Some(refining) => Stage::Refining { triangles: refining.mesh.raw_triangle_count() },
        }
    }

    /// One slice of laying the domain, filling, refining or sorting out what lies outside.
    pub(super) fn advance(
        &mut self,
        document: &Document,
        shown: Option<&TargetField>,
        visits: usize,
    ) -> Result<Progress, FollowError> {
        if let Some(mut laying) = self.laying.take() {
            match laying.advance(visits) {
                Progress::More => self.laying = Some(laying),
                Progress::Done => self.domain = Some(laying.finished()),
            }
            return Ok(Progress::More);
        }
        let domain = self.domain.as_ref().expect("it is laid before anything else");
        let Some(refining) = &mut self.refining else {
            let filled = match &mut self.field {
                Some(field) => field.fill(document.paint().as_paint(), visits)?,
                None => Progress::Done,
            };
            if filled == Progress::Done {
                self.refining = Some(Refining::new(&self.settings, domain)?);
            }
            return Ok(Progress::More);
        };
        let field =
            self.field.as_ref().or(shown).expect("a job without a field of its own reuses the shown one");
        if !refining.refined {
            let progress = refining.refine(domain, field, document, self.settings.rule, visits)?;
            refining.refined = progress == Progress::Done;
            return Ok(Progress::More);
        }
        Ok(refining.classify(domain, visits))
    }

    pub(super) fn finished(self) -> Finished {
        let Self { settings, domain: Some(domain), field, refining: Some(refining), .. } = self else {
            unreachable!("a job is done when refining is");
        };
        Finished { settings, domain, field, mesh: refining.mesh }
    }
}

impl Refining {
    fn new(settings: &Settings, domain: &DomainOnLattice) -> Result<Self, FollowError> {
        let limits = settings.limits();
        let admits = |node| domain.admits(node);
        let mesh = Mesh::coarse_grid(domain.lattice(), admits, &limits)?;
        let refiner = Refiner::new(&mesh, limits);
        Ok(Self { mesh, refiner, refined: false, sorted: 0, known: Vec::new() })
    }

    fn refine(
        &mut self,
        domain: &DomainOnLattice,
        field: &TargetField,
        document: &Document,
        rule: RefinementRule,
        visits: usize,
    ) -> Result<Progress, RefineError> {
        match rule {
            RefinementRule::Area => {
                let exceeds =
                    |element: &Element| domain.exceeds(element, |element| Ok(field.exceeds(element)));
                self.refiner.advance(&mut self.mesh, exceeds, visits)
            }
            RefinementRule::Vertex => {
                let paint = document.paint().as_paint();
                let target = |point| field.target_at_node(paint, point);
                let mut rule = VertexRule::resumed(target, std::mem::take(&mut self.known));
                let exceeds = |element: &Element| domain.exceeds(element, |element| rule.exceeds(element));
                let progress = self.refiner.advance(&mut self.mesh, exceeds, visits);
                self.known = rule.into_known();
                progress
            }
        }
    }

    fn classify(&mut self, domain: &DomainOnLattice, visits: usize) -> Progress {
        let all = self.mesh.raw_triangle_count();
        let first = self.sorted;
        self.sorted = if domain.is_fitted() { first.saturating_add(visits).min(all) } else { all };
        if domain.is_fitted() {
            self.mesh.classify(first..self.sorted, |element| domain.excludes(element));
        }
        if self.sorted == all { Progress::Done } else { Progress::More }
    }
}
