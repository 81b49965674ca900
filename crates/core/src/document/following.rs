//! Prepares an update in place: the shown mesh for other settings.

use std::sync::Arc;

use super::{Settings, Stage};
use crate::build::BuildError;
use crate::domain::{DomainOnLattice, DomainOnLatticeBuilder, RegionComparison};
use crate::field::RefinementRule;
use crate::geometry::Rect;
use crate::layers::{LayerCheck, SizeField};
use crate::mesh::Progress;

/// Prepares an edit that the mesh can follow where it is, in slices: compares another outline with that of
/// the shown mesh, indexes it, and checks another size field.
#[derive(Clone, Debug)]
pub(super) struct InPlaceUpdate {
    /// The settings after the edit.
    settings: Settings,
    outline: Option<OutlineWork>,
    field: Option<FieldWork>,
}

#[derive(Clone, Debug)]
struct OutlineWork {
    comparison: RegionComparison,
    index: DomainOnLatticeBuilder,
    is_done: bool,
}

#[derive(Clone, Debug)]
struct FieldWork {
    field: Arc<SizeField>,
    check: LayerCheck,
}

/// An edit that is prepared, for the mesh to follow.
#[derive(Clone, Debug)]
pub(super) struct PreparedUpdate {
    pub(super) settings: Settings,
    /// Another domain on the lattice of the mesh, and rectangles in world units in which it differs.
    pub(super) outline: Option<(DomainOnLattice, Vec<Rect>)>,
    /// Another size field.
    pub(super) field: Option<Arc<SizeField>>,
}

impl InPlaceUpdate {
    /// Returns the work from the settings and the field of a mesh to others, on the lattice of that mesh.
    pub(super) fn new(
        shown: &Settings,
        wanted: &Settings,
        field: &SizeField,
        has_new_outline: bool,
        has_new_field: bool,
    ) -> Self {
        let outline = if has_new_outline { OutlineWork::new(shown, wanted, field) } else { None };
        let field = has_new_field.then(|| FieldWork::new(shown, wanted, field));
        Self { settings: wanted.clone(), outline, field }
    }

    /// Returns whether this is the work for these settings.
    pub(super) fn is_for(&self, settings: &Settings) -> bool {
        self.settings == *settings
    }

    pub(super) fn stage(&self) -> Stage {
        match &self.outline {
            Some(outline) if !outline.is_done => Stage::Indexing,
            _ => Stage::Checking,
        }
    }

    /// Returns one slice of work: about `budget` edges or evaluations.
    ///
    /// # Errors
    /// Fails when a layer has a value that no mesh can meet.
    pub(super) fn advance(&mut self, budget: usize) -> Result<Progress, BuildError> {
        if let Some(outline) = &mut self.outline
            && outline.advance(budget) == Progress::More
        {
            return Ok(Progress::More);
        }
        match &mut self.field {
            Some(FieldWork { field, check }) => Ok(check.advance(field, budget)?),
            None => Ok(Progress::Done),
        }
    }

    /// Once done: what the mesh has to follow.
    pub(super) fn finish(self) -> PreparedUpdate {
        let outline = self.outline.map(|OutlineWork { comparison, index, is_done: _ }| {
            (index.finish(), comparison.areas().to_vec())
        });
        PreparedUpdate { settings: self.settings, outline, field: self.field.map(|work| work.field) }
    }
}

impl OutlineWork {
    /// `None` if a domain is given by a formula.
    fn new(shown: &Settings, wanted: &Settings, field: &SizeField) -> Option<Self> {
        let (before, after) = (shown.domain.as_region()?, wanted.domain.as_region()?);
        Some(Self {
            comparison: RegionComparison::new(before, after),
            index: DomainOnLatticeBuilder::with_lengths(
                &wanted.domain,
                wanted.boundary,
                field.lattice(),
                field.edge_lengths().clone(),
            ),
            is_done: false,
        })
    }

    fn advance(&mut self, budget: usize) -> Progress {
        if self.is_done {
            return Progress::Done;
        }
        let progress = match self.comparison.advance(budget) {
            Progress::More => Progress::More,
            Progress::Done => self.index.advance(budget),
        };
        self.is_done = progress == Progress::Done;
        progress
    }
}

impl FieldWork {
    fn new(shown: &Settings, wanted: &Settings, field: &SizeField) -> Self {
        let field = field.with_spec(wanted.field_spec());
        let check = match wanted.rule {
            RefinementRule::Area => LayerCheck::of_changed(&field, &shown.layers),
            // The rule checks each node itself.
            RefinementRule::Vertex => LayerCheck::default(),
        };
        Self { field: Arc::new(field), check }
    }
}
